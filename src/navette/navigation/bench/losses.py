"""Seconds lost against driving at cruise speed, by cause."""

import math
from collections import defaultdict

import numpy as np
from numpy.typing import NDArray

from navette.navigation.bench.trial import Trial

DETOUR = "detour"
"""Cause: the driven path is longer than the shortest."""


def lost_seconds(
    samples: NDArray[np.float64], causes: list[str], cruise_mps: float
) -> dict[str, float]:
    """Return cause → seconds lost.

    A step of dt at the speed v loses ``dt (1 − |v| / cruise)``; steps faster than
    cruise speed gain.

    Args:
        samples: (N, 5) time (s), x, y, speed (m/s), turn rate (rad/s).
        causes: N states of the controller, or what limits its speed.
        cruise_mps: speed of an undisturbed run.
    """
    lost: defaultdict[str, float] = defaultdict(float)
    steps = np.diff(samples[:, 0])
    for dt, speed, cause in zip(steps, samples[:-1, 3], causes, strict=False):
        lost[cause] += float(dt * (1 - abs(speed) / cruise_mps))
    return dict(lost)


def detour_loss(
    path_m: float, trial: Trial, cruise_mps: float, *, succeeded: bool
) -> dict[str, float]:
    """Return the seconds lost by a path longer than the shortest, as a cause.

    With :func:`lost_seconds` the causes sum up to the time beyond the shortest path at
    cruise speed. Empty for a trial that failed, or whose shortest path is unknown.

    Args:
        path_m: length of the driven path.
        trial: its success counts ``reach_m`` before the goal.
        cruise_mps: speed of an undisturbed run.
        succeeded: whether the robot arrived.
    """
    if not succeeded or not math.isfinite(trial.shortest_m):
        return {}
    return {DETOUR: (path_m - (trial.shortest_m - trial.reach_m)) / cruise_mps}
