"""Processes that start together all discover each other.

The time for fifty processes is measured by ``benchmarks/bench_fifty.py``.
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
# Of all processes together, without the start of Python; 2.1 s when this was written.
MAX_DISCOVERY_CPU_S = 4.0


def test_processes_that_start_together_all_discover_each_other(tmp_path: Path) -> None:
    meeting = meet(COUNT, tmp_path, patience_s=60.0)
    missing = {n: seen for n, seen in meeting.last.items() if n not in meeting.complete}
    assert len(meeting.complete) == COUNT, (missing, meeting.output)
    assert set(meeting.last.values()) == {(COUNT, COUNT * TOPICS)}
    assert meeting.code == 130  # by Ctrl-C, as the end was asked for
    assert meeting.discovery_cpu_s < MAX_DISCOVERY_CPU_S
