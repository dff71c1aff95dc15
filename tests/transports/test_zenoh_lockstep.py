"""A lock-step over Zenoh: contexts of one process that share the network alone."""

import threading
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
import zenoh
from transport_benches import free_endpoint, until

from navette import Context, DurabilityPolicy, Node, QoSProfile
from navette.errors import InvalidValueError, LockStepError
from navette.msgs.std_msgs.msg import Int64, String
from navette.runtime import Executor
from navette.runtime.context import new_graph
from navette.runtime.lockstep import Conductor, Follower, LockStepClock
from navette.transports.zenoh import ZenohTransport

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
Heard = list[tuple[str, int, int]]  # (what, when, sent when)


class Member:
    """A node with a context, a session and a thread of its own."""

    def __init__(self, name: str, clock: LockStepClock, stack: ExitStack) -> None:
        self.context = stack.enter_context(Context(clock=clock))
        self.node = Node(name, context=self.context)
        self.heard: Heard = []
        self.error: Exception | None = None
        self._thread = threading.Thread(target=self._spin)
        stack.callback(self._end)

    def start(self) -> None:
        self._executor = Executor(context=self.context)
        self._executor.add_node(self.node)
        self._thread.start()

    def hear(self, topic: str, kind: type = Int64, qos: Any = 10) -> None:
        def note(message: Any, info: Any) -> None:
            now = self.context.clock.now_ns // 10**6
            sent = info["source_timestamp"] // 10**6
            self.heard.append((f"{topic} {message.data}", now, sent))

        self.node.create_subscription(kind, topic, note, qos)

    def count(self, topic: str, period_s: float) -> None:
        """Numbers from 1, one each period."""
        publisher, numbers = (
            self.node.create_publisher(Int64, topic, 10),
            iter(range(1, 10**6)),
        )
        self.node.create_timer(
            period_s, lambda: publisher.publish(Int64(data=next(numbers)))
        )

    def wait(self) -> None:
        self._thread.join(30.0)
        assert not self._thread.is_alive()

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except LockStepError as error:
            self.error = error

    def _end(self) -> None:
        self.context.try_shutdown()
        if self._thread.ident is not None:
            self.wait()


@pytest.fixture
def stack(monkeypatch: pytest.MonkeyPatch) -> Iterator[ExitStack]:
    monkeypatch.setenv("NAVETTE_ROUTER", free_endpoint())
    monkeypatch.delenv("NAVETTE_TRANSPORT", raising=False)
    with ExitStack() as made:
        yield made


def run_of_three(backwards: bool) -> list[Heard]:
    """A simulator that counts, one that answers, one that listens to both."""
    with ExitStack() as stack:
        sim = Member("sim", Conductor(["echo", "ear"], until_s=0.1), stack)
        echo, ear = Member("echo", Follower(), stack), Member("ear", Follower(), stack)
        sim.count("/tick", 0.02)
        sim.hear("/answer")
        answers = echo.node.create_publisher(Int64, "/answer", 10)
        # What was said before all were there, and is not kept, nobody hears.
        answers.publish(Int64(data=-1))
        echo.node.create_subscription(
            Int64, "/tick", lambda m: answers.publish(Int64(data=10 * m.data)), 10
        )
        echo.node.create_publisher(String, "/map", LATCHED).publish(String(data="map"))
        echo.count("/own", 0.03)
        for topic in ("/tick", "/answer", "/own"):
            ear.hear(topic)
        ear.hear("/map", String, LATCHED)
        members = [sim, echo, ear]
        for member in reversed(members) if backwards else members:
            member.start()
        for member in members:
            member.wait()
            assert member.error is None
        assert all(m.context.clock.now_ns == 100_000_000 for m in members)
        return [sim.heard, ear.heard]


def test_two_runs_are_the_same(stack: ExitStack) -> None:
    """Whatever the order in which the processes begin."""
    sim, ear = run_of_three(backwards=False)
    assert sim == [(f"/answer {n}0", 20 * n + 10, 20 * n) for n in range(1, 5)]
    assert ear[0] == ("/map map", 0, 0)
    assert ear[1:6] == [
        ("/tick 1", 20, 20),
        ("/answer 10", 30, 20),
        ("/own 1", 30, 30),
        ("/tick 2", 40, 40),
        ("/answer 20", 50, 40),
    ]
    assert run_of_three(backwards=True) == [sim, ear]


def test_a_member_that_goes_is_named(stack: ExitStack) -> None:
    conductor = Conductor(["echo", "ear"])
    sim = Member("sim", conductor, stack)
    echo, ear = Member("echo", Follower(), stack), Member("ear", Follower(), stack)
    for member in (sim, echo, ear):
        member.start()
    until(lambda: conductor.step > 10, "steps")
    echo.context.shutdown()
    sim.wait()
    assert "gone at" in str(sim.error)
    assert str(sim.error).endswith("/echo")
    sim.context.shutdown()
    ear.wait()
    assert "the simulator is gone" in str(ear.error)


def test_who_comes_later_learns_that_it_is_too_late(stack: ExitStack) -> None:
    conductor = Conductor(["echo"])
    sim, echo = Member("sim", conductor, stack), Member("echo", Follower(), stack)
    sim.start()
    echo.start()
    until(lambda: conductor.step > 3, "steps")
    late = Member("late", Follower(), stack)
    late.start()
    late.wait()
    assert "does not wait for /late" in str(late.error)
    assert sim.error is None


def test_nonsense_on_the_wire_is_complained_about_once(
    stack: ExitStack, caplog: pytest.LogCaptureFixture
) -> None:
    conductor = Conductor(["echo"], until_s=0.5)
    sim, echo = Member("sim", conductor, stack), Member("echo", Follower(), stack)
    session = transport_of(sim).session
    stranger = transport_of(echo).session.zenoh
    for _ in range(2):
        stranger.put("0/navette_lockstep/report/abc", b"nonsense")
        stranger.put("0/navette_lockstep/report/abc", b"x" * (2**22 + 1))
    until(lambda: "report of session abc ignored" in caplog.text, "a complaint")
    sim.start()
    echo.start()
    sim.wait()
    echo.wait()
    assert sim.error is None
    assert caplog.text.count("ignored") == 1
    assert isinstance(session.zenoh, zenoh.Session)


def test_a_second_context_of_a_process_cannot_take_part(stack: ExitStack) -> None:
    graph = new_graph()
    stack.callback(graph.close)
    Context(clock=Follower(), graph=graph).init(args=[])
    with pytest.raises(InvalidValueError, match="only one context"):
        Context(clock=Follower(), graph=graph).init(args=[])


def transport_of(member: Member) -> ZenohTransport:
    transport = member.context.graph.transports[1]
    assert isinstance(transport, ZenohTransport)
    return transport
