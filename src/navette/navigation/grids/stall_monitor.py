"""Detection of a robot that does not move as commanded, as it pushes an obstacle."""

import math
from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

from navette.geometry import Pose2, angle_difference

# First-order lag of a drive, applied to the command.
_LAG_S = 0.15
_LONGEST_DELAY_S = 2.0
# Share of the commanded motion below which the robot does not move.
_LEAST_SHARE = 0.2
# Commanded motion within the time below which nothing can be concluded.
_LEAST_M, _LEAST_RAD = 0.02, 0.1
# A robot that stalled may try again in a direction when it has moved this far …
_AWAY_M, _AWAY_RAD = 0.3, 1.0
# … or after this time.
_AGAIN_S = 10.0
# Slower motion is not pushing: sampled commands of a turn drift as fast.
_DRIFT_MPS = 0.02


class _Step(NamedTuple):
    dt: float
    ahead: float  # commanded, m
    moved: float  # measured in that direction, m
    turn: float  # commanded, rad
    turned: float  # measured in that direction, rad


class _Motion(NamedTuple):
    """Speed (m/s), turn rate (rad/s) and, of some drives, speed to the left (m/s)."""

    speed: float
    turn_rate: float
    side: float = 0.0

    def along(self, other: "_Motion") -> float:
        """Return the product of the velocities."""
        return self.speed * other.speed + self.side * other.side


_REST = _Motion(0.0, 0.0)


class StallMonitor:
    """Compares commanded with measured motion over a short time.

    Motions are speed (m/s), turn rate (rad/s) and, of some drives, speed to the left.

    Args:
        time_s: how long the robot must not have moved; 0: never stalled.
    """

    def __init__(self, time_s: float) -> None:
        self._time_s = time_s
        self._bump: tuple[Pose2, _Motion] | None = None
        self._bump_age_s = 0.0
        self.reset()

    def reset(self) -> None:
        """Restart: the robot was stopped or moved by someone else."""
        self._steps: deque[_Step] = deque()
        self._span_s = 0.0
        self._lagging = _REST
        #: Commands of the last seconds, the oldest first.
        self._given: deque[tuple[float, _Motion]] = deque()
        self._given_s = 0.0

    def update(
        self, command: Sequence[float], pose: Pose2, measured: Sequence[float],
        dt: float, delay_s: float = 0.0,
    ) -> bool:  # fmt: skip
        """Return whether the robot stalls.

        Args:
            command: motion commanded for the last ``dt`` seconds.
            pose: of the robot.
            measured: its motion.
            dt: period.
            delay_s: from a command until its motion is measured here: over a network,
                only what was commanded all that time can be concluded from.
        """
        self._bump_age_s += dt
        if self._time_s == 0.0:
            return False
        given, found = _Motion(*command), _Motion(*measured)
        share = min(1.0, dt / _LAG_S)
        self._lagging = _Motion(
            *(old + share * (new - old)
              for old, new in zip(self._lagging, given, strict=True))
        )  # fmt: skip
        # A drive may lag behind its command, or follow it at once.
        wanted = _Motion(*map(_common, given, self._lagging))
        wanted = self._commanded_all_along(wanted, given, dt, delay_s)
        speed = math.hypot(wanted.speed, wanted.side)
        moved = found.along(wanted) / speed if speed else 0.0
        turned = math.copysign(1.0, wanted.turn_rate) * found.turn_rate
        self._append(
            _Step(dt, speed * dt, max(0.0, moved) * dt,
                  abs(wanted.turn_rate) * dt, max(0.0, turned) * dt)
        )  # fmt: skip
        blocked = self._blocked(given)
        if blocked is None:
            return False
        self._bump, self._bump_age_s = (pose, blocked), 0.0
        self.reset()
        return True

    def forbids(self, command: Sequence[float], pose: Pose2) -> bool:
        """Return whether a command repeats the motion in which the robot stalled."""
        if self._bump is None:
            return False
        where, bumped = self._bump
        if (
            self._bump_age_s > _AGAIN_S
            or where.distance_to(pose) > _AWAY_M
            or abs(angle_difference(where.yaw, pose.yaw)) > _AWAY_RAD
        ):
            self._bump = None
            return False
        given = _Motion(*command)
        if bumped.along(bumped) == 0.0:
            in_place = given.along(given) <= _DRIFT_MPS**2
            return in_place and given.turn_rate * bumped.turn_rate > 0
        towards = given.along(bumped) / math.sqrt(bumped.along(bumped))
        return towards > _DRIFT_MPS

    def _commanded_all_along(
        self, wanted: _Motion, given: _Motion, dt: float, delay_s: float
    ) -> _Motion:
        """Return the part of a motion that was commanded during the whole delay."""
        self._given.append((dt, given))
        self._given_s += dt
        while len(self._given) > 1:
            if self._given_s - self._given[0][0] < _LONGEST_DELAY_S:
                break
            self._given_s -= self._given.popleft()[0]
        left_s = min(delay_s, _LONGEST_DELAY_S)
        for each_s, motion in reversed(self._given):
            if left_s <= 0.0:
                return wanted
            wanted = _Motion(*map(_common, wanted, motion))
            left_s -= each_s
        return wanted if left_s <= 0.0 else _REST  # nothing was commanded before

    def _append(self, step: _Step) -> None:
        self._steps.append(step)
        self._span_s += step.dt
        longest_s = max(self._time_s - 1e-9, 0.5 * step.dt)  # holds one step at least
        while self._span_s - self._steps[0].dt >= longest_s:
            self._span_s -= self._steps.popleft().dt

    def _blocked(self, given: _Motion) -> _Motion | None:
        """Return the part of a command in which the robot does not move."""
        if self._span_s < self._time_s - 1e-9:
            return None
        ahead = sum(step.ahead for step in self._steps)
        if ahead >= _LEAST_M:
            moved = sum(step.moved for step in self._steps)
            return given if moved < _LEAST_SHARE * ahead else None
        turn = sum(step.turn for step in self._steps)
        turned = sum(step.turned for step in self._steps)
        if turn < _LEAST_RAD or turned >= _LEAST_SHARE * turn:
            return None
        return _Motion(0.0, given.turn_rate)


def _common(a: float, b: float) -> float:
    """Return the smaller of two values of one sign, else 0."""
    return math.copysign(min(abs(a), abs(b)), a) if a * b > 0 else 0.0
