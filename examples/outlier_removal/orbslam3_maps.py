"""Makes labelled maps with the real ORB-SLAM3, to choose on and to hold back, in the folders that compare_outlier_removal reads.

usage: orbslam3_maps.py SHARED OUT [design|held|NAME ...]

SHARED is the folder of published data: data/ has the image sequences, orbslam3/ the programs that run ORB-SLAM3 (the wheel
pyorbslam3 0.1.1, GPL-3.0, in a process of its own), read its atlas and label points by the depth images. Python needs numpy,
scipy, opencv-python-headless, pyorbslam3 and python-orb-slam3. A map takes a minute or two: images come at a quarter of their
rate, so that a busy processor keeps up. ORB-SLAM3 is not deterministic: maps of other runs differ. Folders that are there stay as they are.
"""

import gzip
import pathlib
import shutil
import subprocess
import sys

import cv2
import numpy as np

# Scene, sensor, features, first and last frame, stride, backwards. The first list was looked at while choosing weights and cuts.
DESIGN = [
    "kitchen mono 1200 20 300 1 back", "kitchen mono 1500 0 300 1", "kitchen mono 1500 0 300 1 back", "kitchen mono 2000 0 300 1",
    "kitchen rgbd 700 100 300 1", "kitchen rgbd 1000 0 300 1", "kitchen rgbd 1200 50 250 1", "kitchen rgbd 1200 0 300 2",
    "kitchen rgbd 1500 0 300 1 back", "kitchen rgbd 2000 0 200 1", "kitchen rgbd 2500 0 300 1 back",
    "fr1 rgbd 700 0 250 1 back", "fr1 rgbd 1000 0 250 1", "fr1 rgbd 1200 70 250 1", "fr1 rgbd 1500 0 250 1 back",
    "fr1 rgbd 1500 0 150 1", "fr1 rgbd 2000 0 200 1", "fr1 rgbd 2500 0 250 2",
]
HELD = [
    "kitchen mono 1300 0 300 2", "kitchen mono 1600 0 280 1 back", "kitchen mono 1800 0 300 1", "kitchen mono 2400 10 290 1 back",
    "kitchen mono 1700 0 300 1", "kitchen mono 1400 0 300 1 back", "kitchen mono 2200 0 300 1",
    "kitchen rgbd 900 0 260 1 back", "kitchen rgbd 1100 0 170 1", "kitchen rgbd 1400 0 300 2", "kitchen rgbd 1800 60 300 1",
    "fr1 rgbd 1000 60 250 1", "fr1 rgbd 1300 0 250 2", "fr1 rgbd 1800 0 220 1 back", "fr1 rgbd 2200 30 230 1",
]
# Focal lengths and centre, units of depth a metre.
SCENES = {
    "kitchen": ("seven_scenes_redkitchen_part1", (585.0, 585.0, 320.0, 240.0), 1000.0),
    "fr1": ("tum_fr1_rpy_part1", (517.306408, 516.469215, 318.64304, 255.313989), 5000.0),
}
SLOWER = 4.0


def frames(scene, folder):
    """Time stamp, image and depth image of every frame."""
    if scene == "kitchen":
        images = sorted((folder / "color").iterdir())
        return [(i / 30.0, image, folder / "depth" / f"{image.stem}.png") for i, image in enumerate(images)]
    rows = [line.split() for line in (folder / "associations.txt").read_text().splitlines()]
    return [(float(row[0]), folder / row[1], folder / row[3]) for row in rows if row[0] != "#"]


def image_list(scene, folder, choice, out):
    """Writes the chosen frames as ORB-SLAM3 is to see them: time runs forwards, 0 is the only depth that means none."""
    first, last, stride, backwards = choice
    chosen = frames(scene, folder)[first:last:stride]
    ends = chosen[0][0] + chosen[-1][0]
    if backwards:
        chosen = [(ends - time, image, depth) for time, image, depth in reversed(chosen)]
    lines = []
    for time, image, depth in chosen:
        values = cv2.imread(str(depth), cv2.IMREAD_UNCHANGED)
        values[values == 65535] = 0
        cv2.imwrite(str(out / depth.name), values)
        lines.append(f"{time:.6f} {image} {out / depth.name}\n")
    (out / "list.txt").write_text("".join(lines))


def settings(scene, sensor, features, shared, out):
    """The published settings of the scene's camera with another number of features, and what a depth camera needs."""
    text = (shared / "orbslam3" / ("7s.yaml" if scene == "kitchen" else "tum1.yaml")).read_text()
    lines = [f"ORBextractor.nFeatures: {features}" if "nFeatures" in line else line for line in text.splitlines()]
    if sensor == "rgbd":
        lines += ["Stereo.ThDepth: 40.0", "Stereo.b: 0.07732", f"RGBD.DepthMapFactor: {SCENES[scene][2]}"]
    (out / "settings.yaml").write_text("\n".join(lines) + "\n")


def run(program, *arguments, where):
    command = [sys.executable, program, *map(str, arguments)]
    with open(where / "log.txt", "a") as log:
        subprocess.run(command, stdout=log, stderr=log, check=False)


def newest_atlas(work):
    """The whole map at the end; if saving it crashed, the last snapshot."""
    atlases = [work / "atlas.osa", *sorted(work.glob("snap*/atlas.osa"), reverse=True)]
    return next((atlas for atlas in atlases if atlas.is_file() and atlas.stat().st_size > 0), None)


def keep_largest_map(work):
    """Sub-maps have frames of their own: drops the points of all but the largest, and records misread, whose ids are beyond all."""
    header, body = (work / "map.ply").read_text().split("end_header\n")
    points = [line.split() for line in body.splitlines()]
    sizes = np.bincount([int(point[10]) for point in points])
    kept = [point for point in points if int(point[10]) == sizes.argmax() and int(point[7]) < 1 << 32]
    header = header.replace(f"element vertex {len(points)}", f"element vertex {len(kept)}")
    (work / "map.ply").write_text(header + "end_header\n" + "".join(" ".join(point) + "\n" for point in kept))
    return len(kept), len(points)


def make(name, shared, out):
    scene, sensor, features, first, last, stride, *backwards = name.split()
    target, work = out / name.replace(" ", "_"), out / "work"
    if target.is_dir():
        return
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    folder, camera, unit = SCENES[scene]
    image_list(scene, shared / "data" / folder, (int(first), int(last), int(stride), bool(backwards)), work)
    settings(scene, sensor, features, shared, work)
    programs = shared / "orbslam3"
    vocabulary = out / "vocabulary.txt"
    if not vocabulary.is_file():
        vocabulary.write_bytes(gzip.decompress((programs / "voc_small.txt.gz").read_bytes()))
    run(programs / "run_orbslam3.py", "--vocab", vocabulary, "--settings", work / "settings.yaml", "--sensor", sensor,
        "--list", work / "list.txt", "--out", work, "--realtime", "--slow", SLOWER, "--snap", 25, where=work)
    atlas = newest_atlas(work)
    if atlas is None:
        print(f"{name}: no map was written, see {work}/log.txt", flush=True)
        return
    run(programs / "osa_dump.py", atlas, work / "map", where=work)
    kept, found = keep_largest_map(work)
    run(programs / "depthcheck.py", work, work / "list.txt", ",".join(map(str, camera)), unit, work / "depth_check.csv", where=work)
    export(work, target)
    errors = np.loadtxt(target / "depth_check.csv", delimiter=",", skiprows=1)[:, 2]
    wrong = int((abs(errors) > 0.2).sum())
    print(f"{name}: {kept} of {found} points, labelled {len(errors)}, wrong {wrong} ({100 * wrong / len(errors):.1f} %), {atlas.parent.name}", flush=True)


def export(work, target):
    """A map folder like the published ones."""
    target.mkdir()
    for old, new in (("map.ply", "map.ply"), ("map_kf.csv", "keyframes.csv"), ("depth_check.csv", "depth_check.csv"), ("frames.csv", "frames.csv")):
        shutil.copy(work / old, target / new)
    (target / "observations.csv.gz").write_bytes(gzip.compress((work / "map_obs.csv").read_bytes()))


if __name__ == "__main__":
    lists = {"design": DESIGN, "held": HELD}
    shared, out = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    for wanted in sys.argv[3:] or lists:
        for name in lists.get(wanted, [wanted]):
            make(name, shared, out)
