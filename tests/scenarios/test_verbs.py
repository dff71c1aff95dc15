"""Verbs from a second terminal, against programs in processes of their own."""

import json
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest
from click.testing import CliRunner

from free_ports import free_endpoint
from navette.cli.app import app
from navette.runtime.clock import Stopwatch

LIMIT_S = 60.0
DOMAIN = "37"

TALKER = """
import navette
from navette.msgs.std_msgs.msg import String
navette.init(args=[])
node = navette.Node("talker")
node.declare_parameter("speed", 1.5)
publisher = node.create_publisher(String, "chatter", 10)
node.create_timer(0.1, lambda: publisher.publish(String(data="hi")))
print("ready", flush=True)
navette.spin(node)
"""
SERVER = """
import navette
from navette.msgs.example_interfaces.action import Fibonacci
from navette.msgs.example_interfaces.srv import AddTwoInts
from navette.runtime import Executor
from navette.runtime.action import ActionServer, CancelResponse
from navette.runtime.lifecycle import LifecycleNode

navette.init(args=[])
node = LifecycleNode("server")

def add(request, response):
    response.sum = request.a + request.b
    return response

def end(future):
    if not future.done():
        future.set_result(None)

async def count(goal):
    sequence = [0]
    while len(sequence) <= goal.request.order:
        passed = navette.Future()
        timer = node.create_timer(0.05, lambda: end(passed))
        await passed
        node.destroy_timer(timer)
        if goal.is_cancel_requested:
            print("cancelled", flush=True)
            goal.canceled()
            return Fibonacci.Result(sequence=sequence)
        sequence.append(sum(sequence[-2:]) or 1)
        goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
    goal.succeed()
    return Fibonacci.Result(sequence=sequence)

node.create_service(AddTwoInts, "add", add)
ActionServer(
    node, Fibonacci, "count", count, cancel_callback=lambda goal: CancelResponse.ACCEPT
)
print("ready", flush=True)
navette.spin(node)
"""
COMPLETE = """
eval "$({navette} completion bash)"
navette() {{ {navette} "$@"; }}
for line in "navette node info /t" "navette param get /talker sp" "navette li"; do
    read -ra COMP_WORDS <<< "$line"
    COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))
    COMPREPLY=()
    _navette_completion navette
    echo "${{COMPREPLY[*]}}"
done
complete -p navette
"""


class Child:
    """A program that prints ``ready``; killed at the end."""

    def __init__(self, *words: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, *words], stdout=subprocess.PIPE, text=True
        )
        self.lines: list[str] = []
        self._news = threading.Condition()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def wait_for(self, text: str) -> None:
        """Wait for a line that contains a text."""
        watch = Stopwatch()
        with self._news:
            while not any(text in line for line in self.lines):
                left_s = LIMIT_S - watch.elapsed_s
                assert left_s > 0, f"{text!r} was not printed: {self.lines}"
                assert self.process.poll() is None, f"ended early: {self.lines}"
                self._news.wait(min(left_s, 0.5))

    def end(self) -> None:
        self.process.kill()
        self.process.wait(LIMIT_S)
        self._reader.join()

    def _read(self) -> None:
        assert self.process.stdout is not None
        with self.process.stdout as output:
            for line in output:
                with self._news:
                    self.lines.append(line.strip())
                    self._news.notify_all()


@pytest.fixture(scope="module")
def environment() -> Iterator[None]:
    """A separate network for child processes and verbs."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("NAVETTE_ROUTER", free_endpoint())
        patched.setenv("ROS_DOMAIN_ID", DOMAIN)
        patched.setenv("NAVETTE_TRANSPORT", "zenoh")
        yield


@pytest.fixture(scope="module")
def talker(environment: None) -> Iterator[Child]:
    with ExitStack() as stack:
        child = Child("-c", TALKER)
        stack.callback(child.end)
        child.wait_for("ready")
        yield child


@pytest.fixture(scope="module")
def server(talker: Child) -> Iterator[Child]:
    """A second program; the talker is the router."""
    with ExitStack() as stack:
        child = Child("-c", SERVER)
        stack.callback(child.end)
        child.wait_for("ready")
        yield child


def output_of(*words: str, code: int = 0) -> str:
    done = CliRunner().invoke(app, list(words))
    assert done.exit_code == code, done.output
    return done.stdout


@pytest.mark.slow
def test_verbs_query_and_change_nodes(talker: Child, server: Child) -> None:
    assert output_of("node", "list") == "/server\n/talker\n"
    assert "    /chatter: std_msgs/msg/String\n" in output_of("node", "info", "talker")
    assert output_of("param", "get", "talker", "speed") == "Double value is: 1.5\n"
    assert (
        output_of("param", "set", "talker", "speed", "3")
        == "Set parameter successful\n"
    )
    assert "    speed: 3.0\n" in output_of("param", "dump")
    assert "/add [example_interfaces/srv/AddTwoInts]\n" in output_of(
        "service", "list", "-t"
    )
    called = output_of("service", "call", "/add", "{a: 2, b: 3}", "--json")
    assert json.loads(called) == {"sum": 5}
    assert output_of("action", "info", "/count", "-c").endswith("Action servers: 1\n")
    goal = output_of("action", "send_goal", "/count", "{order: 3}", "--json", "-f")
    assert json.loads(goal.splitlines()[-1]) == {
        "status": "SUCCEEDED",
        "result": {"sequence": [0, 1, 1, 2]},
    }
    assert output_of("lifecycle", "get", "server") == "unconfigured [1]\n"
    assert output_of("lifecycle", "set", "server", "configure")
    assert output_of("lifecycle", "get") == "/server: inactive [2]\n"


@pytest.mark.slow
def test_ctrl_c_cancels_the_goal(server: Child) -> None:
    goal = ("action", "send_goal", "/count", "{order: 1000}", "-f")
    verb = Child("-m", "navette", *goal)
    try:
        verb.wait_for("Feedback:")
        verb.process.send_signal(signal.SIGINT)
        assert verb.process.wait(LIMIT_S) == 130
    finally:
        verb.end()
    assert verb.lines[-2:] == ["Canceling goal...", "Goal canceled."]
    server.wait_for("cancelled")


@pytest.mark.slow
def test_bash_completes(talker: Child) -> None:
    bash = shutil.which("bash")
    if bash is None:
        pytest.skip("no bash here")
    navette = f"{sys.executable} -m navette"
    # The completion calls `navette`, also where the environment is not activated.
    paths = (sysconfig.get_path("scripts"), os.environ["PATH"])
    done = subprocess.run(
        [bash, "--norc", "-c", COMPLETE.format(navette=navette)],
        env={**os.environ, "PATH": os.pathsep.join(paths)},
        capture_output=True,
        text=True,
        check=False,
        timeout=LIMIT_S,
    )
    assert done.stderr == ""
    assert done.stdout.splitlines() == [
        "/talker",
        "speed",
        "lifecycle",
        "complete -o nosort -F _navette_completion navette",
    ]


@pytest.mark.slow
def test_doctor_of_a_program_that_is_stopped(talker: Child, server: Child) -> None:
    """A stopped program, then the stopped router."""
    seen = _doctor()
    assert seen["router"]["data"]["pid"] in (talker.process.pid, None)
    assert seen["nodes"]["level"] == "good"
    with _stopped(server):
        assert _doctor(code=1)["/server"]["level"] == "problem"
    if sys.platform != "linux":
        return  # the owner of a port and its state are read from /proc
    with _stopped(talker):
        router = _doctor(code=1)["router"]
        assert router["level"] == "problem"
        assert "which is stopped" in router["text"]


def _doctor(code: int = 0) -> dict[str, dict[str, object]]:
    report = json.loads(output_of("doctor", "--json", code=code))
    return {each["what"]: each for each in report["findings"]}


@contextmanager
def _stopped(child: Child) -> Iterator[None]:
    os.kill(child.process.pid, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(child.process.pid, signal.SIGCONT)
