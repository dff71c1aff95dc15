# SPDX-License-Identifier: Apache-2.0
"""Scripted motion: poses in the plane over time."""

import bisect
import itertools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from navette.errors import InvalidValueError
from navette.geometry import angle_difference


class Waypoint(NamedTuple):
    """Pose at a time since the start of the script; s, m, rad, world frame."""

    time_s: float
    x: float
    y: float
    z: float = 0.0
    yaw: float = 0.0


class ScriptedPose(NamedTuple):
    """Pose of a scripted model; m, rad, world frame."""

    x: float
    y: float
    z: float
    yaw: float


@dataclass(frozen=True, kw_only=True)
class Trajectory:
    """A script of waypoints.

    Attributes:
        waypoints: at increasing times, the first at 0 s.
        loop: start again at the first waypoint after the last; otherwise stay there.
        delay_s: wait at the first waypoint before the script, in every cycle.
        tension: of the spline through the waypoints, as in SDF: 0 is a Catmull-Rom
            spline, 1 stops at every waypoint; None is straight lines at constant speed.

    Raises:
        InvalidValueError: no waypoint, a value that is not finite, a first time other
            than 0, times that do not increase, a negative delay, or a tension outside
            [0, 1].
    """

    waypoints: tuple[Waypoint, ...]
    loop: bool = True
    delay_s: float = 0.0
    tension: float | None = None

    def __post_init__(self) -> None:
        if not self.waypoints:
            raise InvalidValueError("trajectory without a waypoint; expected 1 or more")
        for waypoint in self.waypoints:
            if not all(map(math.isfinite, waypoint)):
                raise InvalidValueError(f"{waypoint}: expected finite numbers")
        times = [waypoint.time_s for waypoint in self.waypoints]
        if times[0] != 0.0:
            raise InvalidValueError(f"first waypoint at {times[0]:g} s; expected 0 s")
        for before, after in itertools.pairwise(times):
            if after <= before:
                raise InvalidValueError(
                    f"waypoint at {after:g} s after one at {before:g} s; times must "
                    "increase"
                )
        if not 0.0 <= self.delay_s < math.inf:
            raise InvalidValueError(f"delay {self.delay_s!r} s; must be >= 0, finite")
        if self.tension is not None and not 0.0 <= self.tension <= 1.0:
            raise InvalidValueError(f"tension {self.tension!r}; must be within [0, 1]")

    @property
    def duration_s(self) -> float:
        """Time of the last waypoint, without the delay."""
        return self.waypoints[-1].time_s

    @cached_property
    def cycle_s(self) -> float:
        """Time after which a looped script starts again; infinite for one waypoint."""
        cycle_s = self.delay_s + self.duration_s
        return cycle_s if self.loop and self.duration_s > 0 else math.inf

    def at(self, time_s: float) -> ScriptedPose:
        """Return the pose at a time (s) since the start of the simulation."""
        cycle_s = self.cycle_s
        if math.isfinite(cycle_s):
            time_s = math.fmod(time_s, cycle_s)
        return self._at_script(max(0.0, time_s - self.delay_s))

    def jumps_within(self, time_s: float, span_s: float) -> bool:
        """Return whether the script starts again within a span, at another place."""
        cycle_s = self.cycle_s
        if not math.isfinite(cycle_s):
            return False
        first, last = self.waypoints[0], self.waypoints[-1]
        if math.dist(first[1:4], last[1:4]) < 1e-9:
            return False
        return math.floor((time_s + span_s) / cycle_s) > math.floor(time_s / cycle_s)

    def fastest_mps(self) -> float:
        """Return an upper bound of the speed."""
        fastest = 0.0
        for i in range(len(self.waypoints) - 1):
            a, b = self.waypoints[i], self.waypoints[i + 1]
            chord = math.dist(a[1:4], b[1:4]) / (b.time_s - a.time_s)
            if self.tension is None:
                fastest = max(fastest, chord)
            else:
                ends = math.hypot(*self._velocity(i)) + math.hypot(
                    *self._velocity(i + 1)
                )
                fastest = max(fastest, 1.5 * chord + ends)
        return fastest

    def _at_script(self, time_s: float) -> ScriptedPose:
        i = bisect.bisect_right(self._times, time_s) - 1
        if i >= len(self.waypoints) - 1:
            return ScriptedPose(*self.waypoints[-1][1:])
        a, b = self.waypoints[i], self.waypoints[i + 1]
        span = b.time_s - a.time_s
        u = (time_s - a.time_s) / span
        yaw = a.yaw + u * angle_difference(b.yaw, a.yaw)
        if self.tension is None:
            x, y = a.x + u * (b.x - a.x), a.y + u * (b.y - a.y)
            return ScriptedPose(x, y, a.z + u * (b.z - a.z), yaw)
        # Cubic Hermite spline.
        h01 = u * u * (3 - 2 * u)
        h10, h11 = u * (1 - u) ** 2 * span, u * u * (u - 1) * span
        x, y, z = (
            p + h01 * (q - p) + h10 * v + h11 * w
            for p, q, v, w in zip(
                a[1:4], b[1:4], self._velocity(i), self._velocity(i + 1), strict=True
            )
        )
        return ScriptedPose(x, y, z, yaw)

    @cached_property
    def _times(self) -> tuple[float, ...]:
        return tuple(waypoint.time_s for waypoint in self.waypoints)

    def _velocity(self, i: int) -> tuple[float, float, float]:
        """Return the spline's velocity (m/s) at a waypoint: between its neighbours."""
        assert self.tension is not None
        last = len(self.waypoints) - 1
        a, b = self.waypoints[max(0, i - 1)], self.waypoints[min(last, i + 1)]
        scale = (1 - self.tension) / (b.time_s - a.time_s)
        return ((b.x - a.x) * scale, (b.y - a.y) * scale, (b.z - a.z) * scale)
