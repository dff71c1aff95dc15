"""Periodic node checks: only with interested clients, also when nodes block."""

from typing import Any

import pytest
from remote_fakes import World
from viewer_fakes import DirectCommands, RecordingProgram, sent

from navette.viewer.hub import Hub
from navette.viewer.liveness import PERIOD_S
from navette.viewer.node_monitor import NodeMonitor
from navette.viewer.outbox import Outbox
from navette.viewer.remote_parameters import RemoteParameters


class Bench(World):
    """A hub, its monitor, and an executor that the test runs."""

    def __init__(self) -> None:
        super().__init__()
        self.hub = Hub(
            RecordingProgram(), DirectCommands(), name="test", session_id="1"
        )
        self.events = self.bridge.soon
        remote = RemoteParameters(
            self.hub.reports,
            bridge=self.bridge,
            graph=self,
            service_calls=self.service_calls,
            clock=self.clock,
        )
        remote.set_nodes({"/far": bytes(16)})
        self.monitor = NodeMonitor(
            self.hub.reports,
            bridge=self.bridge,
            graph=self,
            service_calls=self.service_calls,
            remote=remote,
            clock=self.clock,
        )
        self.session = self.hub.join(Outbox())
        sent(self.session.outbox)

    def beat(self, *, blocked: bool = False) -> list[Any]:
        """Run one period of the socket thread; return the reports to the client."""
        self.monitor.on_period()
        while self.events and not blocked:
            self.events.pop(0)()
        self.clock.now_s += PERIOD_S
        return sent(self.session.outbox)


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_no_node_is_probed_without_a_client(bench: Bench) -> None:
    assert bench.beat() == []
    assert (bench.events, bench.asked()) == ([], [])


def test_a_client_receives_reports_until_it_unsubscribes(bench: Bench) -> None:
    bench.hub.receive(bench.session, '{"op": "subscribeNodes"}')
    (reported,) = bench.beat()
    assert (reported["op"], reported["blocked"]) == ("nodes", 0.0)
    assert [(n["name"], n["state"]) for n in reported["nodes"]] == [
        ("/far", "alive"),
        ("/viewer", "alive"),
    ]
    assert bench.asked() == ["/far/list_parameters", "/far/get_parameters"]
    bench.hub.receive(bench.session, '{"op": "unsubscribeNodes"}')
    assert bench.beat() == []
    bench.clock.now_s += 2.0
    bench.beat()  # unanswered calls time out
    bench.beat()
    assert bench.clients == []


def test_the_socket_thread_reports_a_blocked_program(bench: Bench) -> None:
    bench.hub.receive(bench.session, '{"op": "subscribeNodes"}')
    bench.beat()
    reasons = [bench.beat(blocked=True) for _ in range(7)]
    assert reasons[:5] == [[]] * 5
    (reported,) = reasons[6]
    assert reported["blocked"] == 3.0
    assert len(bench.events) == 1  # they do not pile up
    (reported,) = bench.beat()
    assert reported["blocked"] == 0.0
