"""A process of its own that ends process groups when the launch is gone.

Reads ``+<group>`` and ``-<group>`` lines from its standard input. When that closes
(the launch ended, or was killed), every group still listed gets SIGINT, then SIGTERM,
then SIGKILL. Runs as a bare script: it imports nothing of Navette.
"""

import os
import select
import signal
import sys

GRACE_S = 2.0
STEP_S = 0.05


def main() -> None:
    """Listen until the end, then clean up."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    groups: set[int] = set()
    for line in sys.stdin:
        if line[0] == "+":
            groups.add(int(line[1:]))
        else:
            groups.discard(int(line[1:]))
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        groups = {group for group in groups if _send(group, number)}
        left_s = GRACE_S
        while groups and left_s > 0 and number != signal.SIGKILL:
            select.select([], [], [], STEP_S)
            left_s -= STEP_S
            groups = {group for group in groups if _send(group, 0)}


def _send(group: int, number: int) -> bool:
    """Whether the group is still there."""
    try:
        os.killpg(group, number)
    except (ProcessLookupError, PermissionError):
        return False
    return True


if __name__ == "__main__":
    main()
