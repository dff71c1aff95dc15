"""Guard: no child outlives a parent that was killed."""

import logging
import os
import select
import signal
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

import navette
from navette.supervisor.guard import Guard, with_token, without_tokens
from navette.supervisor.guard_program import VARIABLE, end_all

linux = pytest.mark.skipif(
    not Path("/proc/self").is_dir(), reason="needs Linux's /proc"
)
slow = pytest.mark.slow
WAIT_S = 60.0

# Each process holds the writing end of a pipe.
STUBBORN = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_IGN)
os.write(int(sys.argv[1]), b'x')
signal.pause()
"""
RUNAWAY = f"""
import os, subprocess, sys
code = {STUBBORN!r}
subprocess.Popen([sys.executable, '-c', code, sys.argv[1]], start_new_session=True,
                 pass_fds=[int(sys.argv[1])])
"""
PARENT = """
import sys
from navette.supervisor import ProcessManager, StartOptions

class Ignore:
    def output(self, stream, data): sys.stderr.write(data.decode())
    def exited(self, code): pass

manager = ProcessManager(grace_s=0.1)
fd = int(sys.argv[2])
manager.start([sys.executable, "-c", sys.argv[1], str(fd)],
              StartOptions(pass_fds=(fd,))).watch(Ignore())
sys.stdin.read()
"""


def start_parent(program: str) -> tuple["subprocess.Popen[bytes]", int]:
    """Start a process with a child; return it and a pipe that the child holds open."""
    reading, writing = os.pipe()
    source = str(Path(navette.__file__).parent.parent)
    process = subprocess.Popen(
        [sys.executable, "-c", PARENT, program, str(writing)],
        stdin=subprocess.PIPE,
        pass_fds=(writing,),
        env={**os.environ, "PYTHONPATH": source},
    )
    os.close(writing)
    return process, reading


def read(pipe: int) -> bytes:
    """Return the next byte, or the end of the pipe; bounded."""
    ready, _, _ = select.select([pipe], [], [], WAIT_S)
    assert ready, "neither data nor the end of the pipe arrived"
    return os.read(pipe, 1)


@slow
@pytest.mark.skipif(os.name != "posix", reason="process groups are POSIX's")
@pytest.mark.parametrize(
    "program", [STUBBORN, pytest.param(RUNAWAY, marks=linux)], ids=["child", "runaway"]
)
def test_no_child_outlives_a_killed_parent(program: str) -> None:
    parent, pipe = start_parent(program)
    with parent:
        assert read(pipe) == b"x"
        parent.kill()
    assert read(pipe) == b""
    os.close(pipe)


@slow
@linux
def test_a_descendant_outside_the_group_ends_with_the_manager(bench: Any) -> None:
    reading, writing = os.pipe()
    _, recorder = bench.start(RUNAWAY, str(writing), pass_fds=(writing,))
    os.close(writing)
    assert recorder.wait_over() == 0
    assert read(reading) == b"x"
    bench.manager.close()
    assert read(reading) == b""
    os.close(reading)


@slow
@pytest.mark.skipif(os.name != "posix", reason="process groups are POSIX's")
def test_a_killed_guard_is_replaced(bench: Any) -> None:
    bench.start("import signal; print('ready'); signal.pause()")[1].wait_ready()
    guard = bench.manager.guard()
    first = guard.pid
    os.kill(first, signal.SIGKILL)
    waiting = select.poll()
    # Poll until the replacement runs.
    left = int(WAIT_S / 0.01)
    while guard.pid == first and left:
        waiting.poll(10)
        left -= 1
    assert guard.pid != first
    _, recorder = bench.start("print('ready')")
    assert recorder.wait_over() == 0


def test_a_helper_that_cannot_run_is_reported(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    reported = threading.Event()
    messages: list[str] = []

    class Reports(logging.Handler):
        def emit(self, record: logging.LogRecord) -> None:
            messages.append(record.getMessage())
            reported.set()

    command = [sys.executable, "-S", "-E", "-c", "raise SystemExit(3)"]
    monkeypatch.setattr("navette.supervisor.guard._COMMAND", command)
    handler = Reports()
    logging.getLogger("navette.supervisor.guard").addHandler(handler)
    try:
        guard = Guard()
        assert reported.wait(WAIT_S)
        guard.add(1 << 22)  # no helper reads it
        guard.close()
    finally:
        logging.getLogger("navette.supervisor.guard").removeHandler(handler)
    assert len(messages) == 1
    assert "ended 10 times, last with exit code 3" in messages[0]


def test_tokens_nest_and_are_removed() -> None:
    inner = with_token(with_token({"A": "1"}, "outer"), "inner")
    assert inner == {"A": "1", VARIABLE: "outer:inner"}
    assert without_tokens(inner) == {"A": "1"}


def test_termination_ends_after_three_signals() -> None:
    looks: list[int] = []

    def find() -> list[int]:
        looks.append(1)
        return []

    end_all(find, 0.0)
    assert len(looks) == 3
