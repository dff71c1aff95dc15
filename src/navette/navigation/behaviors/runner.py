"""Step a behavior: fresh inputs, time allowance, acceleration, collision check."""

from typing import NamedTuple, Protocol

from navette.navigation.behaviors.motions import (
    BaseMotion,
    MeasuredMotion,
    VelocityTarget,
)
from navette.navigation.behaviors.params import BehaviorParams
from navette.navigation.grids import CollisionCheck
from navette.navigation.grids.stall_monitor import StallMonitor

Command = tuple[float, float]
"""m/s, rad/s"""
STOP: Command = (0.0, 0.0)


class BehaviorEnd(NamedTuple):
    """How a behavior ended: name of Nav2's error code (``NONE``: reached), reason."""

    code: str
    reason: str = ""


REACHED = BehaviorEnd("NONE")


class BehaviorStep(NamedTuple):
    """Command of a step, None to leave the wheels alone; ``end`` when it is over."""

    command: Command | None = None
    end: BehaviorEnd | None = None


class BehaviorInputs(NamedTuple):
    """Motion of the robot (None if unknown or stale); whether obstacles are known."""

    motion: MeasuredMotion | None
    sees_obstacles: bool


class Behavior(Protocol):
    """What a goal of the behavior server does."""

    @property
    def progress(self) -> float:
        """Progress, as the action's feedback reports it."""

    def step(self, inputs: BehaviorInputs, dt: float) -> BehaviorStep:
        """Return the command for the next ``dt`` seconds."""


class Allowance:
    """Time that a behavior may take; 0: no limit."""

    def __init__(self, limit_s: float) -> None:
        self.limit_s = limit_s
        self.elapsed_s = 0.0

    def spend(self, dt: float) -> BehaviorEnd | None:
        """Add a step; return the end of the behavior if the time is over."""
        self.elapsed_s += dt
        if not 0.0 < self.limit_s < self.elapsed_s:
            return None
        return BehaviorEnd("TIMEOUT", f"not complete within {self.limit_s:g} s")


class MotionBehavior:
    """Drives a motion to its end.

    Args:
        motion: the motion.
        params: limits and timeouts.
        collision: check with the newest obstacles.
        allowance_s: time after which the behavior fails (TIMEOUT); 0: no limit.
    """

    def __init__(
        self,
        motion: BaseMotion,
        params: BehaviorParams,
        collision: CollisionCheck,
        allowance_s: float,
    ) -> None:
        self._motion = motion
        self._params = params
        self._collision = collision
        self._allowance = Allowance(allowance_s)
        self._stall = StallMonitor(params.stall_time_s)
        self._stale_s = 0.0
        self._last = STOP

    @property
    def progress(self) -> float:
        return self._motion.progress

    def step(self, inputs: BehaviorInputs, dt: float) -> BehaviorStep:
        """Return the command for the next ``dt`` seconds.

        1. time allowance; 2. stale inputs; 3. stall; 4. motion; 5. look ahead;
        6. accelerate.
        """
        timeout = self._allowance.spend(dt)
        if timeout is not None:
            return BehaviorStep(STOP, timeout)
        now = inputs.motion
        if now is None or not inputs.sees_obstacles:
            self._last = STOP
            self._stall.reset()
            return BehaviorStep(STOP, self._stale_end(now, dt))
        self._stale_s = 0.0
        if self._stall.update(self._last, now.pose, (now.speed, now.turn_rate), dt):
            text = "the robot does not move as commanded: an obstacle blocks it"
            return BehaviorStep(STOP, BehaviorEnd("COLLISION_AHEAD", text))
        target = self._motion.step(now)
        if target is None:
            return BehaviorStep(STOP, REACHED)
        if not self._is_free(now, target):
            what = "an obstacle" if target.speed >= 0 else "an obstacle or unseen space"
            text = f"{what} within {self._params.simulate_ahead_s:g} s of motion"
            return BehaviorStep(STOP, BehaviorEnd("COLLISION_AHEAD", text))
        self._last = self._accelerated(target, dt)
        return BehaviorStep(self._last)

    def _stale_end(self, now: MeasuredMotion | None, dt: float) -> BehaviorEnd | None:
        self._stale_s += dt
        if self._stale_s <= self._params.failure_tolerance_s:
            return None
        if now is None:
            return BehaviorEnd("TF_ERROR", "the robot's pose is unknown or stale")
        return BehaviorEnd("COLLISION_AHEAD", "no recent costmap to check against")

    def _is_free(self, now: MeasuredMotion, target: VelocityTarget) -> bool:
        span_s = min(self._params.simulate_ahead_s, target.left_s)
        free_s = self._collision.free_time(
            now.pose, target.speed, target.turn_rate, span_s
        )
        return free_s >= span_s

    def _accelerated(self, target: VelocityTarget, dt: float) -> Command:
        """Return the last command, changed towards the target within the limits."""
        params = self._params
        speed, turn_rate = self._last
        grows = abs(target.speed) > abs(speed)
        rate = params.acceleration_mps2 if grows else params.deceleration_mps2
        turn_step = params.turn_acceleration_radps2 * dt
        return (
            _towards(speed, target.speed, rate * dt),
            _towards(turn_rate, target.turn_rate, turn_step),
        )


class Waiting:
    """Waits; the wheels are left alone."""

    def __init__(self, time_s: float) -> None:
        self.left_s = time_s

    @property
    def progress(self) -> float:
        """Seconds left."""
        return max(0.0, self.left_s)

    def step(self, inputs: BehaviorInputs, dt: float) -> BehaviorStep:
        self.left_s -= dt
        return BehaviorStep(end=REACHED if self.left_s <= 0.0 else None)


class AssistedTeleop:
    """Passes an operator's commands on, slowed down before obstacles.

    Args:
        params: timeouts.
        collision: check with the newest obstacles.
        allowance_s: time after which the behavior fails (TIMEOUT); 0: no limit.
    """

    def __init__(
        self, params: BehaviorParams, collision: CollisionCheck, allowance_s: float
    ) -> None:
        self._params = params
        self._collision = collision
        self._allowance = Allowance(allowance_s)
        self._command = STOP
        self._command_age_s = self._stale_s = 0.0
        #: Set when the operator has finished.
        self.is_finished = False

    @property
    def progress(self) -> float:
        """Seconds since the start."""
        return self._allowance.elapsed_s

    def receive(self, command: Command) -> None:
        """Use a command of the operator until the next one."""
        self._command, self._command_age_s = command, 0.0

    def step(self, inputs: BehaviorInputs, dt: float) -> BehaviorStep:
        timeout = self._allowance.spend(dt)
        if timeout is not None or self.is_finished:
            return BehaviorStep(STOP, timeout or REACHED)
        self._command_age_s += dt
        if self._command_age_s > self._params.teleop_timeout_s:
            self._command = STOP
        self._stale_s = 0.0 if inputs.motion is not None else self._stale_s + dt
        if self._stale_s > self._params.failure_tolerance_s:
            text = "the robot's pose is unknown or stale"
            return BehaviorStep(STOP, BehaviorEnd("TF_ERROR", text))
        if inputs.motion is None or not inputs.sees_obstacles:
            return BehaviorStep(STOP)
        scale = self._collision.check(inputs.motion.pose, self._command).scale
        speed, turn_rate = self._command
        scale = min(1.0, scale)
        return BehaviorStep((speed * scale, turn_rate * scale))


def _towards(value: float, target: float, step: float) -> float:
    return value + min(step, max(-step, target - value))
