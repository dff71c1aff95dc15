"""Processor time and memory of process groups."""

import os
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass

import psutil


@dataclass(frozen=True)
class Usage:
    """Resources used by a process group.

    Attributes:
        cpu_s: processor time so far.
        memory_bytes: resident memory.
    """

    cpu_s: float = 0.0
    memory_bytes: int = 0


def usage_of(groups: Iterable[int]) -> dict[int, Usage]:
    """Return the usage of each process group that has processes."""
    chosen = set(groups)
    found: dict[int, Usage] = {}
    for process in psutil.process_iter():
        # A process may end meanwhile; those of other users are not accessible.
        with suppress(psutil.Error, OSError):
            group = os.getpgid(process.pid)
            if group in chosen:
                with process.oneshot():
                    times, memory = process.cpu_times(), process.memory_info()
                so_far = found.get(group, Usage())
                found[group] = Usage(
                    so_far.cpu_s + times.user + times.system,
                    so_far.memory_bytes + memory.rss,
                )
    return found
