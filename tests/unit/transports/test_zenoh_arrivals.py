"""What a subscription remembers of publishers, where somebody makes up many."""

import pytest

from navette.msgs.std_msgs.msg import String
from navette.transports import Encoded, Endpoint, EndpointKind, EndpointQos, Item
from navette.transports.zenoh.matches import Matches
from navette.transports.zenoh.recovery import Arrivals
from navette.transports.zenoh.recovery import arrivals as arrivals_module


def item(number: int) -> Item:
    return Encoded(b"", String, lambda _: None), 0, 0, number


def test_those_that_the_graph_lists_are_forgotten_last(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(arrivals_module, "_MOST_PUBLISHERS", 3)
    ends = [
        Endpoint(kind, "/t", "std_msgs/msg/String", EndpointQos(), "n", "/", b"true")
        for kind in (EndpointKind.SUBSCRIPTION, EndpointKind.PUBLISHER)
    ]
    matches = Matches(ends[0], "hash", {}, lambda *_: None)
    matches.add("@ros2_lv/7/12/1/2/MP/x", ends[1])
    got: list[Item] = []
    arrivals = Arrivals(
        matches,
        "t",
        got.append,
        lost=lambda count: None,
        checked=lambda sample: None,
        wants=None,
    )
    arrivals.take(b"true", item(5))
    for number in range(10):
        arrivals.take(f"made up {number}".encode(), item(1))
    arrivals.take(b"true", item(5))  # by another way
    assert [each[3] for each in got].count(5) == 1
    arrivals.take(b"true", item(6))
    assert got[-1][3] == 6
    arrivals.close()
    arrivals.take(b"true", item(7))
    assert got[-1][3] == 6
