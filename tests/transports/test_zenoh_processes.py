"""Several processes on one network: discovery, and the end of single processes."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
from transport_pairs import LIMIT_S, until, zenoh_environment

from free_ports import free_endpoint
from navette import (
    ActionClient,
    AsyncParameterClient,
    Context,
    DurabilityPolicy,
    Node,
    QoSProfile,
)
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.msgs.rcl_interfaces.msg import Log
from navette.msgs.std_msgs.msg import String
from navette.runtime import Executor
from navette.runtime.exceptions import ServiceFailedError

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="signals are POSIX's"),
]

TALKER = """
import sys, navette
from navette.msgs.std_msgs.msg import String
navette.init(args=[])
node = navette.Node(sys.argv[1])
publisher = node.create_publisher(String, "chatter", 10_000)
count = 0
def talk():
    global count
    count += 1
    publisher.publish(String(data=f"{sys.argv[1]} {count}"))
    if count == 1:  # it spins: a signal before that would end the context first
        print("ready", flush=True)
node.create_timer(0.01, talk)
navette.spin(node)
"""

SERVER = """
import navette
from navette.msgs.example_interfaces.srv import AddTwoInts
navette.init(args=[])
node = navette.Node("adder")
def add(request, response):
    if request.a < 0:
        node.get_logger().info("asked")
        print("asked", flush=True)
        navette.spin_until_future_complete(node, navette.Future())
    response.sum = request.a + request.b
    return response
node.create_service(AddTwoInts, "add", add)
print("ready", flush=True)
navette.spin(node)
"""

SILENT = """
import navette
navette.init(args=[])
node = navette.Node("first")
print("ready", flush=True)
navette.spin(node)
"""


WORKER = """
import navette
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.std_msgs.msg import String
navette.init(args=[])
node = navette.Node("worker")
node.declare_parameter("gain", 1.5)
def count(goal_handle):
    numbers = [0, 1]
    for _ in range(goal_handle.request.order - 2):
        numbers.append(numbers[-1] + numbers[-2])
        goal_handle.publish_feedback(Fibonacci.Feedback(sequence=numbers))
    goal_handle.succeed()
    return Fibonacci.Result(sequence=numbers)
server = navette.ActionServer(node, Fibonacci, "count", count)
latched = navette.QoSProfile(
    depth=1, durability=navette.DurabilityPolicy.TRANSIENT_LOCAL
)
map_publisher = node.create_publisher(String, "map", latched)
map_publisher.publish(String(data="older"))
map_publisher.publish(String(data="the map"))
node.get_logger().warning("working")
print("ready", flush=True)
navette.spin(node)
"""


class Child:
    """A process that prints ``ready``; killed at the end of the test."""

    def __init__(
        self, program: str, router: str, *args: str, is_waited_for: bool = True
    ) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-c", program, *args],
            env=zenoh_environment(router),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.lines: list[str] = []
        self._ended: tuple[int, str] | None = None
        self._reader = threading.Thread(target=self._read)
        self._reader.start()
        if is_waited_for:
            until(lambda: "ready" in self.lines, "the child's start")

    def end(self, signum: int = signal.SIGKILL) -> tuple[int, str]:
        """Send a signal; return exit code and standard error."""
        if self._ended is None:
            self._process.send_signal(signum)
            code = self._process.wait(LIMIT_S)
            self._reader.join()
            assert self._process.stderr is not None
            self._ended = code, self._process.stderr.read()
            self._process.stderr.close()
        return self._ended

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as output:
            self.lines.extend(line.strip() for line in output)


class Network:
    """Child processes and contexts of this process on a private network."""

    def __init__(self, stack: ExitStack, monkeypatch: pytest.MonkeyPatch) -> None:
        self.router = free_endpoint()
        self._stack = stack
        monkeypatch.setenv("NAVETTE_ROUTER", self.router)

    def child(self, program: str, *args: str, is_waited_for: bool = True) -> Child:
        child = Child(program, self.router, *args, is_waited_for=is_waited_for)
        self._stack.callback(child.end)
        return child

    def node(self, name: str) -> tuple[Node, Executor]:
        context = self._stack.enter_context(Context(transport="zenoh"))
        node = Node(name, context=context)
        executor = Executor(context=context)
        executor.add_node(node)
        return node, executor


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> Iterator[Network]:
    with ExitStack() as stack:
        yield Network(stack, monkeypatch)


def listen(node: Node) -> list[str]:
    received: list[str] = []
    # No message may be dropped while the test waits without spinning.
    node.create_subscription(
        String, "chatter", lambda m: received.append(m.data), 10_000
    )
    return received


def spin_until(executor: Executor, condition: Any, what: str) -> None:
    def look() -> bool:
        executor.spin_once(timeout_sec=0.01)
        return bool(condition())

    until(look, what)


def test_two_processes_discover_each_other(
    network: Network,
) -> None:
    network.child(TALKER, "talker")
    node, executor = network.node("listener")
    # The graph is complete at once, without a discovery wait.
    assert "talker" in node.get_node_names()
    assert ("/chatter", ["std_msgs/msg/String"]) in node.get_topic_names_and_types()
    received = listen(node)
    spin_until(executor, lambda: len(received) >= 20, "20 messages")
    numbers = [int(text.split()[1]) for text in received]
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))


def test_another_process_takes_over_when_the_router_is_killed(network: Network) -> None:
    first = network.child(SILENT)
    network.child(TALKER, "talker")
    node, executor = network.node("listener")
    received = listen(node)
    spin_until(executor, lambda: len(received) >= 5, "messages")
    assert first.end()[0] == -signal.SIGKILL
    until(lambda: "first" not in node.get_node_names(), "the loss of its token")
    network.child(TALKER, "late")
    spin_until(
        executor, lambda: any("late" in text for text in received), "the newcomer"
    )
    spin_until(executor, lambda: len(received) >= 50, "more messages")
    numbers = [int(t.split()[1]) for t in received if t.startswith("talker")]
    # The remaining processes are not affected.
    assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))


def test_a_remote_service_replies_and_its_end_is_reported(
    network: Network,
) -> None:
    server = network.child(SERVER)
    node, executor = network.node("caller")
    client = node.create_client(AddTwoInts, "add")
    assert client.service_is_ready()
    assert client.call(AddTwoInts.Request(a=2, b=3), timeout_sec=LIMIT_S).sum == 5
    future = client.call_async(AddTwoInts.Request(a=-1))
    until(lambda: "asked" in server.lines, "the request")
    server.end()
    spin_until(executor, future.done, "the failure")
    with pytest.raises(ServiceFailedError, match="/add failed: the server closed"):
        future.result()


def test_actions_parameters_logs_and_latched_maps_between_processes(
    network: Network,
) -> None:
    network.child(WORKER)
    node, executor = network.node("boss")
    maps: list[str] = []
    logs: list[str] = []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(String, "map", lambda m: maps.append(m.data), latched)
    past = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(Log, "/rosout", lambda m: logs.append(m.msg), past)
    spin_until(executor, lambda: maps and "working" in logs, "what was logged before")
    assert maps == ["the map"]

    parameters = AsyncParameterClient(node, "/worker")
    assert parameters.services_are_ready()
    answer = parameters.get_parameters(["gain"])
    spin_until(executor, answer.done, "the parameter")
    assert answer.result().values[0].double_value == 1.5

    client = ActionClient(node, Fibonacci, "count")
    assert client.server_is_ready()
    steps: list[int] = []
    sent = client.send_goal_async(
        Fibonacci.Goal(order=6),
        feedback_callback=lambda m: steps.append(len(m.feedback.sequence)),
    )
    spin_until(executor, sent.done, "the goal's acceptance")
    result = sent.result().get_result_async()
    spin_until(executor, lambda: result.done() and len(steps) == 4, "the result")
    assert list(result.result().result.sequence) == [0, 1, 1, 2, 3, 5]
    assert steps == [3, 4, 5, 6]


def test_processes_that_start_together_agree_on_a_router(network: Network) -> None:
    names = {f"racer{number}" for number in range(6)}
    racers = [
        network.child(TALKER, name, is_waited_for=False) for name in sorted(names)
    ]
    for racer in racers:
        until(lambda racer=racer: "ready" in racer.lines, "a start")  # type: ignore[misc]
    node, executor = network.node("judge")
    assert names <= set(node.get_node_names())
    received = listen(node)
    spin_until(
        executor, lambda: {text.split()[0] for text in received} == names, "everybody"
    )


@pytest.mark.parametrize("signum", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_process_ends_at_once(network: Network, signum: int) -> None:
    child = network.child(TALKER, "talker")
    code, errors = child.end(signum)
    # As Python ends on a Ctrl-C, and ROS 2 on SIGTERM; nothing hangs or crashes.
    assert code == (-signal.SIGINT if signum == signal.SIGINT else 0)
    assert "panicked" not in errors


INTERRUPTED = """
import signal, threading, zenoh
from navette.transports.zenoh.callbacks import direct

def on_token(token):
    on_main = threading.current_thread() is threading.main_thread()
    print("on the main thread:", on_main, flush=True)
    signal.raise_signal(signal.SIGINT)

config = zenoh.Config()
config.insert_json5("scouting/multicast/enabled", "false")
config.insert_json5("listen/endpoints", "[]")
session = zenoh.open(config)
liveliness = session.liveliness()
subscriber = liveliness.declare_subscriber("a/**", direct(on_token))
try:
    token = liveliness.declare_token("a/b")
    threading.Event().wait(LIMIT_S)
    print("went on")
except KeyboardInterrupt:
    print("interrupted")
session.close()
"""


def test_an_interrupt_in_a_callback_of_zenoh_is_not_lost() -> None:
    """Zenoh calls the thread that declares a token, and prints errors there."""
    script = INTERRUPTED.replace("LIMIT_S", str(LIMIT_S))
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    assert done.stdout.splitlines() == ["on the main thread: True", "interrupted"]
    assert done.stderr == ""
