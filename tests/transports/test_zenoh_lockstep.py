"""A lock-step over Zenoh, between contexts that share only the network."""

import threading
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
import zenoh
from transport_pairs import LIMIT_S, until

from free_ports import free_endpoint
from navette import Context, DurabilityPolicy, Node, QoSProfile
from navette.errors import InvalidValueError, LockStepError
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.std_msgs.msg import Int64, String
from navette.runtime import Executor, SystemClock
from navette.runtime.context import new_graph
from navette.runtime.lockstep import Coordinator, LockStepClock, Participant
from navette.transports.zenoh import ZenohTransport

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
Received = list[tuple[str, int, int]]  # (content, received ms, sent ms)


class Member:
    """A node with its own context, session and thread."""

    def __init__(self, name: str, clock: LockStepClock, stack: ExitStack) -> None:
        self.context = stack.enter_context(Context(clock=clock))
        self.node = Node(name, context=self.context)
        self.received: Received = []
        self.error: Exception | None = None
        self._thread = threading.Thread(target=self._spin)
        stack.callback(self._end)

    def start(self) -> None:
        self._executor = Executor(context=self.context)
        self._executor.add_node(self.node)
        self._thread.start()

    def subscribe(self, topic: str, kind: type = Int64, qos: Any = 10) -> None:
        def receive(message: Any, info: Any) -> None:
            now = self.context.clock.now_ns // 10**6
            sent = info["source_timestamp"] // 10**6
            self.received.append((f"{topic} {message.data}", now, sent))

        self.node.create_subscription(kind, topic, receive, qos)

    def count(self, topic: str, period_s: float) -> None:
        """Publish numbers from 1, one each period."""
        publisher, numbers = (
            self.node.create_publisher(Int64, topic, 10),
            iter(range(1, 10**6)),
        )
        self.node.create_timer(
            period_s, lambda: publisher.publish(Int64(data=next(numbers)))
        )

    def wait(self) -> None:
        self._thread.join(60.0)
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


def run_of_three(backwards: bool) -> list[Received]:
    """Run a simulator that counts, a node that answers, a node that records both."""
    with ExitStack() as stack:
        sim = Member("sim", Coordinator(["echo", "ear"], until_s=0.1), stack)
        echo, ear = (
            Member("echo", Participant(), stack),
            Member("ear", Participant(), stack),
        )
        sim.count("/tick", 0.02)
        sim.subscribe("/answer")
        answers = echo.node.create_publisher(Int64, "/answer", 10)
        # A volatile message from before the first step is not delivered.
        answers.publish(Int64(data=-1))
        echo.node.create_subscription(
            Int64, "/tick", lambda m: answers.publish(Int64(data=10 * m.data)), 10
        )
        echo.node.create_publisher(String, "/map", LATCHED).publish(String(data="map"))
        echo.count("/own", 0.03)
        for topic in ("/tick", "/answer", "/own"):
            ear.subscribe(topic)
        ear.subscribe("/map", String, LATCHED)
        members = [sim, echo, ear]
        for member in reversed(members) if backwards else members:
            member.start()
        for member in members:
            member.wait()
            assert member.error is None
        assert all(m.context.clock.now_ns == 100_000_000 for m in members)
        return [sim.received, ear.received]


def test_two_runs_are_equal(stack: ExitStack) -> None:
    """The order in which the processes start does not matter."""
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


def test_a_participant_that_is_gone_is_named(stack: ExitStack) -> None:
    coordinator = Coordinator(["echo", "ear"])
    sim = Member("sim", coordinator, stack)
    echo, ear = (
        Member("echo", Participant(), stack),
        Member("ear", Participant(), stack),
    )
    for member in (sim, echo, ear):
        member.start()
    until(lambda: coordinator.step > 10, "steps")
    echo.context.shutdown()
    sim.wait()
    assert "gone at" in str(sim.error)
    assert str(sim.error).endswith("/echo")
    sim.context.shutdown()
    ear.wait()
    assert "the simulator is gone" in str(ear.error)


def test_services_work_during_the_lock_step(stack: ExitStack) -> None:
    """Called by a participant and from outside."""
    coordinator = Coordinator(["echo"])
    sim, echo = Member("sim", coordinator, stack), Member("echo", Participant(), stack)

    def add(request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        return response

    echo.node.create_service(AddTwoInts, "/add", add)
    inside = sim.node.create_client(AddTwoInts, "/add")
    outside = stack.enter_context(Context(clock=SystemClock(), transport="zenoh"))
    node = Node("outside", context=outside)
    client = node.create_client(AddTwoInts, "/add")
    sim.start()
    echo.start()
    until(lambda: coordinator.step > 3, "steps")
    assert client.call(AddTwoInts.Request(a=1, b=2), timeout_sec=LIMIT_S).sum == 3
    asked = sim.context.loop.call_soon_threadsafe
    futures: list[Any] = []
    asked(lambda: futures.append(inside.call_async(AddTwoInts.Request(a=2, b=3))))
    until(lambda: bool(futures) and futures[0].done(), "a reply")
    assert futures[0].result().sum == 5


def test_messages_from_outside_are_received(stack: ExitStack) -> None:
    coordinator = Coordinator(["echo"])
    sim, echo = Member("sim", coordinator, stack), Member("echo", Participant(), stack)
    echo.subscribe("/word", String)
    outside = stack.enter_context(Context(clock=SystemClock(), transport="zenoh"))
    publisher = Node("outside", context=outside).create_publisher(String, "/word", 10)
    sim.start()
    echo.start()
    until(lambda: publisher.get_subscription_count() > 0, "a subscription")
    for word in "abc":
        publisher.publish(String(data=word))
    until(lambda: len(echo.received) >= 3, "all words")
    assert [text for text, _, _ in echo.received] == ["/word a", "/word b", "/word c"]


def test_a_new_subscription_receives_the_steps_after_it(
    stack: ExitStack,
) -> None:
    coordinator = Coordinator(["ear"], until_s=1.0)
    sim, ear = Member("sim", coordinator, stack), Member("ear", Participant(), stack)
    sim.count("/tick", 0.02)
    sim.node.create_publisher(String, "/map", LATCHED).publish(String(data="map"))

    def subscribe() -> None:
        ear.subscribe("/tick")
        ear.subscribe("/map", String, LATCHED)

    ear.context.loop.call_at(500_000_000, subscribe)
    sim.start()
    ear.start()
    sim.wait()
    ear.wait()
    assert sim.error is ear.error is None
    # Created at 0.5 s, in the step that ends then; known to all before the next one.
    assert ear.received[0] == ("/map map", 500, 0)
    assert ear.received[1:3] == [("/tick 26", 520, 520), ("/tick 27", 540, 540)]
    assert len(ear.received) == 26


def test_a_participant_that_starts_too_late_is_an_error(stack: ExitStack) -> None:
    coordinator = Coordinator(["echo"])
    sim, echo = Member("sim", coordinator, stack), Member("echo", Participant(), stack)
    sim.start()
    echo.start()
    until(lambda: coordinator.step > 3, "steps")
    late = Member("late", Participant(), stack)
    late.start()
    late.wait()
    assert "does not wait for /late" in str(late.error)
    assert sim.error is None


def test_invalid_reports_are_logged_once(
    stack: ExitStack, caplog: pytest.LogCaptureFixture
) -> None:
    coordinator = Coordinator(["echo"], until_s=0.5)
    sim, echo = Member("sim", coordinator, stack), Member("echo", Participant(), stack)
    session = transport_of(sim).session
    other = transport_of(echo).session.zenoh
    for _ in range(2):
        other.put("0/navette_lockstep/report/abc", b"nonsense")
        other.put("0/navette_lockstep/report/abc", b"x" * (2**22 + 1))
    until(lambda: "report of session abc ignored" in caplog.text, "a warning")
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
    Context(clock=Participant(), graph=graph).init(args=[])
    with pytest.raises(InvalidValueError, match="only one context"):
        Context(clock=Participant(), graph=graph).init(args=[])


def transport_of(member: Member) -> ZenohTransport:
    transport = member.context.graph.transports[1]
    assert isinstance(transport, ZenohTransport)
    return transport
