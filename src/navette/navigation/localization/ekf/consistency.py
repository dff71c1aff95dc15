"""Whether the filter is lost: by what its sensors measure and by its uncertainty.

A sensor contradicts the estimate if its normalised innovation squared lies above what a
consistent filter exceeds once in a thousand measurements (Bar-Shalom, Li, Kirubarajan,
"Estimation with Applications to Tracking and Navigation" (2001), section 5.4). One such
measurement is an outlier; a filter is lost when a sensor measures nothing else.
"""

from enum import StrEnum

# 99.9 % of a chi-square variable of 1 … 8 degrees of freedom.
_BOUNDS = (10.83, 13.82, 16.27, 18.47, 20.52, 22.46, 24.32, 26.12)
_LEAST_COUNT = 3  # measurements in a row that contradict


class FilterState(StrEnum):
    """Published states of the filter."""

    LOCALIZED = "localized"
    LOST = "lost"


class ConsistencyMonitor:
    """State of the filter, and the reason if it is lost.

    Args:
        lost_time_ns: how long all measurements of a sensor contradict the estimate of a
            filter that is lost; 0: contradictions do not count.
        lost_stddev_m: standard deviation of the position of a filter that is lost.
    """

    def __init__(self, lost_time_ns: int, lost_stddev_m: float) -> None:
        self._lost_time_ns, self._lost_stddev_m = lost_time_ns, lost_stddev_m
        self.reset()

    def reset(self) -> None:
        """Forget all measurements."""
        self.cause = ""
        self._since_ns: dict[str, int] = {}
        self._count: dict[str, int] = {}

    @property
    def state(self) -> FilterState:
        """Whether the filter is lost."""
        return FilterState.LOST if self.cause else FilterState.LOCALIZED

    def note(
        self, source: str, squared_distance: float, entries: int, stamp_ns: int
    ) -> None:
        """Note a measurement.

        Args:
            source: name of the sensor.
            squared_distance: normalised innovation squared.
            entries: number of measured entries of the state.
            stamp_ns: time of the measurement.
        """
        if squared_distance <= _BOUNDS[entries - 1]:
            self._since_ns.pop(source, None)
            self._count.pop(source, None)
            return
        self._since_ns.setdefault(source, stamp_ns)
        self._count[source] = self._count.get(source, 0) + 1

    def update(self, stddev_m: float, stamp_ns: int) -> FilterState:
        """Return the state at a time.

        Args:
            stddev_m: standard deviation of the position along the worst axis.
            stamp_ns: time of the estimate.
        """
        self.cause = ""
        for source, since_ns in self._since_ns.items():
            lasting = stamp_ns - since_ns >= self._lost_time_ns > 0
            if lasting and self._count[source] >= _LEAST_COUNT:
                self.cause = f"{source} contradicts the estimate"
        if stddev_m > self._lost_stddev_m:
            self.cause = "the position is too uncertain"
        return self.state
