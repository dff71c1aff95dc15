"""Whether the filter is lost: by what its sensors measure and by its uncertainty.

A sensor contradicts the estimate in two cases (Bar-Shalom, Li, Kirubarajan, "Estimation
with Applications to Tracking and Navigation" (2001), section 5.4):

- all its measurements for some time have a normalised innovation squared that a
  consistent filter exceeds once in a thousand measurements. One such measurement is an
  outlier;
- the median of its positions during that time is farther from the estimate than the
  variances explain. Single positions of a GNSS receiver with metres of noise do not
  show that the robot was carried by a few metres, their median does.
"""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from navette.navigation.localization.ekf.filter import Innovation
from navette.navigation.localization.ekf.measurement import Measurement
from navette.navigation.localization.ekf.state import Array

# 99.9 % of a chi-square variable of 1 … 8 degrees of freedom.
_BOUNDS = (10.83, 13.82, 16.27, 18.47, 20.52, 22.46, 24.32, 26.12)
_LEAST_COUNT = 3  # measurements in a row that contradict
# Of two degrees of freedom, exceeded once in a million: windows follow at the rate of
# the sensor, for hours.
_MEDIAN_BOUND = 27.6
_MEDIAN_VARIANCE = np.pi / 2  # of n normal variables, times n / variance of one


class FilterState(StrEnum):
    """Published states of the filter."""

    LOCALIZED = "localized"
    LOST = "lost"


@dataclass(frozen=True, eq=False)
class _Offset:
    """Measured minus estimated position."""

    stamp_ns: int
    difference: Array  # (2,)
    of_estimate: Array  # (2, 2) covariance
    of_sensor: Array  # (2, 2) covariance


@dataclass(eq=False)
class _Sensor:
    """What one sensor measured lately."""

    since_ns: int | None = None  # of the first measurement in a row that contradicts
    count: int = 0
    offsets: deque[_Offset] = field(default_factory=deque)
    contradicts: bool = False
    of_estimate: Array | None = None  # (2, 2) when the contradiction began

    def note(self, measurement: Measurement, innovation: Innovation) -> None:
        if innovation.squared_distance > _BOUNDS[len(measurement.indices) - 1]:
            if self.since_ns is None:
                self.since_ns = measurement.stamp_ns
            self.count += 1
        else:
            self.since_ns, self.count = None, 0
        if measurement.is_position:
            noise = measurement.covariance[:2, :2]
            self.offsets.append(
                _Offset(
                    measurement.stamp_ns,
                    innovation.difference[:2],
                    innovation.covariance[:2, :2] - noise,
                    noise,
                )
            )

    def update(self, stamp_ns: int, window_ns: int) -> None:
        """Decide whether the sensor contradicts the estimate."""
        while self.offsets and self.offsets[0].stamp_ns <= stamp_ns - window_ns:
            self.offsets.popleft()
        lasting = self.since_ns is not None and stamp_ns - self.since_ns >= window_ns
        all_contradict = lasting and self.count >= _LEAST_COUNT
        contradicts = all_contradict or self._median_contradicts()
        if contradicts and not self.contradicts and self.offsets:
            self.of_estimate = self._of_estimate()
        self.contradicts = contradicts

    def _of_estimate(self) -> Array:
        mean: Array = np.mean([each.of_estimate for each in self.offsets], axis=0)
        return mean

    def _median_contradicts(self) -> bool:
        """Return whether the median of the offsets is too large.

        The variance of the estimate is that of the beginning: a robot that is driven
        while it is lost becomes less certain, but its pose not less wrong.
        """
        count = len(self.offsets)
        if count < _LEAST_COUNT:
            return self.contradicts and self.of_estimate is not None
        median = np.median([each.difference for each in self.offsets], axis=0)
        noise = np.mean([each.of_sensor for each in self.offsets], axis=0)
        known = self.of_estimate if self.contradicts else None
        prior = self._of_estimate() if known is None else known
        covariance = prior + _MEDIAN_VARIANCE * noise / count
        squared = float(median @ np.linalg.solve(covariance, median))
        return squared > (_BOUNDS[1] if self.contradicts else _MEDIAN_BOUND)


class ConsistencyMonitor:
    """State of the filter, and the reason if it is lost.

    Args:
        lost_time_ns: how long the measurements of a sensor contradict the estimate of a
            filter that is lost; 0: contradictions do not count.
        lost_stddev_m: standard deviation of the position of a filter that is lost.
    """

    def __init__(self, lost_time_ns: int, lost_stddev_m: float) -> None:
        self._lost_time_ns, self._lost_stddev_m = lost_time_ns, lost_stddev_m
        self.reset()

    def reset(self) -> None:
        """Forget all measurements."""
        self.cause = ""
        self._sensors: dict[str, _Sensor] = {}

    @property
    def state(self) -> FilterState:
        """Whether the filter is lost."""
        return FilterState.LOST if self.cause else FilterState.LOCALIZED

    def contradicts(self, source: str) -> bool:
        """Return whether a sensor contradicted the estimate at the last update."""
        return source in self._contradicting()

    def note(self, measurement: Measurement, innovation: Innovation) -> None:
        """Note a measurement and its difference from the estimate."""
        sensor = self._sensors.setdefault(measurement.source, _Sensor())
        sensor.note(measurement, innovation)

    def update(self, stddev_m: float, stamp_ns: int) -> FilterState:
        """Return the state at a time.

        Args:
            stddev_m: standard deviation of the position along the worst axis.
            stamp_ns: time of the estimate.
        """
        self.cause = ""
        if self._lost_time_ns > 0:
            for sensor in self._sensors.values():
                sensor.update(stamp_ns, self._lost_time_ns)
        for source in self._contradicting():
            self.cause = f"{source} contradicts the estimate"
        if stddev_m > self._lost_stddev_m:
            self.cause = "the position is too uncertain"
        return self.state

    def _contradicting(self) -> Iterator[str]:
        for source, sensor in self._sensors.items():
            if sensor.contradicts:
                yield source
