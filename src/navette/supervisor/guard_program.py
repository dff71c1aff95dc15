"""Program that ends the processes left behind by a dead parent; run as a script.

``guard_program.py TOKEN [GRACE_S]`` reads ``+<group>`` and ``-<group>`` lines from its
standard input. When the input closes, because the parent ended or was killed, every
process of the remaining groups and every process whose environment carries the token
gets SIGINT, then SIGTERM, then SIGKILL. The program imports nothing of Navette: it must
start fast and survive changes of the installation.
"""

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Callable, Collection

import psutil

VARIABLE = "NAVETTE_GUARD_TOKENS"
"""Environment variable with the tokens of all guards of a process, colon-separated."""

GRACE_S = 2.0
_POLL_S = 0.05


def main() -> None:
    """Read process groups until the input closes, then end what is left of them."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    grace_s = float(sys.argv[2]) if len(sys.argv) > 2 else GRACE_S
    groups: set[int] = set()
    for line in sys.stdin:
        if line[0] == "+":
            groups.add(int(line[1:]))
        else:
            groups.discard(int(line[1:]))
    end_all(lambda: guarded_processes(groups, sys.argv[1]), grace_s)


def end_all(find: Callable[[], Collection[psutil.Process]], grace_s: float) -> None:
    """Signal the processes that ``find`` returns, with more force after each grace."""
    pause = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        for process in find():
            with contextlib.suppress(psutil.Error):  # ended meanwhile
                process.send_signal(number)
        left_s = grace_s
        while left_s > 0 and find():
            pause.wait(_POLL_S)
            left_s -= _POLL_S


def guarded_processes(groups: Collection[int], token: str) -> list[psutil.Process]:
    """Return the running processes of the groups or with the token."""
    return [each for each in psutil.process_iter() if _is_guarded(each, groups, token)]


def _is_guarded(process: psutil.Process, groups: Collection[int], token: str) -> bool:
    if process.pid == os.getpid():
        return False
    try:
        if process.status() == psutil.STATUS_ZOMBIE:
            return False
        if os.getpgid(process.pid) in groups:
            return True
        return token in process.environ().get(VARIABLE, "").split(":")
    except (psutil.Error, OSError):  # ended meanwhile, or of another user
        return False


if __name__ == "__main__":
    main()
