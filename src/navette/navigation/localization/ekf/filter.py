"""An extended Kalman filter in the plane.

Thrun, Burgard, Fox, "Probabilistic Robotics" (2005), table 3.3; the steps are in
:mod:`~navette.navigation.localization.ekf.kalman`.
"""

import math
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from navette.geometry import Pose2
from navette.navigation.localization.ekf.kalman import are_finite, correct, predict
from navette.navigation.localization.ekf.measurement import Measurement
from navette.navigation.localization.ekf.state import (
    SIZE,
    YAW,
    Array,
    X,
    Y,
    wrapped,
)

# Variance of an unmeasured entry: far above that of any sensor.
_UNKNOWN = 1e6


class Fused(Enum):
    """Result of a measurement."""

    USED = "used"
    REJECTED = "farther from the estimate than the rejection threshold"
    TOO_OLD = "older than the history"
    UNSOUND = "the estimate with it is not finite"


class Estimate(NamedTuple):
    """Estimated pose and motion at a stamp."""

    stamp_ns: int
    state: Array
    """(8,); see :mod:`~navette.navigation.localization.ekf.state`"""
    covariance: Array
    """(8, 8)"""


@dataclass(frozen=True, eq=False)
class Innovation:
    """Difference of a measurement from the estimate before it."""

    state: Array
    """(8,) estimate at the measurement's stamp"""
    difference: Array
    """(n,) measured minus expected"""
    covariance: Array
    """(n, n) of the difference: of the estimate and of the measurement"""
    squared_distance: float
    """normalised, squared; 0 for the first measurement of an entry"""


@dataclass(frozen=True, eq=False)
class FilterSnapshot:
    """Complete state of the filter; its arrays are never modified."""

    stamp_ns: int | None
    state: Array
    covariance: Array
    unseen: frozenset[int]

    @property
    def is_finite(self) -> bool:
        return are_finite(self.state, self.covariance)


class PlanarEkf:
    """Filter with prediction and correction.

    An entry without measurement has its initial value and variance and is predicted by
    the motion model; its first measurement replaces it.

    Args:
        process_noise: (8, 8) added to the covariance per second.
        initial_covariance: (8, 8) before the first measurement.
        initial_state: (8,) before the first measurement; default 0.
        known: entries of it that count as measured, with the initial covariance.
        scales_noise: multiply the process noise of the pose by the squared norm of the
            velocity (robot_localization's ``dynamic_process_noise_covariance``).

    Attributes:
        innovation: of the last measurement; None before the first one.
    """

    def __init__(
        self,
        process_noise: Array,
        initial_covariance: Array,
        initial_state: Array | None = None,
        known: frozenset[int] = frozenset(),
        *,
        scales_noise: bool = False,
    ) -> None:
        self.scales_noise = scales_noise
        self.known = known
        self.process_noise = process_noise
        self.initial_covariance = initial_covariance
        self.initial_state = np.zeros(SIZE) if initial_state is None else initial_state
        self.reset()

    def warm_up(self) -> None:
        """Compile the kernels, which takes seconds on the very first run."""
        trial = PlanarEkf(self.process_noise, self.initial_covariance)
        for stamp_ns in (0, 1):
            trial.step(Measurement("", stamp_ns, (X,), np.zeros(1), np.eye(1)))

    def reset(self) -> None:
        """Return to the initial state."""
        self.innovation: Innovation | None = None
        self.snapshot = FilterSnapshot(
            None,
            self.initial_state,
            self.initial_covariance,
            frozenset(range(SIZE)) - self.known,
        )

    @property
    def stamp_ns(self) -> int | None:
        """Stamp of the estimate; None before the first measurement."""
        return self.snapshot.stamp_ns

    def estimate_at(self, stamp_ns: int) -> Estimate | None:
        """Return the estimate predicted to a time, without changing the filter.

        None before the first measurement, and if the prediction is not finite. For an
        earlier time, return the newest estimate.
        """
        now = self.snapshot
        if now.stamp_ns is None:
            return None
        later = self._predicted_to(max(stamp_ns, now.stamp_ns))
        if not later.is_finite:
            return None
        return Estimate(max(stamp_ns, now.stamp_ns), later.state, later.covariance)

    def set_pose(self, pose: Pose2, covariance: Array) -> None:
        """Replace the pose and its covariance (3, 3), without correlations."""
        before, rows = self.snapshot, [X, Y, YAW]
        state, full = before.state.copy(), before.covariance.copy()
        state[rows] = pose.x, pose.y, wrapped(pose.yaw)
        full[rows, :] = full[:, rows] = 0.0
        full[np.ix_(rows, rows)] = covariance
        self.snapshot = FilterSnapshot(
            before.stamp_ns, state, full, before.unseen - set(rows)
        )

    def step(self, measurement: Measurement) -> Fused:
        """Predict to the measurement's time and correct the estimate.

        A rejected measurement advances the time only; an unsound one has no effect. A
        measurement must not be older than the estimate: see
        :class:`~navette.navigation.localization.ekf.history.OrderedEkf`.
        """
        before = self.snapshot
        self.snapshot = self._predicted_to(measurement.stamp_ns)
        result = self._correct(measurement)
        if result is Fused.UNSOUND or not self.snapshot.is_finite:
            self.snapshot = before
            return Fused.UNSOUND
        return result

    def _correct(self, measurement: Measurement) -> Fused:
        now = self.snapshot
        first_seen = now.unseen.intersection(measurement.indices)
        squared, difference, S, state, covariance = correct(
            now.state,
            self._prior(first_seen),
            measurement.rows,
            measurement.values,
            measurement.covariance,
            measurement.lever,
        )
        if not math.isfinite(squared):
            return Fused.UNSOUND
        distance = 0.0 if first_seen else squared
        self.innovation = Innovation(now.state, difference, S, distance)
        if distance > measurement.threshold**2:
            return Fused.REJECTED
        self.snapshot = FilterSnapshot(
            measurement.stamp_ns, state, covariance, now.unseen - first_seen
        )
        return Fused.USED

    def _prior(self, first_seen: frozenset[int]) -> Array:
        """Return the covariance, with first-measured entries set to unknown."""
        covariance = self.snapshot.covariance
        if not first_seen:
            return covariance
        covariance, rows = covariance.copy(), sorted(first_seen)
        covariance[rows, :] = covariance[:, rows] = 0.0
        covariance[rows, rows] = _UNKNOWN
        return covariance

    def _predicted_to(self, stamp_ns: int) -> FilterSnapshot:
        before = self.snapshot
        if before.stamp_ns is None:
            return FilterSnapshot(
                stamp_ns, before.state, before.covariance, before.unseen
            )
        dt = (stamp_ns - before.stamp_ns) * 1e-9
        if dt <= 0.0:
            return before
        state, covariance = predict(
            before.state, before.covariance, self.process_noise, dt, self.scales_noise
        )
        return FilterSnapshot(stamp_ns, state, covariance, before.unseen)
