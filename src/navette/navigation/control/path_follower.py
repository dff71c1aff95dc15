"""The controller: follows one path after another, piece by piece."""

import math

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Footprint, Pose2
from navette.navigation.control.collision_check import CollisionCheck
from navette.navigation.control.command_gate import CommandGate
from navette.navigation.control.cross_track_pid import CrossTrackPid
from navette.navigation.control.drive import Equipment, PieceDrive, Steering
from navette.navigation.control.limits import STOP, Command
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import DrivePiece, Piece, split_path
from navette.navigation.control.pure_pursuit import PurePursuit
from navette.navigation.control.records import FollowerInputs, FollowerOutput, Wanted
from navette.navigation.control.rotate import TurnInPlace
from navette.navigation.control.states import ControlState
from navette.navigation.control.turn_gain import TurnGain

_START_WINDOW_M = 2.0  # how far along a new path the robot may already be
_BLOCKED_SCALE = 0.1  # less of a command is not worth moving …
_FREED_SCALE = 0.3  # … and a blocked robot starts again only for this much
_RESTS_MPS = 0.05


class PathFollower:
    """Follows paths of poses; :meth:`step` gives the next command.

    Without a path, and on any doubt about its inputs, it commands zero.
    """

    def __init__(self, params: ControlParams) -> None:
        self._params = params
        self._gate = _gate_of(params)
        self._with = Equipment(
            params, params.limits(), _steering_of(params), _collision_of(params),
            TurnGain(),
        )  # fmt: skip
        self.reset()

    def reset(self, rest: ControlState = ControlState.IDLE) -> None:
        """Forget the path and stop at once; ``rest`` says why."""
        self._with.steering.reset()
        self._pieces: list[Piece] = []
        self._active: PieceDrive | TurnInPlace | None = None
        self._goal = (0.0, 0.0)
        self._rest: ControlState | None = rest
        self._last: Command | None = None
        self._clearance = math.inf
        self._blocked = False

    @property
    def has_path(self) -> bool:
        """Whether there is a path still to be driven."""
        return self._rest is None

    @property
    def obstacle_reach_m(self) -> float:
        """Distance around the robot within which obstacles matter."""
        return self._with.collision.reach(self._params.max_speed_mps)

    def set_path(self, poses: NDArray[np.float64]) -> None:
        """Take over a path (N, 3) x, y, yaw (m, rad, map); an empty one stops.

        A robot that moves in the direction of the new path does not stop for it.

        Raises:
            InvalidValueError: not (N, 3) or not finite; the follower is then reset.
        """
        last, clearance = self._last, self._clearance
        self.reset()
        if len(poses) == 0:
            return
        self._pieces = split_path(
            poses,
            tolerance=self._params.path_tolerance_m,
            sharp=self._params.corner_rotate_rad,
        )
        self._goal = (float(poses[-1, 0]), float(poses[-1, 1]))
        self._rest = None
        self._last, self._clearance = last, clearance
        self._activate(_START_WINDOW_M)

    def set_obstacles(self, points: NDArray[np.float64], half_cell: float) -> None:
        """Obstacle cell centres (N, 2), metres, map; half a cell's edge, metres."""
        self._with.collision.set_obstacles(points, half_cell)

    def step(self, inputs: FollowerInputs, dt: float) -> FollowerOutput:
        """The command for the next ``dt`` seconds.

        1. stop on stale inputs; 2. learn how well the wheels turn; 3. steer along the
        piece; 4. accelerate within the limits; 5. keep clear of obstacles; 6. gate.
        """
        stale = self._gate.stale(inputs.ages)
        if self._rest is not None or stale is not None or not inputs.plausible:
            return self._stop(self._rest or stale or ControlState.STALE_ODOMETRY)
        last = self._last or Command(inputs.speed, inputs.turn_rate)
        last = self._with.limits.clamp(last)
        self._with.turn_gain.update(last.turn_rate, inputs.turn_rate, dt)
        wanted = self._steer(inputs)
        if wanted.state.rests:
            return self._stop(wanted.state)
        command = self._accelerate(last, wanted, dt)
        command, blocked = self._keep_clear(inputs.pose, wanted, command)
        state = ControlState.BLOCKED if blocked else wanted.state
        return self._emit(command, state)

    def _steer(self, inputs: FollowerInputs) -> Wanted:
        """Ask the active piece; at its end the next one, at the last one stop."""
        while self._active is not None:
            if isinstance(self._active, PieceDrive):
                wanted = self._active.step(inputs, self._clearance)
            else:
                wanted = self._active.step(inputs, self._with.turn_gain.value)
            if wanted is not None:
                return wanted
            self._pieces.pop(0)
            self._activate()
        if abs(inputs.speed) > _RESTS_MPS:
            return Wanted(STOP, ControlState.FOLLOWING, brakes=True)
        missed = math.dist(self._goal, (inputs.pose.x, inputs.pose.y))
        reached = missed <= self._params.goal_tolerance_m
        self._rest = ControlState.REACHED if reached else ControlState.MISSED_GOAL
        return Wanted(STOP, self._rest)

    def _activate(self, start_window: float = 0.3) -> None:
        """Make the first piece left the active one."""
        if not self._pieces:
            self._active = None
            return
        piece = self._pieces[0]
        if isinstance(piece, DrivePiece):
            self._active = PieceDrive(piece, self._with, start_window)
        else:
            self._active = TurnInPlace(
                piece.yaw,
                piece.turn,
                tolerance=self._params.turn_tolerance_rad,
                limits=self._with.limits,
                is_free=self._with.collision.turn_is_free,
            )

    def _accelerate(self, last: Command, wanted: Wanted, dt: float) -> Command:
        limits = self._with.limits
        if wanted.brakes:
            return limits.brake(last, dt)
        return limits.towards(last, wanted.command, dt)

    def _keep_clear(
        self, pose: Pose2, wanted: Wanted, command: Command
    ) -> tuple[Command, bool]:
        """Scale the command to what the obstacles allow; whether that is a stop."""
        if not self._params.collision_check:
            return command, False
        # Blocked, it looks as far as it wants to go: the first small command from
        # standstill always fits, and the robot would creep up by fits and starts.
        v, omega = self._with.limits.clamp(wanted.command) if self._blocked else command
        motion = Command(v, omega * self._with.turn_gain.value)
        scale, self._clearance = self._with.collision.check(pose, motion)
        self._blocked = scale < (_FREED_SCALE if self._blocked else _BLOCKED_SCALE)
        if self._blocked:
            if self._active is not None:
                self._active.reconsider()
            return STOP, True
        scale = min(1.0, scale)
        return Command(command.speed * scale, command.turn_rate * scale), False

    def _stop(self, state: ControlState) -> FollowerOutput:
        return self._emit(STOP, state)

    def _emit(self, command: Command, state: ControlState) -> FollowerOutput:
        """Pass the command through the gate and remember what was sent."""
        refusal = self._gate.refusal(command)
        if refusal is not None:
            command, state = STOP, refusal
        # At rest others may drive (teleop): start again from the measured motion.
        self._last = command if self._rest is None else None
        drive = self._active if isinstance(self._active, PieceDrive) else None
        left = drive.distance_left if drive else 0.0
        for piece in self._pieces[1 if drive else 0 :]:
            left += piece.length if isinstance(piece, DrivePiece) else 0.0
        return FollowerOutput(
            command,
            state,
            drive.at.cross_track if drive else 0.0,
            drive.at.heading_error if drive else 0.0,
            left,
            self._clearance,
        )


def _gate_of(params: ControlParams) -> CommandGate:
    return CommandGate(
        params.limits(),
        odometry_timeout=params.odometry_timeout_s,
        costmap_timeout=params.costmap_timeout_s
        if params.collision_check
        else math.inf,
        planner_timeout=params.planner_timeout_s or math.inf,
    )


def _steering_of(params: ControlParams) -> Steering:
    if params.method == "pure_pursuit":
        return PurePursuit(
            lookahead=params.lookahead_m,
            shortest=params.lookahead_min_m,
            time=params.lookahead_time_s,
            tolerance=params.path_tolerance_m,
        )
    return CrossTrackPid(
        params.pid_kp_per_m2, params.pid_ki_per_m3, params.pid_kd_per_m
    )


def _collision_of(params: ControlParams) -> CollisionCheck:
    return CollisionCheck(
        Footprint.from_flat(params.footprint_m),
        margin=params.collision_margin_m,
        horizon=params.slow_clearance_m,
        reaction=params.reaction_s,
        deceleration=params.deceleration_mps2,
        turn_deceleration=params.turn_acceleration_radps2,
    )
