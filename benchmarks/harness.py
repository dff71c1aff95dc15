"""Side-by-side timing: runs of all contenders interleaved, medians, ratios.

A benchmark lists its cases and contenders; the first contender is Navette, and the
others are compared with it::

    bench = Benchmark("inflation", __doc__)
    bench.case("400², 20 cells", {"navette": ours, "opencv": theirs}, target_ms=0.6)
    bench.main()

Interleaving (some milliseconds of each in turn) means that load on the machine slows
all contenders alike, so that ratios are reliable even if times are not. Results other
than times, such as a real-time factor, are a :class:`Figure`.
"""

import argparse
import json
import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from importlib import import_module
from typing import Any

Run = Callable[[], object]

# Length of a contender's turn (at least one run): only the first run of a turn finds
# the CPU caches filled by the other contenders.
_TURN_S = 2e-3


@dataclass(frozen=True)
class Timing:
    """Times of one contender in one case, milliseconds per operation."""

    first_ms: float
    median_ms: float
    fastest_ms: float
    slowest_ms: float
    runs: int


@dataclass(frozen=True)
class Case:
    """Contenders that do the same work; Navette is the first.

    ``per_run`` operations are done by one run: times are given for one operation.
    """

    name: str
    contenders: dict[str, Run]
    note: str = ""
    target_ms: float | None = None
    per_run: int = 1
    budget_s: float | None = None
    least_rounds: int = 5


@dataclass(frozen=True)
class Figure:
    """A measured value without a peer."""

    name: str
    value: float
    unit: str
    target: float | None = None
    more_is_better: bool = False
    note: str = ""

    @property
    def is_met(self) -> bool | None:
        """Whether the target is reached; None without one."""
        if self.target is None:
            return None
        if self.more_is_better:
            return self.value >= self.target
        return self.value <= self.target


@dataclass
class Benchmark:
    """A table of cases and figures."""

    name: str
    description: str | None = ""
    budget_s: float = 1.0
    results: dict[str, dict[str, Timing]] = field(default_factory=dict)
    _cases: dict[str, Case] = field(default_factory=dict)
    _figures: list[Callable[[], Figure]] = field(default_factory=list)
    _figures_found: list[Figure] = field(default_factory=list)

    def case(
        self,
        name: str,
        contenders: Mapping[str, Run],
        note: str = "",
        *,
        target_ms: float | None = None,
        per_run: int = 1,
        budget_s: float | None = None,
        least_rounds: int = 5,
    ) -> None:
        """Add a case; check correctness before (an assert) and state it in ``note``."""
        self._cases[name] = Case(
            name, dict(contenders), note, target_ms, per_run, budget_s, least_rounds
        )

    def figure(self, measure: Callable[[], Figure]) -> None:
        """Add a figure, measured after the cases."""
        self._figures.append(measure)

    def run(self) -> None:
        """Measure every case, then every figure."""
        for case in self._cases.values():
            budget_s = self.budget_s if case.budget_s is None else case.budget_s
            self.results[case.name] = measure(
                case.contenders, budget_s, case.per_run, case.least_rounds
            )
        self._figures_found = [measure() for measure in self._figures]

    def main(self, argv: list[str] | None = None) -> None:
        """Run and print a table, or with ``--json`` one JSON object."""
        parser = argparse.ArgumentParser(description=self.description)
        parser.add_argument(
            "--json", action="store_true", help="print one JSON object instead"
        )
        parser.add_argument(
            "--budget",
            type=float,
            default=self.budget_s,
            metavar="S",
            help="seconds for each case (default %(default)s)",
        )
        arguments = parser.parse_args(argv)
        self.budget_s = arguments.budget
        self.run()
        print(json.dumps(self.as_dict()) if arguments.json else self.table())

    def table(self) -> str:
        """Return the results as text: median of each contender and its ratio."""
        lines = [self.name]
        for name, timings in self.results.items():
            case = self._cases[name]
            base = next(iter(timings.values())).median_ms
            cells = [
                f"{who} {shown(t.median_ms)}"
                + (f" ({t.median_ms / base:.2f}×)" if i else "")
                for i, (who, t) in enumerate(timings.items())
            ]
            if case.target_ms is not None:
                cells.append(f"[target {shown(case.target_ms)}]")
            lines.append(f"  {name:<32} " + "   ".join(cells))
            if case.note:
                lines.append(f"  {'':<32} {case.note}")
        for f in self._figures_found:
            target = "" if f.target is None else f"   [target {f.target:g} {f.unit}]"
            lines.append(f"  {f.name:<32} {f.value:.4g} {f.unit}{target}")
            if f.note:
                lines.append(f"  {'':<32} {f.note}")
        return "\n".join(lines)

    def as_dict(self) -> dict[str, object]:
        """Return the results as plain values for JSON."""
        return {
            "name": self.name,
            "about": " ".join((self.description or "").split("\n\n")[0].split()),
            "cases": [
                self._case_as_dict(self._cases[name], timings)
                for name, timings in self.results.items()
            ],
            "figures": [
                {**asdict(f), "value": float(f"{f.value:.5g}"), "is_met": f.is_met}
                for f in self._figures_found
            ],
        }

    @staticmethod
    def _case_as_dict(case: Case, timings: dict[str, Timing]) -> dict[str, object]:
        base = next(iter(timings.values())).median_ms
        contenders = {
            who: {
                key: float(f"{value:.5g}") if isinstance(value, float) else value
                for key, value in asdict(t).items()
            }
            | {"ratio": round(t.median_ms / base, 3)}
            for who, t in timings.items()
        }
        return {
            "case": case.name,
            "note": case.note,
            "target_ms": case.target_ms,
            "contenders": contenders,
        }


def shown(ms: float) -> str:
    """Format a time in a suitable unit."""
    for factor, unit, limit in ((1e-3, "s", 1e3), (1.0, "ms", 0.1), (1e3, "µs", 0.0)):
        if ms >= limit:
            return f"{ms * factor:.3g} {unit}"
    raise ValueError(f"time {ms} ms: wanted 0 or more")


def measure(
    contenders: Mapping[str, Run],
    budget_s: float = 1.0,
    per_run: int = 1,
    least_rounds: int = 5,
) -> dict[str, Timing]:
    """Time each contender in turn until ``budget_s`` is used up.

    The first run of each is kept apart: it pays for compiling and cold caches.
    """
    first = {who: _timed(run) / per_run for who, run in contenders.items()}
    times: dict[str, list[float]] = {who: [] for who in contenders}
    end = time.perf_counter() + budget_s
    rounds = 0
    while rounds < least_rounds or time.perf_counter() < end:
        for who, run in contenders.items():
            times[who] += [ms / per_run for ms in _turn(run)]
        rounds += 1
    return {
        who: Timing(first[who], statistics.median(t), min(t), max(t), len(t))
        for who, t in times.items()
    }


def optional(module: str) -> Any:
    """Return a peer's module, or None if it is not installed."""
    try:
        return import_module(module)
    except ModuleNotFoundError:
        return None


def _turn(run: Run) -> list[float]:
    """Return the times (ms) of the runs of one turn."""
    times = [_timed(run)]
    while sum(times) < _TURN_S * 1e3:
        times.append(_timed(run))
    return times


def _timed(run: Run) -> float:
    start = time.perf_counter()
    run()
    return (time.perf_counter() - start) * 1e3
