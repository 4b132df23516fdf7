"""Flies the emulated drone with djitellopy: connect, take off, move, turn, land; argument: address, port."""

import sys

from djitellopy import Tello

address, port = sys.argv[1], int(sys.argv[2])
tello = Tello(host=address)
# The one thing djitellopy fixes: the command port. Its address attribute is public.
tello.address = (address, port)
tello.connect()
assert tello.query_battery() > 50
assert tello.query_sdk_version() == "20"
tello.takeoff()
tello.move_forward(50)
tello.rotate_clockwise(90)
tello.go_xyz_speed(30, 0, 30, 40)
assert tello.get_height() > 0, tello.get_current_state()
tello.send_rc_control(0, 20, 0, 0)
tello.send_rc_control(0, 0, 0, 0)
tello.land()
print("djitellopy: flown")
