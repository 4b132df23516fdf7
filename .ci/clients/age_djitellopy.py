"""How old is the newest picture with djitellopy? Reads the time painted into the emulated drone's test card; argument: address, port."""

import sys
import time

from djitellopy import Tello

address, port = sys.argv[1], int(sys.argv[2])
tello = Tello(host=address)
tello.address = (address, port)
tello.connect()
tello.get_udp_video_address = lambda: "udp://@127.0.0.1:11111"
start = time.monotonic()
tello.streamon()
reader = tello.get_frame_read()


def clock(frame):
    """The second band of the card: 32 squares of 16 pixels, then eight black and white in turn; rows 64 to 79."""
    if frame.shape != (720, 960, 3):
        return None
    bits = [int(frame[72, column * 16 + 8, 1] > 127) for column in range(40)]
    if bits[32:] != [0, 1] * 4:
        return None
    return int("".join(map(str, bits[:32])), 2)


first, ages, last = None, [], None
while time.monotonic() < start + 12.0:
    painted = clock(reader.frame)
    if painted is not None and painted != last:
        now = int(time.time() * 1000) % 2**32
        first = first or time.monotonic() - start
        ages.append((now - painted) % 2**32)
        last = painted
    time.sleep(0.001)
tello.streamoff()
ages.sort()
assert len(ages) > 100, len(ages)
print("djitellopy video age: flown, first picture after %.2f s; %d pictures, age median %d ms, p95 %d ms, longest %d ms" % (
    first, len(ages), ages[len(ages) // 2], ages[len(ages) * 95 // 100], ages[-1]))
