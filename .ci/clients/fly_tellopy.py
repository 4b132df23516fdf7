"""Flies the emulated drone with tellopy in the binary protocol; argument: address, port."""

import os
import sys
import time

import av
import tellopy

address, port = sys.argv[1], int(sys.argv[2])
drone = tellopy.Tello()
drone.tello_addr = (address, port)
flights, logs, video = [], [], bytearray()
drone.subscribe(drone.EVENT_FLIGHT_DATA, lambda event, sender, data, **rest: flights.append(data))
drone.subscribe(drone.EVENT_LOG_DATA, lambda event, sender, data, **rest: logs.append(str(data)))
drone.subscribe(drone.EVENT_VIDEO_FRAME, lambda event, sender, data, **rest: video.extend(data))
drone.connect()
drone.wait_for_connection(10.0)


def until(condition, what):
    """Waits for the flight data to show something."""
    end = time.monotonic() + 20.0
    while not condition():
        assert time.monotonic() < end, what
        time.sleep(0.05)


drone.start_video()
drone.takeoff()
until(lambda: flights and flights[-1].em_sky and flights[-1].height >= 5, "took off")
# The take-off goes on for a while above this height; sticks count when it is over.
time.sleep(3.0)
drone.forward(30)
time.sleep(1.0)
drone.forward(0)
drone.clockwise(50)
time.sleep(1.0)
drone.clockwise(0)
assert flights[-1].battery_percentage > 50
assert max(data.north_speed for data in flights) > 0, "it did not move"
drone.land()
until(lambda: flights[-1].em_ground and not flights[-1].em_sky, "landed")
assert logs, "no log record was parsed"
assert drone.video_data_loss == 0, drone.video_data_loss
decoder = av.CodecContext.create("h264", "r")
pictures = [frame for packet in decoder.parse(bytes(video)) for frame in decoder.decode(packet)]
assert len(pictures) > 100 and all((frame.width, frame.height) == (960, 720) for frame in pictures), len(pictures)
print("tellopy: flown,", len(flights), "flight data,", len(logs), "log messages,", len(pictures), "pictures decoded", flush=True)
drone.quit()
os._exit(0)
