"""Runs tellopy's own FakeDrone and lets a client of ours fly it; arguments: the client's command line."""

import subprocess
import sys
import threading

import tests.support.fake_drone as fake
from tellopy._internal.protocol import LAND_CMD, LOG_HEADER_MSG, STICK_CMD, TAKEOFF_CMD

drone = fake.FakeDrone(video_port=16038)
done = threading.Event()


def report():
    """FakeDrone says nothing by itself."""
    header = True
    while not done.wait(0.1):
        if drone.client is None:
            continue
        if header:
            drone.send_log_header()
            header = False
        drone.send_flight_data(battery=77)
        drone.send_log_data(fake.log_record(2048, 12345, bytes(108)))


threading.Thread(target=report, daemon=True).start()
address = "%s:%d" % drone.address
flown = subprocess.run(sys.argv[1:] + ["--drone", address], timeout=60, capture_output=True, text=True)
done.set()
assert flown.returncode == 0, flown.stderr
assert "battery Some(77)" in flown.stdout, flown.stdout
with drone.lock:
    received = list(drone.received)
assert all(frame.crc_ok for frame in received), "a checksum is wrong"
count = {number: sum(frame.cmd == number for frame in received) for number in (TAKEOFF_CMD, LAND_CMD, LOG_HEADER_MSG, STICK_CMD)}
assert count[TAKEOFF_CMD] == 1 and count[LAND_CMD] >= 1 and count[LOG_HEADER_MSG] == 1, count
assert count[STICK_CMD] > 100, count
drone.stop()
print("tellopy FakeDrone: flown,", len(received), "frames, all checksums right")
