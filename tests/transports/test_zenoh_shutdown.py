"""Processes that end while their session still closes."""

import signal
import subprocess
import sys
from pathlib import Path

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
import atexit
from navette.cli import ending
from navette.transports.shutdown import wait_for_at_end

ending.register()
atexit.register(print, "exit function")
stuck = threading.Thread(target=threading.Event().wait, daemon=True)
stuck.start()
wait_for_at_end(stuck)
ending.end_with(3)
print("done")
raise SystemExit(3)
"""

# Daemon threads that are in and out of Zenoh all the time.
CHURN = """
import sys, threading
from std_msgs.msg import String
import rclpy
from navette.errors import NavetteError

rclpy.init()
node = rclpy.create_node("churn")
seen = threading.Semaphore(0)

def churn():
    try:
        while True:
            node.destroy_publisher(node.create_publisher(String, "/churn", 10))
            seen.release()
    except (NavetteError, ValueError):
        pass  # the session was closed

for _ in range(4):
    threading.Thread(target=churn, daemon=True).start()
for _ in range(20):
    seen.acquire()
sys.exit(3)
"""

# A daemon thread that collects garbage when the program ends.
GARBAGE = """
import gc, sys

class Cycle:
    def __init__(self):
        self.cycle = self

    def __del__(self, wait=threading.Event().wait):
        begun.set()
        wait(1.0)
        print("collected")

def collect():
    Cycle()
    gc.collect()

begun = threading.Event()
threading.Thread(target=collect, daemon=True).start()
begun.wait()
sys.exit(3)
"""

# Ctrl-C while the session waits for tokens.
EARLY = """
from navette import Context
from navette.transports.zenoh.session import ZenohSession

def interrupt(self, router):
    raise KeyboardInterrupt

ZenohSession._complete_discovery = interrupt
Context(transport="zenoh").init()
"""


def end_of(
    program: str, *words: str, endpoint: str | None = None
) -> tuple[int, str, str]:
    ended = subprocess.run(
        [sys.executable, "-c", program, *words],
        env=zenoh_environment(endpoint or free_endpoint()),
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    return ended.returncode, ended.stdout, ended.stderr


def test_the_interpreter_waits_for_a_slow_session_close() -> None:
    """Without this the process ends with SIGABRT after a successful run."""
    assert end_of(BUSY + CLOSES) == (0, "done\n", "")


def test_the_interpreter_waits_for_a_thread_that_collects_garbage() -> None:
    """It may free Zenoh's objects: one in 150 processes below ended with SIGABRT."""
    assert end_of(BUSY + GARBAGE) == (3, "collected\n", "")


def test_a_process_with_an_exit_code_ends_at_once() -> None:
    assert end_of(BUSY + STUCK) == (3, "done\nexit function\n", "")


@pytest.mark.parametrize(
    "start",
    [
        "import sys; from navette.cli import main; main()",
        "import runpy; from navette.ros2.names import install; install();"
        " import sys; runpy.run_path(sys.argv[2], run_name='__main__')",
    ],
    ids=["command", "python"],
)
def test_daemon_threads_inside_zenoh(start: str, tmp_path: Path) -> None:
    """Without waiting for them a third of the processes end with SIGABRT."""
    program = tmp_path / "churn.py"
    program.write_text(CHURN)
    for _ in range(4):
        code, _, err = end_of(start, "run", str(program))
        assert (code, err) == (3, "")


def test_ctrl_c_before_a_session_is_complete() -> None:
    endpoint = free_endpoint()
    router = subprocess.Popen(
        [sys.executable, "-c", BUSY + "print(flush=True); input()"],
        env=zenoh_environment(endpoint),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )
    assert router.stdin is not None
    assert router.stdout is not None
    router.stdout.readline()
    code, _, err = end_of(EARLY, endpoint=endpoint)
    assert "KeyboardInterrupt" in err
    assert code == -signal.SIGINT
    router.communicate(b"\n")
