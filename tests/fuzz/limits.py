"""Bounds of a test: number of inputs, wall time of one input, memory."""

import os
import resource
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from navette.runtime import Stopwatch

#: Time of a test in seconds beyond its fixed number of inputs, for long runs.
SECONDS = float(os.environ.get("NAVETTE_FUZZ_SECONDS", "0"))
#: First seed; long runs on several machines start at different ones.
SEED = int(os.environ.get("NAVETTE_FUZZ_SEED", "0"))
#: Longest wall time of one input, far above what any valid one takes.
HANG_S = 60
_MEMORY_BYTES = 12 << 30


def rounds() -> Iterator[int]:
    """Yield the seeds of a test: one, or as many as fit in NAVETTE_FUZZ_SECONDS."""
    stopwatch = Stopwatch()
    yield SEED
    seed = SEED + 1
    while stopwatch.elapsed_s < SECONDS:
        yield seed
        seed += 1


class HangError(Exception):
    """An input took longer than HANG_S."""


@contextmanager
def within(seconds: int = HANG_S) -> Iterator[None]:
    """Raise HangError if the block takes longer."""

    def on_alarm(number: int, frame: FrameType | None) -> None:
        raise HangError(f"longer than {seconds} s")

    stopwatch = Stopwatch()
    before = signal.signal(signal.SIGALRM, on_alarm)
    outer_s, _ = signal.setitimer(signal.ITIMER_REAL, seconds)  # the test's own timeout
    try:
        yield
    finally:
        signal.signal(signal.SIGALRM, before)
        left_s = max(1e-3, outer_s - stopwatch.elapsed_s) if outer_s else 0.0
        signal.setitimer(signal.ITIMER_REAL, left_s)


@contextmanager
def limited_memory() -> Iterator[None]:
    """Make allocations beyond 12 GiB of address space fail with MemoryError."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY_BYTES, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)
