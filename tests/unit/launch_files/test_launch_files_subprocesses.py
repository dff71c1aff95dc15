"""Real processes: groups, signals, and the guard that outlives a killed launch."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

import navette
from navette.launch_files.launch.errors import LaunchError
from navette.launch_files.launch.running import Command
from navette.launch_files.launch.subprocesses import SubprocessRunner

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="process groups are POSIX's"),
]
WAIT_S = 20.0


class Heard:
    """Collects what a process does."""

    def __init__(self) -> None:
        self.text = {"stdout": b"", "stderr": b""}
        self.code: int | None = None
        self.ready = threading.Event()
        self.over = threading.Event()

    def output(self, stream: str, data: bytes) -> None:
        self.text[stream] += data
        if b"ready" in self.text["stdout"]:
            self.ready.set()

    def exited(self, code: int) -> None:
        self.code = code
        self.over.set()


def python(code: str, **options: object) -> Command:
    argv = (sys.executable, "-u", "-c", code)
    return Command("test-1", argv, **options)  # type: ignore[arg-type]


@pytest.fixture
def runner() -> Iterator[SubprocessRunner]:
    made = SubprocessRunner()
    yield made
    made.close()


def test_output_code_environment_and_input(
    runner: SubprocessRunner, tmp_path: Path
) -> None:
    heard = Heard()
    code = (
        "import os, sys; print('ready', os.environ['A'], os.getcwd());"
        "sys.stderr.write(input()); sys.exit(3)"
    )
    env = {**os.environ, "A": "b"}
    running = runner.start(python(code, env=env, cwd=str(tmp_path)), heard)
    running.write(b"hello\n")
    assert heard.over.wait(WAIT_S)
    assert heard.code == 3
    assert heard.text["stdout"].decode() == f"ready b {tmp_path}\n"
    assert heard.text["stderr"] == b"hello"
    running.signal(signal.SIGINT)  # it is over: nothing happens


def test_a_shell_line(runner: SubprocessRunner) -> None:
    heard = Heard()
    runner.start(
        Command("s-1", ("echo", "ready", "&&", "exit", "2"), shell=True), heard
    )
    assert heard.over.wait(WAIT_S)
    assert (heard.code, heard.text["stdout"]) == (2, b"ready\n")


def test_what_cannot_be_started_says_why(runner: SubprocessRunner) -> None:
    with pytest.raises(LaunchError, match="cannot start '/no/such/tool': No such file"):
        runner.start(Command("t-1", ("/no/such/tool",)), Heard())


PARENT = """
import subprocess, sys
child = subprocess.Popen([sys.executable, '-c', 'import signal; signal.pause()'])
print(child.pid, 'ready')
child.wait()
"""


def test_a_signal_reaches_the_children_too(runner: SubprocessRunner) -> None:
    heard = Heard()
    running = runner.start(python(PARENT), heard)
    assert heard.ready.wait(WAIT_S)
    running.signal(signal.SIGTERM)
    assert heard.over.wait(WAIT_S)
    assert heard.code == -signal.SIGTERM
    child = int(heard.text["stdout"].split()[0])
    assert_gone(child)


STUBBORN = """
import signal, sys
signal.signal(signal.SIGINT, signal.SIG_IGN)
with open(sys.argv[1], "w") as pipe:
    pipe.write("ready")
    pipe.flush()
    signal.pause()
"""
KILLED = f"""
import sys
from navette.launch_files.launch.running import Command
from navette.launch_files.launch.subprocesses import SubprocessRunner

argv = (sys.executable, "-c", {STUBBORN!r}, sys.argv[1])
SubprocessRunner().start(Command("stubborn-1", argv), None)
sys.stdin.read()
"""


def test_nothing_outlives_a_launch_that_was_killed(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    source = str(Path(navette.__file__).parent.parent)
    launch = subprocess.Popen(
        [sys.executable, "-c", KILLED, str(pipe)],
        stdin=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": source},
    )
    with launch, pipe.open("rb", buffering=0) as ends_with_the_process:
        assert ends_with_the_process.read(5) == b"ready"
        launch.kill()
        assert ends_with_the_process.read() == b""


def assert_gone(pid: int) -> None:
    """Gone, or dead and waiting for the system to notice."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return
    assert state == "Z"
