"""Ports that one thread closes while another uses them."""

from typing import Any

import pytest
import zenoh
from transport_pairs import ZenohPair, until

from navette.msgs.std_msgs.msg import String
from navette.transports import Endpoint, EndpointKind, EndpointQos

TYPE = "std_msgs/msg/String"


def end(kind: EndpointKind) -> Endpoint:
    return Endpoint(kind, "/t", TYPE, EndpointQos(), "n", "/", b"")


@pytest.fixture
def port(pair: ZenohPair) -> Any:
    """A publisher with a matched subscription."""
    pair.near.subscribe(
        end(EndpointKind.SUBSCRIPTION), String, lambda _: None, shared=False
    )
    port = pair.far.advertise(end(EndpointKind.PUBLISHER), String)
    until(lambda: port.matched_count == 1, "the match")
    return port


def test_closing_during_a_send_is_not_an_error(port: Any) -> None:
    put, tried = port._put, []

    def interrupted(data: Any, attachment: bytes) -> None:
        port.close()
        tried.append(data)
        put(data, attachment=attachment)

    port._put = interrupted
    port.send(String(data="late"), 0, 1)
    assert len(tried) == 1
    port.send(String(data="later"), 0, 2)
    assert len(tried) == 1


def test_errors_of_an_open_publisher_are_raised(port: Any) -> None:
    def broken(data: Any, attachment: bytes) -> None:
        raise zenoh.ZError("no")

    port._put = broken
    with pytest.raises(zenoh.ZError, match="no"):
        port.send(String(data="a"), 0, 1)
