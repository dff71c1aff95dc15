"""A process of its own that ends what a dead parent left; run as a bare script.

``guard_program.py TOKEN [GRACE_S]`` reads ``+<group>`` and ``-<group>`` lines from its
standard input. When that closes (the parent ended, or was killed), every process of
the groups still listed, and every one whose environment carries the token, gets
SIGINT, then SIGTERM, then SIGKILL. It imports nothing of Navette: it must start fast
and outlive everything.
"""

import os
import select
import signal
import sys
from collections.abc import Callable, Iterable

VARIABLE = "NAVETTE_KEPT_BY"
"""Lists, separated by colons, the tokens of all who keep a process."""

GRACE_S = 2.0
_STEP_S = 0.05
_PROC = "/proc"
_DEAD = "ZX"
_STEPS = ("SIGINT", "SIGTERM", "SIGKILL")


def main() -> None:
    """Listen until the end, then clean up."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    grace_s = float(sys.argv[2]) if len(sys.argv) > 2 else GRACE_S
    groups: set[int] = set()
    for line in sys.stdin:
        if line[0] == "+":
            groups.add(int(line[1:]))
        else:
            groups.discard(int(line[1:]))
    find = _find_by_proc if os.path.isdir(f"{_PROC}/self") else _find_groups  # noqa: PTH112
    end_all(lambda: find(groups, sys.argv[1]), grace_s)


def end_all(find: Callable[[], Iterable[int]], grace_s: float) -> None:
    """Signal whatever ``find`` finds, with more force each time, until it is nothing.

    ``find`` gives process ids, and process groups as negative numbers.
    """
    for name in _STEPS:
        left_s = grace_s
        for target in find():
            _send(target, getattr(signal, name))
        while left_s > 0 and find():
            select.select([], [], [], _STEP_S)
            left_s -= _STEP_S


def _find_groups(groups: Iterable[int], token: str) -> list[int]:
    return [-group for group in groups if _send(-group, 0)]


def _find_by_proc(groups: Iterable[int], token: str) -> list[int]:
    """Linux tells more: a zombie is over, and a process that left its group is not."""
    wanted, own = set(groups), os.getpid()
    found = []
    for name in os.listdir(_PROC):  # noqa: PTH208 - pathlib would double the start
        if name.isdigit() and int(name) != own and _is_kept(name, wanted, token):
            found.append(int(name))
    return found


def _is_kept(name: str, groups: set[int], token: str) -> bool:
    try:
        with open(f"{_PROC}/{name}/stat", "rb") as file:  # noqa: PTH123
            fields = file.read().rpartition(b")")[2].split()
        if fields[0].decode() in _DEAD:
            return False
        if int(fields[2]) in groups:
            return True
        with open(f"{_PROC}/{name}/environ", "rb") as file:  # noqa: PTH123
            return carries(file.read(), token)
    except OSError:  # it has just ended, or is somebody else's
        return False


def carries(environ: bytes, token: str) -> bool:
    """Whether an environment (as ``/proc/<pid>/environ`` gives it) has the token."""
    start = f"{VARIABLE}=".encode()
    return any(
        token.encode() in entry[len(start) :].split(b":")
        for entry in environ.split(b"\0")
        if entry.startswith(start)
    )


def _send(target: int, number: int) -> bool:
    """Whether it is still there."""
    try:
        if target < 0:
            os.killpg(-target, number)
        else:
            os.kill(target, number)
    except (ProcessLookupError, PermissionError):
        return False
    return True


if __name__ == "__main__":
    main()
