"""Measurements that arrive late are put in their place in time."""

from dataclasses import dataclass

from navette.navigation.localization.ekf.filter import Fused, PlanarEkf, Snapshot
from navette.navigation.localization.ekf.measurement import Measurement

# A sensor whose own stamps go back by more began anew: a bag that starts over or was
# set back, a simulation that was reset.
_NEW_RUN_NS = 1_000_000_000


@dataclass(frozen=True, eq=False)
class _Entry:
    measurement: Measurement
    before: Snapshot


class OrderedEkf:
    """A filter that takes measurements in any order, within a window of time.

    One that is older than the estimate takes the filter back to just before its stamp;
    the later ones are then taken again. So the result is that of the measurements in
    the order of their stamps, whatever order they came in (equal stamps: as they came).

    Args:
        ekf: the filter.
        history_ns: how much older than the newest a measurement may be.
        max_gap_ns: when nothing came for longer, the filter begins anew.
    """

    def __init__(self, ekf: PlanarEkf, history_ns: int, max_gap_ns: int) -> None:
        self.ekf = ekf
        self.history_ns = history_ns
        self.max_gap_ns = max_gap_ns
        self._entries: list[_Entry] = []
        self._newest_of: dict[str, int] = {}

    def reset(self) -> None:
        """Forget everything."""
        self.ekf.reset()
        self._entries.clear()
        self._newest_of.clear()

    def begins_anew(self, source: str, stamp_ns: int) -> bool:
        """Whether this stamp is of another run: time went back, or far ahead."""
        last_ns = self._newest_of.get(source)
        if last_ns is not None and stamp_ns < last_ns - _NEW_RUN_NS:
            return True
        newest_ns = self.ekf.stamp_ns
        return newest_ns is not None and stamp_ns > newest_ns + self.max_gap_ns

    def step(self, measurement: Measurement) -> Fused:
        """Take a measurement; after :meth:`begins_anew`, :meth:`reset` comes first."""
        source, stamp_ns = measurement.source, measurement.stamp_ns
        newest_ns = self.ekf.stamp_ns
        if newest_ns is not None and stamp_ns < newest_ns - self.history_ns:
            return Fused.TOO_OLD
        self._newest_of[source] = max(stamp_ns, self._newest_of.get(source, stamp_ns))
        later = self._take_back_to(stamp_ns)
        result = self._apply(measurement)
        for entry in later:
            self._apply(entry.measurement)
        self._forget_old()
        return result

    def _take_back_to(self, stamp_ns: int) -> list[_Entry]:
        """Undo what is later than a stamp; gives the entries undone, in order."""
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

    def _forget_old(self) -> None:
        entries, newest_ns = self._entries, self.ekf.stamp_ns or 0
        keep = 0
        while entries[keep].measurement.stamp_ns < newest_ns - self.history_ns:
            keep += 1
        del entries[:keep]
