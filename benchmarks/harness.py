"""Side-by-side timing: runs of all contenders interleaved, medians, ratios.

A benchmark names its cases and contenders; the first contender is Navette's and
the others are compared with it::

    bench = Benchmark("inflation", __doc__)
    bench.case("400², 20 cells", {"navette": ours, "opencv": theirs})
    bench.main()

Interleaving (one run of each in turn) lets a busy machine slow all contenders
alike, so the ratios hold even where the times do not.
"""

import argparse
import json
import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

Run = Callable[[], object]


@dataclass(frozen=True)
class Timing:
    """Times of one contender in one case, milliseconds."""

    first_ms: float
    median_ms: float
    fastest_ms: float
    slowest_ms: float
    runs: int


@dataclass
class Benchmark:
    """A table of cases; each compares contenders that do the same work."""

    name: str
    description: str | None = ""
    budget_s: float = 1.0
    results: dict[str, dict[str, Timing]] = field(default_factory=dict)
    notes: dict[str, str] = field(default_factory=dict)
    _cases: list[tuple[str, dict[str, Run], str]] = field(default_factory=list)

    def case(self, name: str, contenders: Mapping[str, Run], note: str = "") -> None:
        """Add a case; check correctness before (an assert), say so in ``note``."""
        self._cases.append((name, dict(contenders), note))

    def run(self) -> dict[str, dict[str, Timing]]:
        """Measure every case and return the timings by case and contender."""
        for name, contenders, note in self._cases:
            self.results[name] = measure(contenders, self.budget_s)
            self.notes[name] = note
        return self.results

    def main(self, argv: list[str] | None = None) -> None:
        """Run, print a table and write JSON if asked (``--json FILE``)."""
        parser = argparse.ArgumentParser(description=self.description)
        parser.add_argument("--json", type=Path, help="write the timings to this file")
        parser.add_argument(
            "--budget",
            type=float,
            default=self.budget_s,
            help="seconds for each case (default %(default)s)",
        )
        arguments = parser.parse_args(argv)
        self.budget_s = arguments.budget
        self.run()
        print(self.table())
        if arguments.json is not None:
            arguments.json.write_text(json.dumps(self.as_dict(), indent=2) + "\n")

    def table(self) -> str:
        """The results as text: median of each contender and its ratio."""
        lines = [f"{self.name}: median ms (times Navette's)"]
        for case, timings in self.results.items():
            base = next(iter(timings.values())).median_ms
            cells = [
                f"{who} {t.median_ms:.3f} ({t.median_ms / base:.2f}x)"
                for who, t in timings.items()
            ]
            lines.append(f"  {case:<32} " + "   ".join(cells))
            if self.notes[case]:
                lines.append(f"  {'':<32} {self.notes[case]}")
        return "\n".join(lines)

    def as_dict(self) -> dict[str, object]:
        """The results as plain values, for a JSON file."""
        return {
            "name": self.name,
            "cases": [
                {
                    "case": case,
                    "note": self.notes[case],
                    "contenders": {
                        who: {
                            "first_ms": round(t.first_ms, 4),
                            "median_ms": round(t.median_ms, 4),
                            "fastest_ms": round(t.fastest_ms, 4),
                            "slowest_ms": round(t.slowest_ms, 4),
                            "runs": t.runs,
                            "ratio": round(t.median_ms / base.median_ms, 3),
                        }
                        for who, t in timings.items()
                    },
                }
                for case, timings in self.results.items()
                for base in [next(iter(timings.values()))]
            ],
        }


def measure(
    contenders: Mapping[str, Run], budget_s: float = 1.0, least_runs: int = 5
) -> dict[str, Timing]:
    """Time each contender in turn until ``budget_s`` is used up.

    The first run of each is kept apart: it pays for compiling and cold caches.
    """
    first = {who: _timed(run) for who, run in contenders.items()}
    times: dict[str, list[float]] = {who: [] for who in contenders}
    end = time.perf_counter() + budget_s
    rounds = 0
    while rounds < least_runs or time.perf_counter() < end:
        for who, run in contenders.items():
            times[who].append(_timed(run))
        rounds += 1
    return {
        who: Timing(first[who], statistics.median(t), min(t), max(t), len(t))
        for who, t in times.items()
    }


def _timed(run: Run) -> float:
    start = time.perf_counter()
    run()
    return (time.perf_counter() - start) * 1e3
