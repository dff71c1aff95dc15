"""What every controller offers, and what Navette's have in common."""

import math
from abc import abstractmethod
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.navigation.control.command_gate import CommandGate
from navette.navigation.control.limits import (
    NO_CAP,
    STOP,
    SpeedCap,
    VelocityCommand,
)
from navette.navigation.control.moving_obstacles import safe_share
from navette.navigation.control.params import ControlParams
from navette.navigation.control.records import (
    FollowerInputs,
    FollowerOutput,
    Rollouts,
)
from navette.navigation.control.states import ControlState, LimitedBy
from navette.navigation.grids import NO_DISCS, NONE_UNSEEN, CollisionCheck

BLOCKED_SCALE = 0.1
"""Share of the command below which the robot is blocked."""


class Follower(Protocol):
    """A controller: a path and obstacles in, a command at every step out."""

    @property
    def has_path(self) -> bool:
        """Whether a path is being followed."""

    @property
    def obstacle_reach_m(self) -> float:
        """Distance around the robot within which obstacles matter."""

    @property
    def unseen_reach_m(self) -> float:
        """Distance around the robot within which unseen space matters."""

    def reset(self, rest: ControlState = ...) -> None:
        """Drop the path and stop at once; ``rest`` is the state to report."""

    def set_path(self, poses: NDArray[np.float64]) -> None:
        """Replace the path by (N, 3) x, y, yaw (m, rad, map); an empty one stops.

        Raises:
            InvalidValueError: not (N, 3) or not finite; the follower is then reset.
        """

    def set_obstacles(
        self,
        points: NDArray[np.float64],
        half_cell: float,
        unseen: NDArray[np.float64] = NONE_UNSEEN,
    ) -> None:
        """Store the values of :class:`navette.navigation.grids.Obstacles`."""

    def set_moving(self, discs: NDArray[np.float64]) -> None:
        """Store moving obstacles (M, 5) x, y, vx, vy, radius; map, now."""

    def pause(self, last: VelocityCommand | None = None) -> None:
        """Continue later from another last command; None: the robot's motion then."""

    def limit_speed(self, limits: SpeedCap) -> None:
        """Drive no faster than these limits, from the next step on."""

    def step(self, inputs: FollowerInputs, dt: float) -> FollowerOutput:
        """Return the command for the next ``dt`` seconds."""

    def rollouts(self, most: int) -> Rollouts | None:
        """Return up to ``most`` motions that the last step compared; None: none."""
        return None


class TrackingErrors(NamedTuple):
    """Where the robot is, relative to the path that it follows."""

    cross_track_m: float = 0.0
    heading_error_rad: float = 0.0
    distance_left_m: float = 0.0


class BaseFollower(Follower):
    """State of a follower: limits, obstacles, the command before, why it is at rest.

    Args:
        params: limits and tolerances.
        collision: check of commands against the obstacles.
    """

    def __init__(self, params: ControlParams, collision: CollisionCheck) -> None:
        self._params = params
        self._gate = CommandGate(params)
        self._collision = collision
        self._speed_limits = NO_CAP
        self._discs = NO_DISCS
        self._body_m = Footprint.from_flat(params.footprint_m).circumscribed_radius
        self.reset()

    def warm_up(self) -> None:
        """Load or compile the kernels before the first path; a user's method has none.

        A robot that drives would wait for them between two commands.
        """

    def reset(self, rest: ControlState = ControlState.IDLE) -> None:
        self._rest: ControlState | None = rest  # None while a path is followed
        self._last: VelocityCommand | None = None
        self._clearance, self._scale = math.inf, 1.0
        self._limited_by = LimitedBy.NONE

    @property
    def has_path(self) -> bool:
        return self._rest is None

    @property
    def obstacle_reach_m(self) -> float:
        return self._collision.reach(self._params.max_speed_mps)

    @property
    def unseen_reach_m(self) -> float:
        return self._collision.reach(self._params.reverse_speed_mps)

    def set_obstacles(
        self,
        points: NDArray[np.float64],
        half_cell: float,
        unseen: NDArray[np.float64] = NONE_UNSEEN,
    ) -> None:
        self._collision.set_obstacles(points, half_cell, unseen)

    def set_moving(self, discs: NDArray[np.float64]) -> None:
        self._discs = discs

    def limit_speed(self, limits: SpeedCap) -> None:
        self._speed_limits = limits

    @abstractmethod
    def _errors(self) -> TrackingErrors:
        """Return the errors on the path that is followed."""

    def _at_rest(self, inputs: FollowerInputs) -> FollowerOutput | None:
        """Return a stop without a path or with unusable inputs; None: continue."""
        stale = self._gate.stale(inputs.ages)
        if self._rest is None and stale is None and inputs.plausible:
            return None
        output = self._stop(self._rest or stale or ControlState.STALE_ODOMETRY)
        self._last = None  # continue from the measured motion
        return output

    def _measured(self, inputs: FollowerInputs) -> VelocityCommand:
        """Return the measured motion as a command; slip to the side is none."""
        moves_sideways = self._params.max_side_speed_mps > 0.0
        side = inputs.side_speed if moves_sideways else 0.0
        return VelocityCommand(inputs.speed, inputs.turn_rate, side)

    def _yield_to_moving(
        self, pose: Pose2, motion: VelocityCommand, scale: float
    ) -> None:
        """Store the share of a motion that moving obstacles leave of ``scale``."""
        margin_m = self._params.moving_clearance_m / 2
        yielding = safe_share(pose, motion, self._discs, self._body_m, margin_m)
        self._set_scale(min(1.0, scale, yielding))

    def _set_scale(self, scale: float) -> None:
        """Store the share of the command that obstacles allow."""
        self._scale = scale
        if scale < 1.0:
            self._limited_by = LimitedBy.COLLISION_CHECK

    def _stop(self, state: ControlState) -> FollowerOutput:
        return self._emit(STOP, state)

    def _emit(self, command: VelocityCommand, state: ControlState) -> FollowerOutput:
        """Pass the command through the gate and store it as the last one."""
        refusal = self._gate.refusal(command)
        if refusal is not None:
            command, state = STOP, refusal
        # At rest an operator may drive: start again from the measured motion.
        self._last = command if self._rest is None else None
        return FollowerOutput(
            command,
            state,
            *self._errors(),
            self._clearance,
            self._scale,
            self._limited_by,
        )


class Distances(Protocol):
    """Distance of the robot from the poses of a path."""

    def __call__(self, poses: slice, /) -> NDArray[np.float64]: ...


def nearest_index(
    measure: NDArray[np.float64],
    at: int,
    ahead_m: float,
    distances: Distances,
) -> int:
    """Return the index of the pose nearest to the robot, from ``at`` on.

    Args:
        measure: (N,) length of the path before each pose.
        at: the last result: a robot does not move back on its path.
        ahead_m: how far beyond it the robot may be. The search continues where the
            nearest pose is the last one: the robot may be far along a path that is
            published again.
        distances: of a slice of the poses.
    """
    while True:
        stop = max(int(np.searchsorted(measure, measure[at] + ahead_m)), at + 1)
        best = int(np.argmin(distances(slice(at, stop))))
        at += best
        if best == 0 or at + 1 < stop:
            return at


def try_out(trial: Follower) -> None:
    """Drive a follower past an obstacle for a step, then before a moving one, too."""
    along = np.linspace(0.0, 1.0, 21)
    trial.set_path(np.column_stack([along, 0.0 * along, 0.0 * along]))
    trial.set_obstacles(np.array([(0.5, 1.0)]), 0.01)
    for discs in (NO_DISCS, np.array([(1.0, 1.0, 0.1, 0.0, 0.2)])):
        trial.set_moving(discs)
        trial.step(FollowerInputs(Pose2(0.0, 0.0, 0.0), 0.1, 0.0), 0.05)
