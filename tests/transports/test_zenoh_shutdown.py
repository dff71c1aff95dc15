"""Processes whose session closes more slowly than they end."""

import subprocess
import sys

import pytest
from transport_benches import zenoh_environment

from free_ports import free_endpoint

pytestmark = pytest.mark.slow

# As on a machine that is too busy: closing is not waited for, and the end of Python,
# with threads that come back to it meanwhile, takes its time.
BUSY = """
import threading
from navette import Context
from navette.transports.zenoh import session

session._CLOSE_S = 0.0

class Slow:
    def __del__(self, wait=threading.Event().wait):
        wait(0.4)

slow = Slow()
context = Context(transport="zenoh")
context.init()
"""

LEAVES = """
context.shutdown()
print("done")
"""

# A command's end: here is a thread that never comes back.
STUCK = """
from navette.transports.shutdown import end_with, wait_for_at_end

stuck = threading.Thread(target=threading.Event().wait, daemon=True)
stuck.start()
wait_for_at_end(stuck)
end_with(3)
print("done")
raise SystemExit(3)
"""


def end_of(program: str) -> tuple[int, str, str]:
    ended = subprocess.run(
        [sys.executable, "-c", program],
        env=zenoh_environment(free_endpoint()),
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    return ended.returncode, ended.stdout, ended.stderr


def test_a_session_that_is_slow_to_close_is_waited_for() -> None:
    """Else the process ends by SIGABRT, after all was done."""
    assert end_of(BUSY + LEAVES) == (0, "done\n", "")


def test_who_gives_an_exit_code_ends_with_it_at_once() -> None:
    assert end_of(BUSY + STUCK) == (3, "done\n", "")
