"""Flies the emulated drone with tello-asyncio; argument: address, port."""

import asyncio
import sys

from tello_asyncio import Tello

address, port = sys.argv[1], int(sys.argv[2])


async def main():
    loop = asyncio.get_event_loop()
    create = loop.create_datagram_endpoint

    def redirected(protocol, local_addr=None, remote_addr=None, **rest):
        """tello-asyncio has no setting for the drone's port."""
        if remote_addr is not None:
            remote_addr = (remote_addr[0], port)
        return create(protocol, local_addr=local_addr, remote_addr=remote_addr, **rest)

    loop.create_datagram_endpoint = redirected
    states = []
    drone = Tello(address, on_state=lambda _, state: states.append(state))
    await drone.connect()
    await drone.takeoff()
    await drone.move_forward(50)
    await drone.turn_clockwise(90)
    assert await drone.query_battery() > 50
    await drone.land()
    await drone.disconnect()
    assert states, "no state line was parsed"
    print("tello-asyncio: flown,", len(states), "states")


asyncio.new_event_loop().run_until_complete(main())
