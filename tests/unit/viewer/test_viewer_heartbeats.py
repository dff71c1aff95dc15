"""Who lives: what is said of nodes that answer, that do not, and that are gone."""

from collections.abc import Mapping

import pytest
from remote_fakes import World

from navette.viewer.heartbeats import PERIOD_S, Heartbeats, NodeState

ALIVE, SILENT, GONE = NodeState.ALIVE, NodeState.SILENT, NodeState.GONE


class Vigil:
    """Beats as the socket thread makes them."""

    def __init__(self) -> None:
        self.world = World()
        self.beats = Heartbeats(self.world.questions, self.world.clock)
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
            self.world.questions.give_up_old()
            reports = self.beats.beat(self.here, self.others)
            if self.world.clock.now_s >= end_s:
                return {report.name: report.state for report in reports}
            self.world.clock.now_s += PERIOD_S


@pytest.fixture
def vigil() -> Vigil:
    return Vigil()


def test_who_answers_lives(vigil: Vigil) -> None:
    assert vigil.states(5.0) == {"/a": ALIVE, "/viewer": ALIVE}
    assert len(vigil.world.asked()) == 11
    assert vigil.world.clients == ["/a/get_parameters"]  # one for all beats


def test_a_frozen_node_is_silent_within_two_seconds_and_comes_back(
    vigil: Vigil,
) -> None:
    vigil.states(1.0)
    vigil.freeze("/a")
    assert vigil.states(1.0)["/a"] is ALIVE
    assert vigil.states(1.0)["/a"] is SILENT
    # Its connection times out: that it is listed no more tells nothing new.
    vigil.others = {}
    assert vigil.states(10.0)["/a"] is SILENT
    vigil.others = {"/a": True}
    vigil.answers("/a")
    assert vigil.states()["/a"] is ALIVE


def test_who_ends_is_gone_at_once_and_forgotten_in_the_end(vigil: Vigil) -> None:
    vigil.states(1.0)
    vigil.others = {}
    assert vigil.states() == {"/a": GONE, "/viewer": ALIVE}
    assert vigil.world.clients == []
    vigil.states(601.0)
    assert vigil.states() == {"/viewer": ALIVE}


def test_a_node_without_services_is_listed_but_not_judged(vigil: Vigil) -> None:
    vigil.others = {"/tiny": False}
    assert vigil.states(5.0)["/tiny"] is NodeState.UNKNOWN
    assert vigil.world.asked() == []


def test_who_did_not_look_blames_nobody(vigil: Vigil) -> None:
    """The live view itself was frozen: the others could not be heard."""
    vigil.states(1.0)
    vigil.freeze("/a")
    vigil.states()
    vigil.world.clock.now_s += 30.0
    assert vigil.states()["/a"] is ALIVE
    assert vigil.states(2.0)["/a"] is SILENT


def test_many_nodes_are_asked_less_often_each(vigil: Vigil) -> None:
    vigil.others = {f"/n{number}": True for number in range(100)}
    for node in vigil.others:
        vigil.answers(node)
    assert set(vigil.states(10.0).values()) == {ALIVE}
    assert len(vigil.world.asked()) <= 100 * 7
    vigil.beats.rest()
    assert vigil.world.clients == []
