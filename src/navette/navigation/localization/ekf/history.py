"""Apply late measurements in the order of their stamps."""

from dataclasses import dataclass

from navette.geometry import Pose2
from navette.navigation.localization.ekf.filter import (
    FilterSnapshot,
    Fused,
    Innovation,
    PlanarEkf,
)
from navette.navigation.localization.ekf.measurement import Measurement
from navette.navigation.localization.ekf.state import Array

# A larger step back of a sensor's stamps means a new run: a bag that starts again or
# was set back, or a reset simulation.
_NEW_RUN_NS = 1_000_000_000


@dataclass(frozen=True, eq=False)
class _Entry:
    measurement: Measurement
    before: FilterSnapshot


class OrderedEkf:
    """Filter that accepts measurements in any order, within a window of time.

    A measurement older than the estimate rolls the filter back to just before its
    stamp, and the later ones are applied again. The result is that of the measurements
    in the order of their stamps (equal stamps: in the order of arrival).

    Args:
        ekf: the filter.
        history_ns: largest age of a measurement relative to the newest.
        max_gap_ns: a longer gap in the stamps means a new run.

    Attributes:
        innovation: of the last given measurement; None before the first one.
    """

    def __init__(self, ekf: PlanarEkf, history_ns: int, max_gap_ns: int) -> None:
        self.ekf = ekf
        self.history_ns = history_ns
        self.max_gap_ns = max_gap_ns
        self._entries: list[_Entry] = []
        self._newest_of: dict[str, int] = {}
        self._set_ns: int | None = None  # stamp of the estimate when it was set
        self.innovation: Innovation | None = None

    def reset(self) -> None:
        """Reset the filter and the history."""
        self.ekf.reset()
        self._entries.clear()
        self._newest_of.clear()
        self._set_ns = None

    def set_pose(self, pose: Pose2, covariance: Array) -> None:
        """Replace the pose; measurements from before that are too old from now on."""
        self.ekf.set_pose(pose, covariance)
        self._entries.clear()
        self._set_ns = self.ekf.stamp_ns

    def is_new_run(self, source: str, stamp_ns: int) -> bool:
        """Return whether time went back, or ahead by more than the gap: a new run."""
        last_ns = self._newest_of.get(source)
        if last_ns is not None and stamp_ns < last_ns - _NEW_RUN_NS:
            return True
        newest_ns = self.ekf.stamp_ns
        return newest_ns is not None and stamp_ns > newest_ns + self.max_gap_ns

    def step(self, measurement: Measurement) -> Fused:
        """Apply a measurement; call :meth:`reset` first if :meth:`is_new_run`."""
        source, stamp_ns = measurement.source, measurement.stamp_ns
        newest_ns = self.ekf.stamp_ns
        if newest_ns is not None and stamp_ns < newest_ns - self.history_ns:
            return Fused.TOO_OLD
        if self._set_ns is not None and stamp_ns < self._set_ns:
            return Fused.TOO_OLD
        self._newest_of[source] = max(stamp_ns, self._newest_of.get(source, stamp_ns))
        later = self._roll_back_to(stamp_ns)
        result = self._apply(measurement)
        self.innovation = self.ekf.innovation
        for entry in later:
            self._apply(entry.measurement)
        self._drop_old()
        return result

    def _roll_back_to(self, stamp_ns: int) -> list[_Entry]:
        """Roll back to a stamp; return the undone entries in order."""
        entries = self._entries
        at = len(entries)
        while at and entries[at - 1].measurement.stamp_ns > stamp_ns:
            at -= 1
        later = entries[at:]
        if later:
            self.ekf.snapshot = later[0].before
            del entries[at:]
        return later

    def _apply(self, measurement: Measurement) -> Fused:
        self._entries.append(_Entry(measurement, self.ekf.snapshot))
        return self.ekf.step(measurement)

    def _drop_old(self) -> None:
        entries, newest_ns = self._entries, self.ekf.stamp_ns or 0
        keep = 0
        while entries[keep].measurement.stamp_ns < newest_ns - self.history_ns:
            keep += 1
        del entries[:keep]
