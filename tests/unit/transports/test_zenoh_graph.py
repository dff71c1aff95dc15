"""Tokens that come together are filed together."""

from navette.transports.base import TransportObserver
from navette.transports.zenoh.graph import RemoteGraph
from navette.transports.zenoh.log_once import LogOnce

NODES = [f"@ros2_lv/7/abc/{number}/{number}/NN/%/%/n{number}" for number in range(5)]


class Counting(TransportObserver):
    """Counts what it is told."""

    def __init__(self) -> None:
        self.changes = 0

    def graph_changed(self) -> None:
        self.changes += 1


def test_a_change_is_told_once_for_all_that_came_together() -> None:
    graph, told = RemoteGraph("fff", LogOnce()), Counting()
    graph.observers.append(told)
    graph.on_tokens([(key, True) for key in NODES])
    assert [node.name for node in graph.nodes()] == ["n0", "n1", "n2", "n3", "n4"]
    assert told.changes == 1
    graph.on_tokens([(NODES[0], True), ("@ros2_lv/7/x", True), (NODES[1][:-1], False)])
    assert told.changes == 1  # known, no token, never heard of
    graph.on_tokens([(NODES[0], False), (NODES[0], True), (NODES[1], False)])
    assert [node.name for node in graph.nodes()] == ["n2", "n3", "n4", "n0"]
    assert told.changes == 2


def test_waiting_tells_what_is_still_missing() -> None:
    graph = RemoteGraph("fff", LogOnce())
    graph.on_tokens([(NODES[0], True)])
    assert graph.wait_until_known({NODES[0]}, 60.0) == set()
    assert graph.wait_until_known({*NODES[:2]}, 0.0) == {NODES[1]}
