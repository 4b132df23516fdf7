"""What KD-trees over the bits of descriptors would find, against comparing all.

usage: kd_tree.py ORB_BINARY SEVEN_SCENES_FOLDER   (needs numpy and opencv-python-headless)
Trees as in FLANN: each node splits at one of the five bits that halve it best, leaves hold up to 8; one tree, or four whose bits
are drawn independently; leaves are visited in the order of how many bits on the way to them differ. Printed: the share of the
matches (ratio, mutual, by comparing all) whose nearest is among the visited, by the share of descriptors that are compared; and
how many matches have a second neighbour near enough for an exact search to leave out any leaf.
"""
import sys
from pathlib import Path

import numpy as np

import orb

LEAF, EVERY = 8, 6


def grow(bits, ids, path, found, random):
    share = bits[ids].mean(axis=0)
    share[[bit for bit, _ in path]] = 9
    bit = int(random.choice(np.argsort(abs(share - 0.5))[:5]))
    ones = bits[ids, bit] == 1
    if len(ids) <= LEAF or ones.all() or not ones.any():
        found.append((path, ids))
        return found
    grow(bits, ids[~ones], [*path, (bit, 0)], found, random)
    return grow(bits, ids[ones], [*path, (bit, 1)], found, random)


def main():
    frames, _, _ = orb.seven_scenes(Path(sys.argv[2]))
    pairs = [(i, i + gap) for i in range(0, 290, 60) for gap in (5, 10)]
    used = sorted({k for pair in pairs for k in pair})
    result, _ = orb.ours([sys.argv[1]], "balanced", [frames[k][0] for k in used])
    bits = {k: np.unpackbits(words, axis=1).astype(np.int16) for k, (_, words) in zip(used, result)}
    random, kept, near, matches = np.random.default_rng(0), {}, 0, 0
    for i, j in pairs:
        a, b = bits[i], bits[j]
        distance = a @ (1 - b).T + (1 - a) @ b.T
        order = np.argsort(distance, axis=1, kind="stable")
        first, second = (distance[np.arange(len(a)), order[:, k]] for k in (0, 1))
        mutual = distance.argmin(axis=0)[order[:, 0]] == np.arange(len(a))
        good = np.flatnonzero((first <= 64) & (first < 0.8 * second) & mutual)
        trees = [grow(b, np.arange(len(b)), [], [], random) for _ in range(4)]
        near += (second[good] <= max(len(path) for path, _ in trees[0])).sum()
        matches += len(good)
        for count in (1, 4):
            leaves = [leaf for tree in trees[:count] for leaf in tree]
            for query in good[::EVERY]:
                differ = [sum(a[query, bit] != value for bit, value in path) for path, _ in leaves]
                ranks = np.argsort(differ + random.random(len(differ)) * 0.1)
                for share in (0.05, 0.1, 0.3):
                    seen = set()
                    for k in ranks:
                        seen.update(leaves[k][1].tolist())
                        if len(seen) >= share * len(b):
                            break
                    kept.setdefault((count, share), []).append(order[query, 0] in seen)
    print(f"{matches} matches, {near} with a second neighbour within the depth of the tree")
    for (count, share), found in kept.items():
        print(f"{count} trees, {100 * share:.0f} % compared: {100 * np.mean(found):.1f} % of the nearest found")


if __name__ == "__main__":
    main()
