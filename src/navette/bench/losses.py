"""Seconds lost against driving at cruise speed, by cause."""

from collections import defaultdict

import numpy as np
from numpy.typing import NDArray

# Speed below which the robot stands or turns in place.
_STANDING_MPS = 0.05


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
