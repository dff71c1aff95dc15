"""The beat that asks nodes: only for who wants to know, and also when nodes hang."""

from collections.abc import Callable
from typing import Any

import pytest
from remote_fakes import World, encoded
from viewer_fakes import RecordingRobot, sent

from navette.viewer.beats import Beats
from navette.viewer.heartbeats import PERIOD_S
from navette.viewer.hub import Hub
from navette.viewer.outbox import Outbox
from navette.viewer.remote_parameters import RemoteParameters


class Bench(World):
    """A hub, its beat, and an executor that runs when told."""

    def __init__(self) -> None:
        super().__init__()
        self.hub = Hub(RecordingRobot(), name="test", session_id="1")
        self.events: list[Callable[[], None]] = []
        remote = RemoteParameters(
            self.questions, encoded, self.clock, lambda _: None, lambda _: None
        )
        self.beats = Beats(
            self.hub,
            lambda function, *args: function(*args),
            lambda function, _: self.events.append(function),
            lambda: ({"/viewer"}, {"/far": True}),
            self.questions,
            remote,
            self.clock,
        )
        self.session = self.hub.join(Outbox())
        sent(self.session.outbox)

    def beat(self, *, hangs: bool = False) -> list[Any]:
        """A beat of the socket thread; what the client is told."""
        self.beats.on_beat()
        while self.events and not hangs:
            self.events.pop(0)()
        self.clock.now_s += PERIOD_S
        return sent(self.session.outbox)


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_nobody_is_asked_while_nobody_wants_to_know(bench: Bench) -> None:
    assert bench.beat() == []
    assert (bench.events, bench.asked()) == ([], [])


def test_who_asks_is_told_until_he_no_longer_wants_to_know(bench: Bench) -> None:
    bench.hub.receive(bench.session, '{"op": "subscribeNodes"}')
    (told,) = bench.beat()
    assert (told["op"], told["hangs"]) == ("nodes", 0.0)
    assert [(n["name"], n["state"]) for n in told["nodes"]] == [
        ("/far", "alive"),
        ("/viewer", "alive"),
    ]
    assert bench.asked() == ["/far/get_parameters"]
    bench.hub.receive(bench.session, '{"op": "unsubscribeNodes"}')
    assert bench.beat() == []
    bench.clock.now_s += 2.0
    bench.beat()  # gives up what nobody answered
    bench.beat()
    assert bench.clients == []


def test_a_program_that_hangs_is_told_by_the_socket_thread(bench: Bench) -> None:
    bench.hub.receive(bench.session, '{"op": "subscribeNodes"}')
    bench.beat()
    said = [bench.beat(hangs=True) for _ in range(7)]
    assert said[:5] == [[]] * 5
    (told,) = said[6]
    assert told["hangs"] == 3.0
    assert len(bench.events) == 1  # they do not pile up
    (told,) = bench.beat()
    assert told["hangs"] == 0.0
