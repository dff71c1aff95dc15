"""Child processes: output, input, exit, and signals to process groups."""

import os
import signal
import sys
import threading
from pathlib import Path
from typing import Any

import pytest
from process_bench import WAIT_S, OutputRecorder

from navette.supervisor import ProcessError, ProcessManager, StartOptions, child

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name != "posix", reason="process groups are POSIX's"),
]

# A pipe that a process holds open ends with the process: the tests read it to its end
# to wait for a process that is not their child.
PARENT = """
import os, subprocess, sys
child = subprocess.Popen([sys.executable, '-c', 'import signal; signal.pause()'],
                         pass_fds=[int(sys.argv[1])])
print(child.pid, 'ready')
if sys.argv[2] == 'stay':
    child.wait()
"""


def test_output_code_environment_and_input(bench: Any, tmp_path: Path) -> None:
    code = (
        "import os, sys; print(os.environ['A'], os.getcwd(), 'ready');"
        "sys.stderr.write(input()); sys.exit(3)"
    )
    env = {**os.environ, "A": "b"}
    running, recorder = bench.start(code, env=env, cwd=str(tmp_path))
    running.write(b"hello\n")
    assert recorder.wait_over() == 3
    assert recorder.wait_ready() == ["b", str(tmp_path), "ready"]
    assert recorder.text["stderr"] == b"hello"
    running.signal(signal.SIGINT)  # ignored after the exit
    running.write(b"too late")


def test_error_output_may_be_merged(bench: Any) -> None:
    code = "import sys; print(1); sys.stderr.write('2\\n'); print('ready')"
    _, recorder = bench.start(code, merge_streams=True)
    assert recorder.wait_over() == 0
    assert recorder.text == {"stdout": b"1\n2\nready\n", "stderr": b""}


def test_the_exit_is_reported_after_all_output(
    bench: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(child, "_LAST_OUTPUT_S", 0.0)
    proceed = threading.Event()

    class Slow(OutputRecorder):
        def output(self, stream: str, data: bytes) -> None:
            assert proceed.wait(WAIT_S)
            super().output(stream, data)

    recorder = Slow()
    words = [sys.executable, "-c", "print('ready')"]
    running = bench.manager.start(words, StartOptions())
    running.watch(recorder)
    assert running._process.wait() == 0
    assert not recorder.over.wait(0.1)
    proceed.set()
    assert recorder.wait_over() == 0
    assert recorder.text["stdout"] == b"ready\n"


def test_a_shell_command_line(bench: Any) -> None:
    recorder = bench.start("")[1].__class__()
    words = ("echo", "ready", "&&", "exit", "2")
    bench.manager.start(words, StartOptions(shell=True)).watch(recorder)
    assert recorder.wait_over() == 2
    assert recorder.text["stdout"] == b"ready\n"


@pytest.mark.parametrize(
    ("words", "cwd", "reason"),
    [
        (["/no/such/tool"], None, "cannot start '/no/such/tool': No such file"),
        (["ls", "a\0b"], None, "cannot start 'ls': embedded null byte"),
        (["ls"], "/no/such", "cannot start 'ls' in '/no/such': no such folder"),
    ],
)
def test_a_failed_start_reports_the_reason(
    words: list[str], cwd: str | None, reason: str
) -> None:
    manager = ProcessManager()
    with pytest.raises(ProcessError, match=reason):
        manager.start(words, StartOptions(cwd=cwd))
    manager.close()


@pytest.mark.parametrize("how", ["signal", "end"])
def test_children_end_with_the_process(bench: Any, how: str) -> None:
    reading, writing = os.pipe()
    running, recorder = bench.start(
        PARENT, str(writing), "stay" if how == "signal" else "go", pass_fds=(writing,)
    )
    os.close(writing)
    recorder.wait_ready()
    if how == "signal":
        running.signal(signal.SIGTERM)
        assert recorder.wait_over() == -signal.SIGTERM
    else:
        assert recorder.wait_over() == 0
    with os.fdopen(reading, "rb") as pipe:
        assert pipe.read() == b""
