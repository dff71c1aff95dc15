"""Processes that end while their session still closes."""

import subprocess
import sys

import pytest
from transport_pairs import zenoh_environment

from free_ports import free_endpoint

pytestmark = pytest.mark.slow

# Simulates a busy machine: the session close exceeds its limit, and the end of the
# interpreter takes long while threads return to it.
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

CLOSES = """
context.shutdown()
print("done")
"""

# The end of a command with a thread that never returns.
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


def test_the_interpreter_waits_for_a_slow_session_close() -> None:
    """Without this the process ends with SIGABRT after a successful run."""
    assert end_of(BUSY + CLOSES) == (0, "done\n", "")


def test_a_process_with_an_exit_code_ends_at_once() -> None:
    assert end_of(BUSY + STUCK) == (3, "done\n", "")
