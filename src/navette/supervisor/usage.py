"""Processor time and memory of processes with all that they started (Linux)."""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

_PROC = Path("/proc")


@dataclass(frozen=True)
class Usage:
    """``cpu_s``: processor time so far; ``memory_bytes``: resident."""

    cpu_s: float = 0.0
    memory_bytes: int = 0


def usage_of(groups: Iterable[int]) -> dict[int, Usage]:
    """Process group → what its processes use; empty where there is no /proc."""
    wanted = set(groups)
    found: dict[int, Usage] = {}
    if not _PROC.joinpath("self", "stat").is_file():
        return found
    for folder in _PROC.iterdir():
        if folder.name.isdigit():
            _add(folder, wanted, found)
    return found


def _add(folder: Path, wanted: set[int], found: dict[int, Usage]) -> None:
    try:
        fields = (folder / "stat").read_bytes().rpartition(b")")[2].split()
    except OSError:
        return  # it has just ended
    group = int(fields[2])
    if group in wanted:
        before = found.get(group, Usage())
        ticks = int(fields[11]) + int(fields[12])
        found[group] = Usage(
            before.cpu_s + ticks / os.sysconf("SC_CLK_TCK"),
            before.memory_bytes + int(fields[21]) * os.sysconf("SC_PAGE_SIZE"),
        )
