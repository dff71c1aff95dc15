"""No write of a robot's program waits for the system to zero a page of 2 MB."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

VARIABLE = "NUMPY_MADVISE_HUGEPAGE"
PROGRAM = """
import contextlib
import sys
from pathlib import Path

from navette.cli import main

sys.argv = ["navette", "--version"]
with contextlib.suppress(SystemExit):
    main()
import numpy

array = numpy.ones(64 << 20, numpy.uint8)
print(Path("/proc/self/smaps").read_text())
"""


def _large_pages_kb(setting: str | None) -> int:
    """Return the memory in large pages of a verb's process with a large array."""
    environment = {k: v for k, v in os.environ.items() if k != VARIABLE}
    if setting is not None:
        environment[VARIABLE] = setting
    command = [sys.executable, "-c", PROGRAM]
    run = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    sizes = re.findall(r"^AnonHugePages: +(\d+) kB", run.stdout, re.MULTILINE)
    assert sizes, "no sizes in smaps"
    return sum(map(int, sizes))


LARGE_PAGES = Path("/sys/kernel/mm/transparent_hugepage/enabled")
needs_large_pages = pytest.mark.skipif(
    not LARGE_PAGES.exists() or "[madvise]" not in LARGE_PAGES.read_text(),
    reason="the system has no large pages, or uses them without a request",
)


@needs_large_pages
def test_a_verb_uses_small_pages() -> None:
    assert _large_pages_kb(None) == 0


@needs_large_pages
def test_a_user_can_choose_large_ones() -> None:
    assert _large_pages_kb("1") > 0
