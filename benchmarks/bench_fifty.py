"""Fifty processes of four topics each: from ``navette launch`` to complete discovery.

Each process is a Python program under ``navette run`` with its own session, linked to
the other 49. The time is that of the last process to discover 50 nodes and 200 topics.
"""

import sys
import tempfile
from pathlib import Path

from harness import Benchmark, Figure

COUNT = 50
TARGET_S = 5.0
ROUNDS = 3
TESTS = Path(__file__).parent.parent / "tests"


def best_time() -> Figure:
    """Return the best of several rounds, because of other load."""
    sys.path += [str(TESTS), str(TESTS / "conformance")]
    from many import meet

    times, cpu = [], []
    for _ in range(ROUNDS):
        with tempfile.TemporaryDirectory() as folder:
            meeting = meet(COUNT, Path(folder), patience_s=60.0)
        if len(meeting.complete) < COUNT:
            raise SystemExit(f"discovery incomplete: {meeting.last}")
        times.append(max(meeting.complete.values()))
        cpu.append(meeting.cpu_s)
    note = "best of " + ", ".join(f"{each:.1f}" for each in sorted(times))
    note += f"; {min(cpu):.1f} s of CPU including their end"
    name = f"{COUNT} processes, {COUNT * 4} topics"
    return Figure(name, min(times), "s", TARGET_S, note=note)


def main() -> None:
    bench = Benchmark("fifty", __doc__)
    bench.figure(best_time)
    bench.main()


if __name__ == "__main__":
    main()
