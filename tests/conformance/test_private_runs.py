"""Runs of one user beside each other, and other users: real processes, real sockets."""

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from fleet import until

from free_ports import free_port
from navette import AsyncParameterClient, Context, Node, Parameter
from navette.files.runs import VARIABLE, RunInfo, live_runs
from navette.files.runs.choice import NETWORK_VARIABLES
from navette.msgs.geometry_msgs.msg import PointStamped, Twist
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.nav_msgs.msg import Path as PathMessage
from navette.msgs.rosgraph_msgs.msg import Clock
from navette.msgs.std_msgs.msg import String
from navette.runtime import Executor

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(os.name != "posix", reason="private runs need POSIX"),
]

NAVETTE = [sys.executable, "-c", "from navette.cli import main; main()"]
OTHER_USER = 54_321
START_S = 90.0
START_NS = round(START_S * 1e9)
NODES = {"/sim", "/costmap", "/map_memory", "/planner", "/control", "/viewer"}


class Terminals:
    """The terminals of one user: programs with nothing set but the runtime folder."""

    def __init__(self, folder: Path) -> None:
        names = (*NETWORK_VARIABLES, VARIABLE, "NAVETTE_TRANSPORT")
        self.environment = {k: v for k, v in os.environ.items() if k not in names}
        self.environment.pop("PYTEST_CURRENT_TEST", None)
        self.environment["NAVETTE_RUNTIME_DIR"] = str(folder)
        self._started: list[subprocess.Popen[str]] = []

    def start(self, *words: str) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [*NAVETTE, *words],
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self._started.append(process)
        return process

    def type(self, *words: str, **env: str) -> subprocess.CompletedProcess[str]:
        """Run a command to its end."""
        return subprocess.run(
            [*NAVETTE, *words],
            env={**self.environment, **env},
            capture_output=True,
            text=True,
            timeout=START_S,
            check=False,
        )

    def close(self) -> None:
        for process in self._started:
            process.send_signal(signal.SIGINT)
        for process in self._started:
            process.communicate(timeout=START_S)


class Observer:
    """A program that has joined one run: what it receives, and what it sends."""

    def __init__(self, run: str, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv(VARIABLE, run)
        self.context = Context(transport="zenoh")
        self.context.init(args=[], initialize_logging=False)
        self.node = Node(f"observer_of_{run.replace('-', '_')}", context=self.context)
        self.executor = Executor(context=self.context)
        self.executor.add_node(self.node)
        self.received: dict[str, list[Any]] = {}
        for kind, topic in (
            (Clock, "/clock"),
            (Odometry, "/odom/filtered"),
            (PathMessage, "/path"),
            (PointStamped, "/goal_point"),
            (String, "/chatter"),
        ):
            messages = self.received[topic] = []
            self.node.create_subscription(kind, topic, messages.append, 10)
        self.goals = self.node.create_publisher(PointStamped, "/goal_point", 10)
        self.commands = self.node.create_publisher(Twist, "/cmd_vel", 10)

    def nodes(self) -> list[str]:
        """Return the full names of all other nodes; duplicates are kept."""
        own = self.node.get_fully_qualified_name()
        names = [info.full_name for info in self.context.graph.nodes()]
        return [name for name in names if name != own]

    def spin_until(self, condition: Callable[[], Any], what: str) -> None:
        self.executor.spin_until_complete(lambda: bool(condition()), START_NS)
        assert condition(), f"not within the limit: {what}"

    def position(self) -> tuple[float, float]:
        point = self.received["/odom/filtered"][-1].pose.pose.position
        return point.x, point.y


def registered(count: int) -> None:
    """Wait until the user has so many runs."""
    until(lambda: len(live_runs()) == count, f"{count} runs", patience_s=START_S)


class TwoRuns:
    """``navette sim`` twice, and an observer in each."""

    def __init__(self, terminals: Terminals, monkeypatch: pytest.MonkeyPatch) -> None:
        self.terminals = terminals
        words = ("sim", "empty", "--port", "0")
        self.processes = [terminals.start(*words), terminals.start(*words)]
        registered(2)
        self.runs = live_runs()
        self.a = Observer(self.runs[0].name, monkeypatch)
        self.b = Observer(self.runs[1].name, monkeypatch)
        for each in (self.a, self.b):
            each.spin_until(lambda e=each: set(e.nodes()) >= NODES, "the stack is up")
            odometry = each.received["/odom/filtered"]
            each.spin_until(lambda o=odometry: len(o) > 3, "odometry")

    def close(self) -> None:
        self.a.context.try_shutdown()
        self.b.context.try_shutdown()


@pytest.fixture
def terminals(monkeypatch: pytest.MonkeyPatch) -> Iterator[Terminals]:
    for name in (*NETWORK_VARIABLES, VARIABLE):
        monkeypatch.delenv(name, raising=False)
    with TemporaryDirectory(prefix="nv-") as folder:
        monkeypatch.setenv("NAVETTE_RUNTIME_DIR", folder)
        terminals = Terminals(Path(folder))
        yield terminals
        terminals.close()


@pytest.fixture
def two(terminals: Terminals, monkeypatch: pytest.MonkeyPatch) -> Iterator[TwoRuns]:
    runs = TwoRuns(terminals, monkeypatch)
    yield runs
    runs.close()


def test_two_runs_are_independent_robots(two: TwoRuns) -> None:
    a, b = two.a, two.b
    for each in (a, b):
        names = [name for name in each.nodes() if name in NODES]
        assert sorted(names) == sorted(NODES)  # each once
        assert len(each.node.get_publishers_info_by_topic("/clock")) == 1

    # A goal: only its robot plans and drives.
    start = b.position()
    goal = PointStamped()
    goal.header.frame_id = "map"
    goal.point.x = a.position()[0] + 2.0
    a.goals.publish(goal)
    a.spin_until(lambda: a.received["/path"], "the robot plans")
    a.spin_until(
        lambda: abs(a.position()[0] - goal.point.x) < 1.0, "the robot drives there"
    )
    before = len(b.received["/odom/filtered"])
    b.spin_until(
        lambda: len(b.received["/odom/filtered"]) > before + 10, "the other one runs on"
    )
    assert b.received["/path"] == []
    assert b.received["/goal_point"] == []
    assert b.position() == pytest.approx(start, abs=0.05)

    # A parameter: only its node changes.
    ours = AsyncParameterClient(b.node, "/control")
    theirs = AsyncParameterClient(a.node, "/control")
    before_value = value_of(a, theirs)
    response = ours.set_parameters([Parameter("reverse_speed_mps", value=0.123)])
    b.spin_until(response.done, "the parameter is set")
    assert value_of(b, ours) == 0.123
    assert value_of(a, theirs) == before_value

    # The clock: each is continuous.
    for each in (a, b):
        stamps = [
            m.clock.sec * 10**9 + m.clock.nanosec for m in each.received["/clock"]
        ]
        assert stamps == sorted(stamps)


def value_of(observer: Observer, client: AsyncParameterClient) -> float:
    future = client.get_parameters(["reverse_speed_mps"])
    observer.spin_until(future.done, "the parameter is read")
    return float(future.result().values[0].double_value)


def test_verbs_ask_which_of_two_runs_and_reach_the_named_one(two: TwoRuns) -> None:
    terminals = two.terminals
    for words in (["topic", "list"], ["node", "list"], ["param", "list"], ["doctor"]):
        refused = terminals.type(*words)
        assert refused.returncode != 0
        assert "2 runs; choose one with --run NAME:" in refused.stderr
        for run in two.runs:
            assert f"  {run.name}" in refused.stderr
            assert run.page in refused.stderr
    second = two.runs[1].name
    for words, env in (
        (["--run", second, "node", "list"], {}),
        (["node", "list", "--run", second], {}),
        (["node", "list", f"--run={second}"], {}),
        (["node", "list"], {"NAVETTE_RUN": second}),
    ):
        listed = terminals.type(*words, **env)
        assert set(listed.stdout.split()) >= NODES, listed.stderr
        observers = [name for name in listed.stdout.split() if "observer" in name]
        assert observers == ["/observer_of_sim_2"]
    outside = terminals.type("--run", "shared", "node", "list")
    assert (outside.returncode, outside.stdout) == (0, "")


def test_stop_is_refused_for_two_runs_and_all_stops_both(two: TwoRuns) -> None:
    refused = two.terminals.type("stop")
    assert refused.returncode == 1
    assert "to stop every robot: navette stop --all" in refused.stderr
    for words, state in (
        (("stop", "--all"), "stopped until: navette stop --all --release"),
        (("stop", "--all", "--release"), "released"),
    ):
        done = two.terminals.type(*words)
        assert done.returncode == 0, done.stderr
        lines = sorted(f"{run.name}/robot: {state}" for run in two.runs)
        assert sorted(done.stdout.splitlines()) == lines


def test_the_doctor_finds_nothing_wrong_with_a_run(terminals: Terminals) -> None:
    terminals.start("sim", "empty", "--port", "0")
    registered(1)

    def is_up() -> bool:
        return set(terminals.type("node", "list").stdout.split()) >= NODES

    until(is_up, "the stack is up", patience_s=START_S)
    done = terminals.type("doctor", "--json")
    findings = json.loads(done.stdout)["findings"]
    wrong = [each for each in findings if each["level"] in ("warning", "problem")]
    assert (wrong, done.returncode) == ([], 0)


def test_one_run_is_found_and_a_taken_port_disturbs_no_one(
    terminals: Terminals, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    port = free_port()
    terminals.start("sim", "empty", "--port", str(port))
    registered(1)
    (run,) = live_runs()
    monkeypatch.setenv(VARIABLE, "")
    observer = Observer("", monkeypatch)
    observer.spin_until(lambda: set(observer.nodes()) >= NODES, "the stack is up")
    changes: list[list[str]] = []
    observer.context.graph.on_change(lambda: changes.append(observer.nodes()))

    refused = terminals.type("sim", "empty", "--port", str(port))
    assert refused.returncode == 2
    assert (
        f"port {port} is in use by run 'sim' (navette sim, pid {run.pid})"
        in refused.stderr
    )
    # It ended before any node existed: each name would have been there twice.
    assert all(len(names) == len(set(names)) for names in changes)
    assert len(observer.node.get_publishers_info_by_topic("/clock")) == 1
    assert [each.name for each in live_runs()] == ["sim"]

    # With nothing prepared: a verb, an unmodified ROS 2 program, a plain program.
    assert "/map" in terminals.type("topic", "list").stdout.split()
    once = terminals.type("topic", "echo", "--once", "/clock")
    assert "clock:" in once.stdout
    listed = terminals.type("ps")
    assert run.page in listed.stdout
    (tmp_path / "ros.py").write_text(
        "import rclpy\nfrom std_msgs.msg import String\n"
        "rclpy.init()\nnode = rclpy.create_node('ros')\n"
        "publisher = node.create_publisher(String, '/chatter', 10)\n"
        "node.create_timer(0.05, lambda: publisher.publish(String(data='ros')))\n"
        "rclpy.spin(node)\n"
    )
    program = terminals.start("run", str(tmp_path / "ros.py"))
    observer.spin_until(
        lambda: observer.received["/chatter"], "the message of the program"
    )
    program.terminate()
    (tmp_path / "plain.py").write_text(
        "import navette\nnavette.init()\n"
        "node = navette.Node('plain')\nprint(*node.get_node_names())\n"
    )
    plain = subprocess.run(
        [sys.executable, tmp_path / "plain.py"],
        env=terminals.environment,
        capture_output=True,
        text=True,
        timeout=START_S,
        check=True,
    )
    assert {"sim", "planner"} <= set(plain.stdout.split())

    # The doctor reports this run's frozen programs.
    run_program = terminals.start("run", str(tmp_path / "ros.py"))
    observer.spin_until(lambda: "/ros" in observer.nodes(), "the program joins")
    run_program.send_signal(signal.SIGSTOP)
    report = terminals.type("doctor")
    run_program.send_signal(signal.SIGCONT)
    run_program.terminate()
    assert "sim: navette sim, world empty" in report.stdout
    assert f"process {run_program.pid}" in report.stdout

    # A robot of its own does not join: the stage for a system of several processes.
    outside = terminals.start("run", "navette", "costmap", "--world", "empty")
    assert outside.stdout is not None
    assert "does not join run sim" in outside.stdout.readline()
    outside.send_signal(signal.SIGINT)
    outside.wait(START_S)
    assert observer.nodes().count("/costmap") == 1
    observer.context.try_shutdown()


def test_a_shared_run_is_not_registered_and_alone_in_its_domain(
    terminals: Terminals,
) -> None:
    terminals.environment["NAVETTE_ROUTER"] = f"tcp/127.0.0.1:{free_port()}"
    process = terminals.start("sim", "empty", "--port", "0", "--max-time", "30")

    def is_up() -> bool:
        return "/clock" in terminals.type("topic", "list").stdout.split()

    until(is_up, "the shared run is found")
    assert live_runs() == []
    assert process.poll() is None

    # A second simulator would drive the same robot: it ends before its first node.
    second = terminals.type("sim", "empty", "--port", "0")
    assert second.returncode == 2
    assert "/sim publishes /clock in domain 0 already" in second.stderr


ATTEMPT = """
import os, socket, sys
user, folder, *paths = sys.argv[1:]
if user != str(os.getuid()):
    os.setgroups([])
    os.setgid(int(user))
    os.setuid(int(user))
def attempt(what, *args):
    try:
        what(*args)
    except OSError as error:
        return type(error).__name__
    return "succeeded"
print(attempt(os.listdir, folder))
for path in paths:
    print(attempt(socket.socket(socket.AF_UNIX).connect, path))
    print(attempt(open, path))
"""


@pytest.mark.skipif(
    not hasattr(os, "getuid") or os.getuid() != 0,
    reason="becoming another user is not permitted here",
)
def test_another_user_reaches_no_socket_and_no_entry_of_a_run(
    terminals: Terminals,
) -> None:
    terminals.start("sim", "empty", "--port", "0")
    registered(1)
    (run,) = live_runs()
    until((run.folder / "router.sock").exists, "the router listens")
    files = sorted(map(str, run.folder.iterdir()))
    assert any(Path(path).is_socket() for path in files)

    def attempts(user: int) -> list[str]:
        words = [sys.executable, "-c", ATTEMPT, str(user), str(run.folder), *files]
        done = subprocess.run(words, capture_output=True, text=True, check=True)
        return done.stdout.split()

    assert set(attempts(OTHER_USER)) == {"PermissionError"}
    assert "succeeded" in attempts(os.getuid())

    # Nor does a listening TCP port exist, besides that of the page.
    assert listening_ports(run) == {int(run.page.rpartition(":")[2])}


def listening_ports(run: RunInfo) -> set[int]:
    """Return the TCP ports on which the processes of a run listen."""
    import psutil

    found = psutil.Process(run.pid).net_connections("inet")
    return {each.laddr.port for each in found if each.status == psutil.CONN_LISTEN}


def test_a_stale_socket_and_entry_of_a_killed_run_are_in_no_ones_way(
    terminals: Terminals,
) -> None:
    first = terminals.start("sim", "empty", "--port", "0")
    registered(1)
    (run,) = live_runs()
    until((run.folder / "router.sock").exists, "the router listens")
    first.kill()
    first.wait()
    assert live_runs() == []
    nothing = terminals.type("--run", "sim", "topic", "list")
    assert "no run 'sim'" in nothing.stderr
    with socket.socket(socket.AF_UNIX) as probe, pytest.raises(ConnectionError):
        probe.connect(str(run.folder / "router.sock"))
    terminals.start("sim", "empty", "--port", "0")

    def is_up() -> bool:
        return "/clock" in terminals.type("topic", "list").stdout.split()

    until(is_up, "the next run is found")
    (again,) = live_runs()
    assert (again.name, again.folder) == (run.name, run.folder)
