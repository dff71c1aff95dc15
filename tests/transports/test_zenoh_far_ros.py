"""A peer with rmw_zenoh's configuration on another machine, which does not listen."""

import json

import zenoh
from transport_pairs import until

from free_ports import free_endpoint
from navette.runtime.clock import VirtualClock
from navette.transports.zenoh import Settings, ZenohTransport

STRATEGY = {"peer": {"to_router": "always", "to_peer": "greater-zid"}}


def test_the_peer_opens_the_link_to_navette() -> None:
    router = free_endpoint()
    near = ZenohTransport(7, VirtualClock(5), Settings(router=(router,)))
    config = zenoh.Config()
    for key, value in {
        "mode": "peer",
        "connect/endpoints": [router],
        "listen/endpoints": [],
        "scouting/multicast/enabled": False,
        "scouting/gossip/autoconnect_strategy": STRATEGY,
    }.items():
        config.insert_json5(key, json.dumps(value))
    with zenoh.open(config) as far:
        wanted = near.session.zid
        until(lambda: wanted in map(str, far.info.peers_zid()), "its link to Navette")
    near.close()
