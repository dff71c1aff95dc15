"""Summaries and comparisons as text and as plain data."""

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

from navette.navigation.bench.report import ReportedRun
from navette.navigation.bench.statistics import MeasureDifference, Summary

LABEL_COLUMNS = 19  # before the text of a line
_NODES = 5  # with the largest share of the CPU


def summary_text(summary: Summary, name: str) -> str:
    """Return the lines of one run."""
    low, high = 100 * summary.success_low, 100 * summary.success_high
    cpu = list(summary.cpu_share.items())[:_NODES]
    lines = {
        "trials": f"{summary.trials}",
        "success": f"{100 * summary.success:.1f} %  "
        f"(95 % interval {low:.1f}–{high:.1f} %)",
        "contacts": f"{summary.contacts}",
        "score": f"{_known(summary.score, 4)}  (of 0.5; this simulator)",
        "time": f"{_known(summary.time_s, 2)} s",
        "path / shortest": _known(summary.path_ratio, 2),
        "minimum clearance": f"{_known(summary.min_clearance_m, 3)} m",
        "pose error": f"{_known(summary.pose_error_m, 3)} m at the end, worst "
        f"{_known(summary.worst_pose_error_m, 3)} m",
        "jerk": f"{_known(summary.jerk, 2)} m/s³",
        "outcomes": ", ".join(f"{k} {v}" for k, v in summary.outcomes.items()),
        "lost seconds": ", ".join(
            f"{k.replace('_', ' ')} {v:.2f}" for k, v in summary.lost_s.items()
        ),
        "CPU": ", ".join(f"{node} {100 * share:.1f} %" for node, share in cpu)
        + f" of real time; a run ×{_known(summary.real_time_factor, 1)}",
    }
    title = f"{name}\n" if name else ""
    return title + "\n".join(
        f"{label:<{LABEL_COLUMNS}}{text}" for label, text in lines.items()
    )


def comparison_text(against: Sequence[MeasureDifference]) -> str:
    """Return a line for each measure; empty without a comparison."""
    return "".join(
        f"{'mine − baseline':<{LABEL_COLUMNS}}{each.measure} {each.difference:+.4f} "
        f"[{each.low:+.4f}, {each.high:+.4f}], p = {each.p_value:.4f}, "
        f"{each.pairs} pairs{', worse' if each.is_worse else ''}\n"
        for each in against
    )


def plain(
    runs: Sequence[ReportedRun], against: Sequence[MeasureDifference]
) -> dict[str, Any]:
    """Return the summary of the last run for JSON, with baseline and comparison."""
    values = _without_nan(dataclasses.asdict(runs[-1].summary))
    values["comparison"] = [_without_nan(dataclasses.asdict(each)) for each in against]
    if len(runs) == 2:
        values["baseline"] = _without_nan(dataclasses.asdict(runs[0].summary))
    return values


def _without_nan(values: dict[str, Any]) -> dict[str, Any]:
    return {
        key: None if isinstance(value, float) and not math.isfinite(value) else value
        for key, value in values.items()
    }


def _known(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"
