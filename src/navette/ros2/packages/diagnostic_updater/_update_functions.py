"""Common tasks: rate of events and age of stamps."""

import math
import threading
from collections.abc import Mapping
from dataclasses import dataclass

from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.ros2.packages.diagnostic_updater._diagnostic_status_wrapper import (
    DiagnosticStatusWrapper,
)
from navette.ros2.packages.diagnostic_updater._diagnostic_updater import DiagnosticTask
from navette.runtime import Clock, ClockType, Time


@dataclass(eq=False)
class FrequencyStatusParam:
    """Expected frequency of :class:`FrequencyStatus`.

    Args:
        freq_bound: 'min' and optionally 'max' frequency, in Hz. The values may change
            between runs.
        tolerance: accepted deviation from the bounds, as a fraction of them.
        window_size: number of runs of the task over which events are counted.
    """

    freq_bound: Mapping[str, float]
    tolerance: float = 0.1
    window_size: int = 5

    @property
    def bounds(self) -> tuple[float, float]:
        """Lowest and highest acceptable frequency, in Hz."""
        least = self.freq_bound["min"] * (1 - self.tolerance)
        return least, self.freq_bound.get("max", math.inf) * (1 + self.tolerance)


class FrequencyStatus(DiagnosticTask):
    """Check of the rate of an event, for which :meth:`tick` must be called.

    Args:
        clock: default: the clock of the default context.
    """

    def __init__(
        self,
        params: FrequencyStatusParam,
        name: str = "FrequencyStatus",
        *,
        clock: Clock | None = None,
    ) -> None:
        super().__init__(name)
        self.params = params
        self.lock = threading.Lock()
        self._clock = clock or Clock(clock_type=ClockType.ROS_TIME)
        self.clear()

    def clear(self) -> None:
        with self.lock:
            size = self.params.window_size
            self.count = 0
            self.times = [self._clock.now()] * size
            self.seq_nums = [0] * size
            self.hist_indx = 0

    def tick(self) -> None:
        with self.lock:
            self.count += 1

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        with self.lock:
            events, window_s = self._next_window()
            count = self.count
        # With two runs at one instant there is no rate.
        frequency = events / window_s if window_s > 0 else math.nan
        least, most = self.params.bounds
        if events == 0:
            stat.summary(DiagnosticStatus.ERROR, "No events recorded.")
        elif frequency < least:
            stat.summary(DiagnosticStatus.WARN, "Frequency too low.")
        elif frequency > most:
            stat.summary(DiagnosticStatus.WARN, "Frequency too high.")
        else:
            stat.summary(DiagnosticStatus.OK, "Desired frequency met")
        stat.add("Events in window", events)
        stat.add("Events since startup", count)
        stat.add("Duration of window (s)", f"{window_s:f}")
        stat.add("Actual frequency (Hz)", f"{frequency:f}")
        self._add_bounds(stat, least, most)
        return stat

    def _next_window(self) -> tuple[int, float]:
        """Return events and seconds since ``window_size`` runs ago."""
        now, oldest = self._clock.now(), self.hist_indx
        events = self.count - self.seq_nums[oldest]
        window_s = (now - self.times[oldest]).nanoseconds * 1e-9
        self.seq_nums[oldest], self.times[oldest] = self.count, now
        self.hist_indx = (oldest + 1) % len(self.times)
        return events, window_s

    def _add_bounds(
        self, stat: DiagnosticStatusWrapper, least: float, most: float
    ) -> None:
        bound = self.params.freq_bound
        if bound.get("max") == bound["min"]:
            stat.add("Target frequency (Hz)", f"{bound['min']:f}")
        if bound["min"] > 0:
            stat.add("Minimum acceptable frequency (Hz)", f"{least:f}")
        if "max" in bound:
            stat.add("Maximum acceptable frequency (Hz)", f"{most:f}")


@dataclass(eq=False)
class TimeStampStatusParam:
    """Accepted delays from stamp to arrival of :class:`TimeStampStatus`, in s."""

    min_acceptable: float = -1
    max_acceptable: float = 5


class TimeStampStatus(DiagnosticTask):
    """Check of stamps, with each of which :meth:`tick` must be called.

    Args:
        clock: default: the clock of the default context.
    """

    def __init__(
        self,
        params: TimeStampStatusParam | None = None,
        name: str = "Timestamp Status",
        *,
        clock: Clock | None = None,
    ) -> None:
        super().__init__(name)
        self.params = params or TimeStampStatusParam()
        self.lock = threading.Lock()
        self._clock = clock or Clock(clock_type=ClockType.ROS_TIME)
        self.early_count = self.late_count = self.zero_count = 0
        self._reset()

    def _reset(self) -> None:
        self.zero_seen = False
        self.max_delta = self.min_delta = 0.0
        self.deltas_valid = False

    def tick(self, stamp: Time | float) -> None:
        """Check a stamp (a Time or seconds) against the current time."""
        seconds = stamp.nanoseconds * 1e-9 if isinstance(stamp, Time) else float(stamp)
        with self.lock:
            if seconds == 0:
                self.zero_seen = True
                return
            delta = self._clock.now_ns * 1e-9 - seconds
            first = not self.deltas_valid
            self.max_delta = delta if first else max(delta, self.max_delta)
            self.min_delta = delta if first else min(delta, self.min_delta)
            self.deltas_valid = True

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        with self.lock:
            stat.summary(*self._summary())
            for key, value in (
                ("Earliest timestamp delay:", f"{self.min_delta:f}"),
                ("Latest timestamp delay:", f"{self.max_delta:f}"),
                (
                    "Earliest acceptable timestamp delay:",
                    f"{self.params.min_acceptable:f}",
                ),
                (
                    "Latest acceptable timestamp delay:",
                    f"{self.params.max_acceptable:f}",
                ),
                ("Late diagnostic update count:", f"{self.late_count}"),
                ("Early diagnostic update count:", f"{self.early_count}"),
                ("Zero seen diagnostic update count:", f"{self.zero_count}"),
            ):
                stat.add(key, value)
            self._reset()
        return stat

    def _summary(self) -> tuple[bytes, str]:
        """Return level and message of the last of several faults; count all."""
        if not self.deltas_valid and not self.zero_seen:
            return DiagnosticStatus.WARN, "No data since last update."
        bad = DiagnosticStatus.ERROR
        level, message = DiagnosticStatus.OK, "Timestamps are reasonable."
        if self.min_delta < self.params.min_acceptable:
            self.early_count += 1
            level, message = bad, "Timestamps too far in future seen."
        if self.max_delta > self.params.max_acceptable:
            self.late_count += 1
            level, message = bad, "Timestamps too far in past seen."
        if self.zero_seen:
            self.zero_count += 1
            level, message = bad, "Zero timestamp seen."
        return level, message


class Heartbeat(DiagnosticTask):
    """Task that reports that the node runs."""

    def __init__(self) -> None:
        super().__init__("Heartbeat")

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        stat.summary(DiagnosticStatus.OK, "Alive")
        return stat
