"""An extended Kalman filter in the plane.

Thrun, Burgard, Fox, "Probabilistic Robotics" (2005), table 3.3, with the covariance
updated in Joseph's form (Bucy and Joseph 1968): it stays symmetric and positive
whatever the gain's rounding.
"""

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np

from navette.navigation.localization.ekf.measurement import (
    Measurement,
    expected_jacobian,
    innovation,
)
from navette.navigation.localization.ekf.state import (
    SIZE,
    YAW,
    Array,
    predicted,
    predicted_jacobian,
    wrapped,
)

# Variance of an entry that nothing was known of: far more than any sensor's.
_UNKNOWN = 1e6


class Fused(Enum):
    """What became of a measurement."""

    USED = "used"
    REJECTED = "farther from the estimate than the rejection threshold"
    TOO_OLD = "older than the history"
    UNSOUND = "there is no finite estimate with it"


class Estimate(NamedTuple):
    """Where the robot is taken to be."""

    stamp_ns: int
    state: Array
    """(8,) as :mod:`~navette.navigation.localization.ekf.state` says"""
    covariance: Array
    """(8, 8)"""


@dataclass(frozen=True, eq=False)
class Snapshot:
    """All that the filter remembers; its arrays are never written to."""

    stamp_ns: int | None
    state: Array
    covariance: Array
    unseen: frozenset[int]

    @property
    def is_finite(self) -> bool:
        return bool(
            np.isfinite(self.state).all() and np.isfinite(self.covariance).all()
        )


class PlanarEkf:
    """Estimate and covariance, brought forward in time and corrected.

    An entry that was never measured starts at its initial value and variance and is
    carried along by the motion model; the first measurement of it replaces it.

    Args:
        process_noise: (8, 8) added to the covariance per second.
        initial_covariance: (8, 8) before the first measurement.
        initial_state: (8,) likewise; all 0 if not given.
    """

    def __init__(
        self,
        process_noise: Array,
        initial_covariance: Array,
        initial_state: Array | None = None,
    ) -> None:
        self.process_noise = process_noise
        self.initial_covariance = initial_covariance
        self.initial_state = np.zeros(SIZE) if initial_state is None else initial_state
        self.reset()

    def reset(self) -> None:
        """Forget everything."""
        self.snapshot = Snapshot(
            None, self.initial_state, self.initial_covariance, frozenset(range(SIZE))
        )

    @property
    def stamp_ns(self) -> int | None:
        """The time of the estimate; None before the first measurement."""
        return self.snapshot.stamp_ns

    def estimate_at(self, stamp_ns: int) -> Estimate | None:
        """The estimate brought forward to a time; the filter stays as it is.

        None before the first measurement, and where the model runs off to infinity; an
        earlier time gives the newest estimate.
        """
        now = self.snapshot
        if now.stamp_ns is None:
            return None
        with np.errstate(all="ignore"):
            later = self._predicted_to(max(stamp_ns, now.stamp_ns))
        if not later.is_finite:
            return None
        return Estimate(max(stamp_ns, now.stamp_ns), later.state, later.covariance)

    def step(self, measurement: Measurement) -> Fused:
        """Bring the estimate to the measurement's time and correct it.

        One that is rejected has no effect but that time, an unsound one none at all.
        Must not be older than the estimate: see
        :class:`~navette.navigation.localization.ekf.history.OrderedEkf`.
        """
        before = self.snapshot
        with np.errstate(all="ignore"):  # what comes of it is looked at
            try:
                self.snapshot = self._predicted_to(measurement.stamp_ns)
                result = self._correct(measurement)
            except np.linalg.LinAlgError:
                result = Fused.UNSOUND
        if result is Fused.UNSOUND or not self.snapshot.is_finite:
            self.snapshot = before
            return Fused.UNSOUND
        return result

    def _correct(self, measurement: Measurement) -> Fused:
        first_seen = self.snapshot.unseen.intersection(measurement.indices)
        state, prior = self.snapshot.state, self._prior(first_seen)
        difference = innovation(measurement, state)
        H = expected_jacobian(measurement, state)
        S = H @ prior @ H.T + measurement.covariance
        weighted = np.linalg.solve(S, np.column_stack([difference, H @ prior]))
        if not np.all(np.isfinite(weighted)):
            return Fused.UNSOUND
        squared_distance = float(difference @ weighted[:, 0])
        if not first_seen and squared_distance > measurement.threshold**2:
            return Fused.REJECTED
        K = weighted[:, 1:].T
        state = state + K @ difference
        state[YAW] = wrapped(state[YAW])
        kept = np.eye(SIZE) - K @ H
        covariance = kept @ prior @ kept.T + K @ measurement.covariance @ K.T
        self.snapshot = Snapshot(
            measurement.stamp_ns,
            state,
            0.5 * (covariance + covariance.T),
            self.snapshot.unseen - first_seen,
        )
        return Fused.USED

    def _prior(self, first_seen: frozenset[int]) -> Array:
        """The covariance, with nothing known of entries now seen for the first time."""
        covariance = self.snapshot.covariance
        if not first_seen:
            return covariance
        covariance, rows = covariance.copy(), sorted(first_seen)
        covariance[rows, :] = covariance[:, rows] = 0.0
        covariance[rows, rows] = _UNKNOWN
        return covariance

    def _predicted_to(self, stamp_ns: int) -> Snapshot:
        before = self.snapshot
        if before.stamp_ns is None:
            return Snapshot(stamp_ns, before.state, before.covariance, before.unseen)
        dt = (stamp_ns - before.stamp_ns) * 1e-9
        if dt <= 0.0:
            return before
        F = predicted_jacobian(before.state, dt)
        covariance = F @ before.covariance @ F.T + dt * self.process_noise
        return Snapshot(
            stamp_ns,
            predicted(before.state, dt),
            0.5 * (covariance + covariance.T),
            before.unseen,
        )
