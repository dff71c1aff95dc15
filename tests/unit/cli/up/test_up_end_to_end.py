"""Supervisors with processes, from up to down."""

import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

import navette as package
from navette.cli.app import app
from navette.files.runs.choice import NETWORK_VARIABLES
from navette.supervisor.client import killed_supervisor, known_projects
from navette.supervisor.log_store import LogReader
from navette.supervisor.project import socket_path

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="supervisors need Unix sockets"),
]
WAIT_S = 60.0

# Holds a named pipe open until its end.
HOLD = (
    "import signal, sys; f = open(sys.argv[1], 'w'); print(sys.argv[2]); signal.pause()"
)
NODE = """
import rclpy
from rclpy.node import Node

rclpy.init()
node = Node("edited")
node.create_timer(0.01, lambda: print("version 1"))
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    print("interrupted")
"""


def wait_for(condition: Callable[[], object]) -> None:
    """Poll a condition, with a time limit."""
    pause = threading.Event()
    for _ in range(int(WAIT_S / 0.02)):
        if condition():
            return
        pause.wait(0.02)
    raise AssertionError("timed out")


def log_lines(bench: Any) -> list[str]:
    reader = LogReader(bench.client.project.state)
    lines = [f"{line.label}: {line.text}" for line in reader.last(None)]
    reader.close()
    return lines


def navette(*words: str) -> Result:
    return CliRunner().invoke(app, list(words))


class Pipe:
    """A named pipe that a process holds open."""

    def __init__(self, path: Path) -> None:
        os.mkfifo(path)
        self.path = path
        self._file = os.open(path, os.O_RDONLY | os.O_NONBLOCK)

    def wait_end(self) -> None:
        """Wait until no process holds the pipe."""
        poll = select.poll()
        poll.register(self._file, 0)
        assert poll.poll(WAIT_S * 1000), "still held, or never opened"
        os.close(self._file)


def holder(pipe: Pipe, text: str = "holding") -> str:
    words = [sys.executable, "-u", "-c", HOLD, str(pipe.path), text]
    return json.dumps({"command": words, "name": "hold"})


@pytest.mark.usefixtures("bench")
def test_ps_names_the_network_whose_robots_are_not_listed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for variable in ("NAVETTE_RUN", *NETWORK_VARIABLES):
        monkeypatch.delenv(variable, raising=False)
    assert "shared network" not in navette("ps").output
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    assert "robots on the shared network" in navette("ps").output


def test_from_up_to_down(bench: Any) -> None:
    pipe = Pipe(bench.folder / "pipe")
    bench.write(
        f"services:\n  a: {{nodes: [{holder(pipe)}]}}\n"
        "  b: {depends_on: [a], nodes: [{command: sleep 1000}]}\n"
    )
    up = navette("up", "b")
    assert up.exit_code == 0, up.output
    assert up.output.split("\n")[:2] == ["a/hold  running", "b/sleep  running"]
    wait_for(lambda: "a/hold: holding" in log_lines(bench))
    assert "a/hold: holding" in navette("logs", "a").output.replace("Z ", "")
    assert "holding" not in navette("logs", "b").output
    nothing = navette("logs", "hold").output
    assert f"no output of hold in {bench.folder}" in nothing
    assert "output of a/hold, b/sleep" in nothing
    (first, second) = json.loads(navette("ps", "--json").output)
    assert (first["label"], first["state"]) == ("a/hold", "running")
    assert os.getpgid(first["pid"]) == first["pid"]
    table = navette("ps").output.split("\n")
    assert table[0].split()[:4] == ["SERVICE", "PROCESS", "STATE", "PID"]
    assert table[2].split()[:4] == ["b", "sleep", "running", str(second["pid"])]
    assert str(bench.folder) in navette("ps", "--all").output

    down = navette("down", "b")
    assert down.output == "b/sleep  stopped\n"
    assert [each["label"] for each in json.loads(navette("ps", "--json").output)] == [
        "a/hold"
    ]
    assert navette("down").exit_code == 0
    pipe.wait_end()
    wait_for(lambda: not bench.client.project.is_supervised)
    assert "nothing is up" in navette("ps").output
    assert "nothing is up" in navette("down").output
    assert "nothing is up" in str(navette("down", "a").exception)
    assert not known_projects()


def test_no_process_outlives_a_killed_supervisor(bench: Any) -> None:
    pipe = Pipe(bench.folder / "pipe")
    bench.write(f"services: {{a: {{nodes: [{holder(pipe)}]}}}}")
    bench.up()
    wait_for(lambda: "a/hold: holding" in log_lines(bench))
    project = bench.client.project
    pid = json.loads((project.state / "supervisor.json").read_text())["pid"]
    os.kill(pid, signal.SIGKILL)
    pipe.wait_end()
    wait_for(lambda: killed_supervisor(project) == pid)
    assert bench.client.status() == []
    assert f"(pid {pid}) was killed" in navette("ps").output
    second = Pipe(bench.folder / "second")
    bench.write(f"services: {{a: {{nodes: [{holder(second, 'again')}]}}}}")
    assert set(bench.up()) == {"a/hold"}
    wait_for(lambda: "a/hold: again" in log_lines(bench))
    bench.down()
    second.wait_end()


@pytest.mark.skipif(
    not Path("/proc/self").is_dir(), reason="leftovers are found in Linux's /proc"
)
def test_the_next_supervisor_ends_leftover_processes(bench: Any) -> None:
    pipe = Pipe(bench.folder / "pipe")
    bench.write(f"services: {{a: {{nodes: [{holder(pipe)}]}}}}")
    bench.up()
    wait_for(lambda: "a/hold: holding" in log_lines(bench))
    pid = json.loads((bench.client.project.state / "supervisor.json").read_text())[
        "pid"
    ]
    os.kill(pid, signal.SIGSTOP)  # so that it does not replace its guard
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    (guard,) = (
        int(child)
        for child in children
        if "guard_program" in Path(f"/proc/{child}/cmdline").read_text()
    )
    os.kill(guard, signal.SIGKILL)
    os.kill(pid, signal.SIGKILL)
    bench.write("services: {b: {nodes: [{command: sleep 1000}]}}")
    bench.up()
    pipe.wait_end()


def test_edit_and_restart(bench: Any) -> None:
    node = bench.write(NODE, "node.py")
    bench.write("services: {m: {nodes: [node.py]}}")
    assert bench.up()["m/node"].state.value == "running"
    wait_for(lambda: "m/node: version 1" in log_lines(bench))
    node.write_text(NODE.replace("version 1", "version 2"))
    assert navette("restart", "m").exit_code == 0
    wait_for(lambda: "m/node: version 2" in log_lines(bench))
    assert "m/node: interrupted" in log_lines(bench)


def test_arguments_are_kept_until_all_is_down(bench: Any) -> None:
    bench.write(
        """
        arguments: {word: first}
        services:
          a: {nodes: [{command: [sh, -c, "echo a $(var word); sleep 1000"], name: a}]}
          b: {nodes: [{command: [sh, -c, "echo b $(var word); sleep 1000"], name: b}]}
        """
    )
    assert "kept" not in navette("up", "a", "word:=second").output
    wait_for(lambda: "a: a second" in log_lines(bench))
    up = navette("up", "b")
    assert "arguments kept from the last command: word:=second" in up.output
    wait_for(lambda: "b: b second" in log_lines(bench))
    navette("restart", "a")
    wait_for(lambda: log_lines(bench).count("a: a second") == 2)
    navette("restart", "a", "word:=third")
    wait_for(lambda: "a: a third" in log_lines(bench))
    bench.down()
    wait_for(lambda: not bench.client.project.is_supervised)
    assert bench.client.arguments() == {}


def test_a_failed_start_shows_the_last_output(bench: Any) -> None:
    bench.write("raise ValueError('invalid state')", "node.py")
    bench.write("services: {m: {nodes: [node.py], restart: no}}")
    up = navette("up")
    assert up.exit_code == 1
    assert "m/node  failed: exit code 1" in up.output
    assert "ValueError: invalid state" in up.output
    (view,) = json.loads(navette("ps", "--json").output)
    assert (view["state"], view["reason"], view["pid"]) == (
        "failed",
        "exit code 1",
        None,
    )


def test_concurrent_starts_create_one_supervisor(bench: Any) -> None:
    bench.write("services: {a: {nodes: [{command: sleep 1000}]}}")
    specs = bench.specs()
    clients = [bench.client for _ in range(3)]
    threads = [threading.Thread(target=each.up, args=(specs, {})) for each in clients]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(WAIT_S)
    bench.settled("a")
    (view,) = bench.client.status()
    assert len(view["processes"]) == 1
    assert len(known_projects()) == 1


@pytest.mark.parametrize(
    "line", [b"{\n", b"[1]\n", b'{"command": "up"}\n', b'{"command": "fly"}\n', b"\xff"]
)
def test_malformed_requests_are_refused(bench: Any, line: bytes) -> None:
    bench.write("services: {a: {nodes: [{command: sleep 1000}]}}")
    bench.up()
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection:
        connection.settimeout(WAIT_S)
        connection.connect(str(socket_path(bench.client.project.state)))
        connection.sendall(line)
        connection.shutdown(socket.SHUT_WR)
        assert "error" in json.loads(connection.makefile("rb").readline())
    assert len(bench.client.status()) == 1


def test_an_attached_up_stops_its_services(bench: Any) -> None:
    pipe = Pipe(bench.folder / "pipe")
    bench.write(
        f"services:\n  a: {{nodes: [{holder(pipe)}]}}\n"
        "  b: {depends_on: [a], nodes: [{command: sleep 1000}]}\n"
    )
    bench.up("a")
    wait_for(lambda: "a/hold: holding" in log_lines(bench))
    words = [sys.executable, "-u", "-m", "navette", "up", "b", "--attach"]
    source = str(Path(package.__file__).parents[1])
    with subprocess.Popen(
        words,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": source},
    ) as attached:
        assert attached.stdout is not None
        alarm = threading.Timer(WAIT_S, attached.kill)
        alarm.start()
        lines = iter(attached.stdout.readline, "")
        assert any("b/sleep: * started" in line for line in lines)
        attached.send_signal(signal.SIGINT)
        assert list(lines)[-1] == "b/sleep  stopped\n"
        alarm.cancel()
    assert attached.returncode == 130
    left = [view["name"] for view in json.loads(navette("ps", "--json").output)]
    assert left == ["hold"]
