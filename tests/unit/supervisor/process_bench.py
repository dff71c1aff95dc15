"""Processes for tests, and a recorder of their output."""

import sys
import threading

from navette.supervisor import ChildProcess, ProcessManager, StartOptions

WAIT_S = 60.0


class OutputRecorder:
    """Records the output and exit of a process."""

    def __init__(self) -> None:
        self.text = {"stdout": b"", "stderr": b""}
        self.code: int | None = None
        self.ready = threading.Event()
        self.over = threading.Event()

    def output(self, stream: str, data: bytes) -> None:
        self.text[stream] += data
        if b"ready\n" in self.text["stdout"]:
            self.ready.set()

    def exited(self, code: int) -> None:
        self.code = code
        self.over.set()

    def wait_ready(self) -> list[str]:
        """Return the words of the first line, which ends with ``ready``."""
        assert self.ready.wait(WAIT_S), self.text
        return self.text["stdout"].decode().split("\n")[0].split()

    def wait_over(self) -> int:
        assert self.over.wait(WAIT_S), self.text
        assert self.code is not None
        return self.code


class Bench:
    """A process manager, and Python programs to start."""

    def __init__(self) -> None:
        self.manager = ProcessManager(grace_s=0.1)

    def start(
        self, code: str, *args: str, **options: object
    ) -> tuple[ChildProcess, OutputRecorder]:
        recorder = OutputRecorder()
        words = [sys.executable, "-u", "-c", code, *args]
        made = StartOptions(**options)  # type: ignore[arg-type]
        child = self.manager.start(words, made)
        child.watch(recorder)
        return child, recorder
