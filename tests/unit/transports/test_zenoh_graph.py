"""Tokens that arrive together cause one notification."""

from navette.transports.base import TransportObserver
from navette.transports.zenoh.graph import RemoteGraph
from navette.transports.zenoh.log_once import LogOnce

NODES = [f"@ros2_lv/7/abc/{number}/{number}/NN/%/%/n{number}" for number in range(5)]


class Counting(TransportObserver):
    """Counts notifications."""

    def __init__(self) -> None:
        self.changes = 0

    def graph_changed(self) -> None:
        self.changes += 1


def test_observers_are_notified_once_for_a_batch() -> None:
    graph, counting = RemoteGraph("fff", LogOnce()), Counting()
    graph.observers.append(counting)
    graph.on_tokens([(key, True) for key in NODES])
    assert [node.name for node in graph.nodes()] == ["n0", "n1", "n2", "n3", "n4"]
    assert counting.changes == 1
    graph.on_tokens([(NODES[0], True), ("@ros2_lv/7/x", True), (NODES[1][:-1], False)])
    assert counting.changes == 1  # known already, invalid, never added
    graph.on_tokens([(NODES[0], False), (NODES[0], True), (NODES[1], False)])
    assert [node.name for node in graph.nodes()] == ["n2", "n3", "n4", "n0"]
    assert counting.changes == 2


def test_waiting_returns_the_missing_tokens() -> None:
    graph = RemoteGraph("fff", LogOnce())
    graph.on_tokens([(NODES[0], True)])
    assert graph.wait_until_known({NODES[0]}, 60.0) == set()
    assert graph.wait_until_known({*NODES[:2]}, 0.0) == {NODES[1]}
