"""States of nodes that respond, do not respond, or left the graph."""

from collections.abc import Mapping

import pytest
from remote_fakes import World

from navette.viewer.liveness import PERIOD_S, LivenessProbe, NodeState

ALIVE, SILENT, GONE = NodeState.ALIVE, NodeState.SILENT, NodeState.GONE


class Monitored:
    """Probe steps at the period of the socket thread."""

    def __init__(self) -> None:
        self.world = World()
        self.probe = LivenessProbe(self.world.service_calls, self.world.clock)
        self.here: set[str] = {"/viewer"}
        self.others: Mapping[str, bool] = {"/a": True}
        self.answers("/a")

    def answers(self, node: str) -> None:
        self.world.answers[f"{node}/get_parameters"] = lambda _: "here"

    def freeze(self, node: str) -> None:
        del self.world.answers[f"{node}/get_parameters"]

    def states(self, seconds: float = 0.0) -> dict[str, NodeState]:
        """After beats for so long."""
        end_s = self.world.clock.now_s + seconds
        while True:
            self.world.service_calls.expire()
            reports = self.probe.step(self.here, self.others)
            if self.world.clock.now_s >= end_s:
                return {report.name: report.state for report in reports}
            self.world.clock.now_s += PERIOD_S


@pytest.fixture
def monitored() -> Monitored:
    return Monitored()


def test_a_node_that_responds_is_alive(monitored: Monitored) -> None:
    assert monitored.states(5.0) == {"/a": ALIVE, "/viewer": ALIVE}
    assert len(monitored.world.asked()) == 11
    assert monitored.world.clients == ["/a/get_parameters"]  # one for all beats


def test_a_frozen_node_is_silent_within_two_seconds_and_comes_back(
    monitored: Monitored,
) -> None:
    monitored.states(1.0)
    monitored.freeze("/a")
    assert monitored.states(1.0)["/a"] is ALIVE
    assert monitored.states(1.0)["/a"] is SILENT
    # Its connection times out: leaving the graph is not a new state.
    monitored.others = {}
    assert monitored.states(10.0)["/a"] is SILENT
    monitored.others = {"/a": True}
    monitored.answers("/a")
    assert monitored.states()["/a"] is ALIVE


def test_a_node_that_ends_is_gone_at_once_and_dropped_later(
    monitored: Monitored,
) -> None:
    monitored.states(1.0)
    monitored.others = {}
    assert monitored.states() == {"/a": GONE, "/viewer": ALIVE}
    assert monitored.world.clients == []
    monitored.states(601.0)
    assert monitored.states() == {"/viewer": ALIVE}


def test_a_node_without_services_has_an_unknown_state(monitored: Monitored) -> None:
    monitored.others = {"/tiny": False}
    assert monitored.states(5.0)["/tiny"] is NodeState.UNKNOWN
    assert monitored.world.asked() == []


def test_a_gap_of_the_viewer_itself_counts_against_no_node(
    monitored: Monitored,
) -> None:
    """The live view itself was frozen and could not receive responses."""
    monitored.states(1.0)
    monitored.freeze("/a")
    monitored.states()
    monitored.world.clock.now_s += 30.0
    assert monitored.states()["/a"] is ALIVE
    assert monitored.states(2.0)["/a"] is SILENT


def test_many_nodes_are_probed_less_often_each(monitored: Monitored) -> None:
    monitored.others = {f"/n{number}": True for number in range(100)}
    for node in monitored.others:
        monitored.answers(node)
    assert set(monitored.states(10.0).values()) == {ALIVE}
    assert len(monitored.world.asked()) <= 100 * 7
    monitored.probe.reset()
    assert monitored.world.clients == []
