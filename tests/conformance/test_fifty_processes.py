"""Processes that start at once find each other, all of them.

Fifty of them, and how long that takes: ``benchmarks/bench_fifty.py``.
"""

import sys
from pathlib import Path

import pytest
from many import meet

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX's"),
]

COUNT = 20
TOPICS = 4
# With their end; 3 when it was written.
MOST_CPU_S = 6.0


def test_processes_that_start_at_once_all_find_each_other(tmp_path: Path) -> None:
    meeting = meet(COUNT, tmp_path, patience_s=60.0)
    missing = {n: seen for n, seen in meeting.last.items() if n not in meeting.complete}
    assert len(meeting.complete) == COUNT, (missing, meeting.said)
    assert set(meeting.last.values()) == {(COUNT, COUNT * TOPICS)}
    assert meeting.code == 130  # by Ctrl-C, as the end was asked for
    assert meeting.cpu_s < MOST_CPU_S
