"""Flies the emulated drone with easytello; argument: address, port."""

import socket
import sys

from easytello import tello as module

address, port = sys.argv[1], int(sys.argv[2])


class Redirect(socket.socket):
    """easytello has no setting for the drone's port."""

    def sendto(self, data, to):
        return super().sendto(data, (to[0], port))


module.socket.socket = Redirect
drone = module.Tello(tello_ip=address, debug=False)
drone.takeoff()
drone.forward(50)
drone.cw(90)
drone.up(40)
assert int(drone.get_battery()) > 50
drone.land()
replies = [entry.get_response() for entry in drone.log]
assert len(replies) == 7 and all(reply is not None for reply in replies), replies
assert all("ok" in replies[i] for i in (0, 1, 2, 3, 4, 6)), replies
print("easytello: flown")
