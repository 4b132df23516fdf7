"""Decodes the emulated drone's video with djitellopy; argument: address, port. The drone needs the feature `video`."""

import sys
import time

from djitellopy import Tello

address, port = sys.argv[1], int(sys.argv[2])
tello = Tello(host=address)
tello.address = (address, port)
tello.connect()
tello.streamon()
# It asks for the pictures on the drone's address; the emulated drone sends them to this machine's.
tello.get_udp_video_address = lambda: "udp://@127.0.0.1:11111"
reader = tello.get_frame_read()
shapes, different = set(), 0
last = None
end = time.monotonic() + 4.0
while time.monotonic() < end:
    frame = reader.frame
    shapes.add(frame.shape)
    if last is not None and (last.shape != frame.shape or (last != frame).any()):
        different += 1
    last = frame.copy()
    time.sleep(0.03)
assert (720, 960, 3) in shapes, shapes
assert different > 30, different
tello.streamoff()
print("djitellopy video: flown,", different, "different pictures of 960 x 720")
