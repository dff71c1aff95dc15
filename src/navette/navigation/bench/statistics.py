"""Summaries of trials, and comparison of two methods."""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from statistics import fmean

import numpy as np

from navette.navigation.bench.trial import TrialResult

# Resamples of the sign-flip test; its smallest p-value is 1 / _RESAMPLES.
_RESAMPLES = 10_000
_BOOTSTRAPS = 2_000
_Z95 = 1.96
_SIGNIFICANT = 0.05

_MEASURES: dict[str, Callable[[TrialResult], float]] = {
    "success": lambda r: float(r.succeeded),
    "score": lambda r: r.score,
    "time_s": lambda r: r.time_s,
    "path_m": lambda r: r.path_m,
    "jerk": lambda r: r.jerk,
    "min_clearance_m": lambda r: (
        math.nan if r.min_clearance_m is None else r.min_clearance_m
    ),
}
_OF_ALL = ("success", "score", "min_clearance_m")
_MORE_IS_BETTER = ("success", "score", "min_clearance_m")


@dataclass(frozen=True, kw_only=True)
class Summary:
    """Measures over all trials; means unless named otherwise, seconds simulated.

    Attributes:
        success: share of trials that succeeded; ``success_low`` and ``success_high``
            are Wilson's 95 % interval.
        time_s, path_ratio: over the trials that succeeded; the ratio is the driven
            path to the shortest.
        outcomes: outcome → number of trials.
        pose_error_m: largest error of the estimated position at the end of a trial.
        worst_pose_error_m: largest one of any time, while localized.
        lost_s: cause → mean seconds lost per trial.
        cpu_share: node → CPU seconds per simulated second.
        real_time_factor: simulated seconds per second, of one trial at a time.
    """

    trials: int
    success: float
    success_low: float
    success_high: float
    contacts: int
    score: float
    time_s: float
    path_ratio: float
    min_clearance_m: float
    jerk: float
    outcomes: dict[str, int]
    lost_s: dict[str, float]
    cpu_share: dict[str, float]
    real_time_factor: float
    pose_error_m: float = math.nan
    worst_pose_error_m: float = math.nan


def summarize(results: Sequence[TrialResult]) -> Summary:
    """Return the summary of at least one trial."""
    reached = [each for each in results if each.succeeded]
    outcomes: defaultdict[str, int] = defaultdict(int)
    lost: defaultdict[str, float] = defaultdict(float)
    for each in results:
        outcomes[each.outcome] += 1
        for cause, seconds in each.lost_s.items():
            lost[cause] += seconds / len(results)
    low, high = wilson_interval(len(reached), len(results))
    sim_s = sum(each.sim_s for each in results)
    cpu: defaultdict[str, float] = defaultdict(float)
    for each in results:
        for node, seconds in each.cpu_s.items():
            cpu[node] += seconds / sim_s
    clearances = [
        each.min_clearance_m for each in results if each.min_clearance_m is not None
    ]
    return Summary(
        trials=len(results),
        success=len(reached) / len(results),
        success_low=low,
        success_high=high,
        contacts=sum(each.contacts for each in results),
        score=fmean(each.score for each in results),
        time_s=fmean(each.time_s for each in reached) if reached else math.nan,
        path_ratio=fmean(each.path_ratio for each in reached) if reached else math.nan,
        min_clearance_m=min(clearances, default=math.nan),
        jerk=fmean(each.jerk for each in results),
        outcomes=dict(sorted(outcomes.items())),
        lost_s=dict(sorted(lost.items(), key=lambda item: -item[1])),
        cpu_share=dict(sorted(cpu.items(), key=lambda item: -item[1])),
        real_time_factor=sim_s / sum(each.wall_s for each in results),
        pose_error_m=_largest(each.pose_error_m for each in results),
        worst_pose_error_m=_largest(each.worst_pose_error_m for each in results),
    )


def _largest(values: Iterable[float | None]) -> float:
    return max((value for value in values if value is not None), default=math.nan)


def wilson_interval(successes: int, trials: int) -> tuple[float, float]:
    """Return the 95 % interval of a share (Wilson 1927)."""
    share, z2 = successes / trials, _Z95 * _Z95
    middle = share + z2 / (2 * trials)
    spread = _Z95 * math.sqrt(share * (1 - share) / trials + z2 / (4 * trials * trials))
    scale = 1 + z2 / trials
    return max(0.0, (middle - spread) / scale), min(1.0, (middle + spread) / scale)


@dataclass(frozen=True)
class MeasureDifference:
    """Mean difference of a measure, mine − baseline, over paired trials.

    ``low`` and ``high`` are the 95 % interval (bootstrap of the pairs).
    """

    measure: str
    pairs: int
    difference: float
    p_value: float
    low: float = math.nan
    high: float = math.nan

    @property
    def is_worse(self) -> bool:
        """Whether mine is significantly worse, at p < 0.05."""
        return self.p_value < _SIGNIFICANT and self._gain < 0

    @property
    def is_better(self) -> bool:
        """Whether mine is significantly better, at p < 0.05."""
        return self.p_value < _SIGNIFICANT and self._gain > 0

    @property
    def _gain(self) -> float:
        sign = 1.0 if self.measure in _MORE_IS_BETTER else -1.0
        return sign * self.difference


def compare(
    baseline: Sequence[TrialResult], mine: Sequence[TrialResult], seed: int = 0
) -> list[MeasureDifference]:
    """Compare the trials that both have, measure by measure, by sign-flip tests.

    Time, path and smoothness are compared over the trials in which both succeeded.

    Under the null hypothesis the sign of each pair's difference is random (Fisher's
    paired permutation test, sampled).
    """
    before = {(each.suite, each.name, each.seed): each for each in baseline}
    pairs = [
        (before[key], each)
        for each in mine
        if (key := (each.suite, each.name, each.seed)) in before
    ]
    both = [(old, new) for old, new in pairs if old.succeeded and new.succeeded]
    rng = np.random.default_rng(seed)
    found = []
    for measure, of in _MEASURES.items():
        compared = pairs if measure in _OF_ALL else both
        gaps = np.array([of(new) - of(old) for old, new in compared], np.float64)
        gaps = gaps[np.isfinite(gaps)]
        if not len(gaps):
            continue
        drawn = rng.choice(gaps, (_BOOTSTRAPS, len(gaps))).mean(axis=1)
        low, high = np.quantile(drawn, (0.025, 0.975)).tolist()
        signs = rng.choice((-1.0, 1.0), (_RESAMPLES, len(gaps)))
        extreme = np.abs((signs * gaps).mean(axis=1)) >= abs(gaps.mean()) - 1e-12
        p_value = max(1 / _RESAMPLES, float(extreme.mean()))
        mean = float(gaps.mean())
        found.append(MeasureDifference(measure, len(gaps), mean, p_value, low, high))
    return found
