"""Run programs with ``navette run`` until they have printed what they should."""

import os
import re
import selectors
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

NAVETTE = [sys.executable, "-u", "-c", "from navette.cli import main; main()"]
_LONGEST_END_S = 60.0
_OWN_END_S = 0.3  # after the expected output


# Exit codes of Python on SIGINT: in the program, and during interpreter shutdown.
_ENDED_BY_INTERRUPT = (0, 130, -signal.SIGINT)


@dataclass
class ProgramRun:
    """Output and end of a run."""

    expected: Sequence[str]
    forbidden: str
    output: str = ""
    exit_code: int | None = None
    interrupted: bool = False
    missing: list[str] = field(default_factory=list)

    @property
    def is_good(self) -> bool:
        """Whether all was printed and the run ended or was interrupted cleanly."""
        return not self.faults()

    def faults(self) -> list[str]:
        """Describe the failure."""
        found = [f"not printed: {pattern}" for pattern in self.missing]
        if re.search(self.forbidden, self.output):
            found.append(f"printed: {self.forbidden}")
        if self.exit_code not in (_ENDED_BY_INTERRUPT if self.interrupted else (0,)):
            found.append(f"ended with {self.exit_code}")
        return found

    def look(self) -> None:
        """Search each expected pattern after the previous match."""
        position = 0
        self.missing = []
        for pattern in self.expected:
            found = re.compile(pattern).search(self.output, position)
            if found is None:
                self.missing.append(pattern)
            else:
                position = found.end()


def run_until_printed(
    words: Sequence[str],
    expected: Sequence[str],
    timeout_s: float,
    forbidden: str = "Traceback",
    packages: str = "",
    own_end_s: float = _OWN_END_S,
) -> ProgramRun:
    """Run ``navette run WORDS`` until ``expected`` (regexes) was printed in that order.

    ``packages``: folders of packages that the program may find.
    A program that runs longer than ``own_end_s`` gets SIGINT, as from Ctrl-C.
    """
    run = ProgramRun(expected, forbidden)
    run.look()
    process = subprocess.Popen(
        [*NAVETTE, "run", *words],
        env={**os.environ, "NAVETTE_PATH": packages},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    _read(process, run, timeout_s)
    _read(process, run, own_end_s, to_the_end=True)
    if process.poll() is None:
        run.interrupted = True
        process.send_signal(signal.SIGINT)
        _read(process, run, _LONGEST_END_S, to_the_end=True)
    if process.poll() is None:
        process.kill()
        run.missing.append("an end after Ctrl-C")
    run.exit_code = process.wait()
    assert process.stdout is not None
    process.stdout.close()
    return run


def _read(
    process: subprocess.Popen[bytes],
    run: ProgramRun,
    timeout_s: float,
    *,
    to_the_end: bool = False,
) -> None:
    assert process.stdout is not None
    deadline = time.perf_counter() + timeout_s  # noqa: TID251 - waits for a process
    with selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)
        while True:
            left = deadline - time.perf_counter()  # noqa: TID251 - as above
            if left <= 0 or not selector.select(left):
                return
            read = os.read(process.stdout.fileno(), 65536)
            if not read:
                process.wait(_LONGEST_END_S)
                return
            run.output += read.decode()
            run.look()
            if run.expected and not run.missing and not to_the_end:
                return
