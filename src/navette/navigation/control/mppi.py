"""Model-predictive path integral control of a robot along a path.

Williams, Aldrich and Theodorou, "Model Predictive Path Integral Control: From Theory to
Parallel Computing" (2017), algorithm 2:

1. shift the previous command sequence by the time that passed;
2. add noise: K candidate sequences, a few of them fixed manoeuvres, and some that track
   the path;
3. roll every candidate out with the robot's limits and sum its cost;
4. average the candidates, weighted by exp(−cost / temperature);
5. the first command of the average is the result.

The noise is drawn once from a seeded generator and used in turns, so that equal inputs
give equal commands. A command is speed and turn rate, speed and curvature (Ackermann),
or speed, speed to the left and turn rate (omnidirectional); see :mod:`.drive_models`.
"""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import DRIVES
from navette.navigation.control.drive_models import (
    ACKERMANN,
    DIFFERENTIAL,
    OMNI,
    DriveLimits,
)
from navette.navigation.control.limits import NO_CAP, SpeedCap, VelocityCommand
from navette.navigation.control.moving_obstacles import add_moving_costs
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_candidates import SHARES, fill_path_candidates
from navette.navigation.control.records import Rollouts
from navette.navigation.control.rollouts import (
    CostWeights,
    LocalField,
    PathTable,
    PathWindow,
    RolloutBody,
    rollout_costs,
)
from navette.navigation.grids import NO_DISCS

Array = NDArray[np.float64]
Array32 = NDArray[np.float32]

_SHARES = np.array(SHARES, np.float32)
_STANDSTILL_MPS = 0.05
# Sets of noise that are used in turns.
_NOISE_SETS = 8
# Share of the previous noise in the next step's: smooth candidates.
_NOISE_MEMORY = 0.7
# Standard deviation of the noise as a share of the largest speed and turn rate.
_SPEED_NOISE, _TURN_NOISE = 0.3, 0.4
# Candidates that are fixed manoeuvres: shares of the speed and of the turn rate or
# curvature; omnidirectional drives have some that move sideways, too.
_MANOEUVRES = tuple(
    (v, w)
    for v in (1.0, 0.6, 0.3, 0.0, -1.0)
    for w in (-1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0)
)
# Swerves: shares of the speed and of the turn rate, and how long each turn lasts.
_SWERVE_SPEEDS, _SWERVE_TURNS = (1.0, 0.6), (-1.0, -0.5, 0.5, 1.0)
_SWERVE_S = (0.4, 0.8)
_SIDEWAYS = tuple(
    (v, side) for v in (-0.5, 0.0, 0.5) for side in (-1.0, -0.4, 0.4, 1.0)
)
# The share of the horizon after which manoeuvres end early.
_EARLY = 3
# Weights below change nothing, and products with the smallest take 25 times as long.
_LEAST_WEIGHT = 1e-12


class MotionState(NamedTuple):
    """Pose in the map (m, rad), speed (m/s), turn rate (rad/s), speed to the left."""

    x: float
    y: float
    yaw: float
    speed: float
    turn_rate: float
    side: float = 0.0


class Mppi:
    """The optimiser; keeps the command sequence between steps."""

    def __init__(
        self,
        params: ControlParams,
        body: Array,
        seed: int = 0,
        *,
        swerves: bool = False,
    ) -> None:
        """Args: params; body (P, 3) x, y, disc radius (base frame, m); noise seed.

        ``swerves``: also try to turn off and back again, past what comes.
        """
        self._params = params
        self._drive = DRIVES.index(params.drive)
        self._cap, self._limits = NO_CAP, _limits(params, NO_CAP)
        self._weights = _weights(params)
        self._step_s = params.mppi_step_s
        self._temperature = params.mppi_temperature
        self._body = RolloutBody.of(body)
        steps, samples = params.mppi_steps, params.mppi_samples
        self._noise = self._draw(samples, steps, np.random.default_rng(seed))
        fixed = self._manoeuvres(steps)
        if swerves:
            fixed = np.concatenate([fixed, self._swerves(steps)], axis=2)
        self._fixed = fixed.astype(np.float32)
        self._commands = np.zeros((steps, len(self._most)), np.float32)
        count = samples + self._fixed.shape[2] + len(_SHARES)
        self._candidates = np.empty((steps, len(self._most), count), np.float32)
        self._costs = np.empty(count, np.float32)
        self._turn = 0

    def limit_speed(self, limits: SpeedCap) -> None:
        """Drive no faster than these limits, from the next step on."""
        if limits != self._cap:
            self._cap, self._limits = limits, _limits(self._params, limits)

    def reset(self) -> None:
        """Forget the command sequence: the robot stands."""
        self._commands[:] = 0.0

    def continue_from(self, other: "Mppi") -> None:
        """Take over the command sequence of another optimiser of the same drive."""
        self._commands[:] = other._commands

    @property
    def horizon_s(self) -> float:
        """Length of the prediction."""
        return self._step_s * len(self._commands)

    def step(
        self,
        state: MotionState,
        path: PathWindow,
        field: LocalField,
        dt: float,
        discs: Array = NO_DISCS,
    ) -> VelocityCommand:
        """Return the command for the next ``dt`` seconds.

        ``discs``: moving obstacles (M, 5) x, y, vx, vy, radius.
        """
        candidates = self._draw_candidates(dt)
        step_s: Any = np.float32(self._step_s)
        motion = state.speed, state.side, state.turn_rate, self._curvature(state)
        fastest = max(abs(state.speed) + abs(state.side), sum(self._most[:-1]))
        table = PathTable.of(path, state.x, state.y, float(self._step_s * fastest))
        fill_path_candidates(
            candidates[:, :, -len(_SHARES) :],
            float(state.yaw),
            table,
            self._limits,
            self._drive,
            _SHARES,
            self._step_s,
        )
        rollout_costs(
            candidates,
            np.array((state.yaw, *motion)),
            step_s,
            self._drive,
            self._limits,
            table,
            field._replace(x=field.x - state.x, y=field.y - state.y),
            self._body,
            self._weights,
            self._costs,
        )
        if len(discs):
            add_moving_costs(
                candidates,
                state.yaw,
                step_s,
                self._drive,
                _relative(discs, state),
                (self._body.reach_m, self._params.moving_clearance_m),
                self._costs,
            )
        self._average(candidates)
        return self._first_command()

    def rollouts(self, state: MotionState, most: int) -> Rollouts:
        """Return the motions of the last step from ``state``: the cheapest, and others.

        The others are spread evenly over the samples and manoeuvres.
        """
        count = len(self._costs)
        chosen = np.linspace(0, count - 1, min(most, count), dtype=np.intp)
        chosen[0] = self._costs.argmin()
        chosen = chosen[np.argsort(self._costs[chosen], kind="stable")]
        commands = self._candidates[:, :, chosen].astype(np.float64)
        forward, turn = commands[:, 0], commands[:, -1]
        side = commands[:, 1] if self._drive == OMNI else np.zeros_like(forward)
        if self._drive == ACKERMANN:
            turn = forward * turn
        yaw = state.yaw + self._step_s * (np.cumsum(turn, axis=0) - turn / 2)
        dx = forward * np.cos(yaw) - side * np.sin(yaw)
        dy = forward * np.sin(yaw) + side * np.cos(yaw)
        ways = self._step_s * np.cumsum(np.stack([dx, dy], axis=-1), axis=0)
        positions = np.concatenate([np.zeros((1, len(chosen), 2)), ways])
        positions += (state.x, state.y)
        return Rollouts(positions.swapaxes(0, 1), self._costs[chosen].astype(float))

    def alternatives(self) -> Iterator[VelocityCommand]:
        """Yield the first commands of candidates that cost less than standing still.

        The cheapest comes first. The sequence continues from the one that is taken,
        or from the mean when all are left.
        """
        mean, samples = self._commands, self._noise.shape[3]
        standing = self._costs[samples + _MANOEUVRES.index((0.0, 0.0))]
        for k in np.argsort(self._costs, kind="stable"):
            if self._costs[k] >= standing:
                break
            self._commands = self._candidates[:, :, k].copy()
            yield self._first_command()
        self._commands = mean

    def _curvature(self, state: MotionState) -> float:
        """Return the curvature (1/m) to which an Ackermann drive is steered."""
        if self._drive != ACKERMANN:
            return 0.0
        if abs(state.speed) < _STANDSTILL_MPS:
            return float(self._commands[0, 1])
        most = float(self._limits.max_curvature)
        return min(most, max(-most, state.turn_rate / state.speed))

    def _draw_candidates(self, dt: float) -> Array32:
        """Return the candidates (T, D, K): noise about the sequence, and manoeuvres.

        The sequence is first moved by ``dt``.
        """
        share: Any = np.float32(min(1.0, dt / self._step_s))
        noise = self._noise[self._turn]
        self._turn = (self._turn + 1) % _NOISE_SETS
        _fill_candidates(share, self._commands, noise, self._fixed, self._candidates)
        return self._candidates

    def _average(self, candidates: Array32) -> None:
        costs = self._costs
        weight = np.exp((costs.min() - costs) / np.float32(self._temperature))
        weight /= weight.sum()
        weight[weight < _LEAST_WEIGHT] = 0.0
        # Within the limits: a mean of candidates that are.
        shape = self._commands.shape
        self._commands = (candidates.reshape(-1, len(weight)) @ weight).reshape(shape)

    def _first_command(self) -> VelocityCommand:
        first = self._commands[0].tolist()
        if self._drive == OMNI:
            return VelocityCommand(first[0], first[2], first[1])
        if self._drive == ACKERMANN:
            return VelocityCommand(first[0], first[0] * first[1])
        return VelocityCommand(first[0], first[1])

    @property
    def _most(self) -> tuple[float, ...]:
        """Largest magnitude of each part of a command."""
        limits = self._limits
        if self._drive == OMNI:
            return limits.max_speed, limits.max_side_speed, limits.max_turn_rate
        if self._drive == ACKERMANN:
            return limits.max_speed, limits.max_curvature
        return limits.max_speed, limits.max_turn_rate

    def _draw(self, samples: int, steps: int, rng: np.random.Generator) -> Array32:
        """Return noise (sets, T, D, K), correlated over time; the first K is zero."""
        scale = np.array([_SPEED_NOISE * most for most in self._most])
        scale[-1] = _TURN_NOISE * self._most[-1]
        white = rng.standard_normal((_NOISE_SETS, samples, steps, len(scale)))
        keep = _NOISE_MEMORY
        for t in range(1, steps):
            white[:, :, t] = (
                keep * white[:, :, t - 1] + (1 - keep**2) ** 0.5 * white[:, :, t]
            )
        white[:, 0] = 0.0
        return np.ascontiguousarray(np.moveaxis(white * scale, 1, 3), np.float32)

    def _manoeuvres(self, steps: int) -> Array:
        """Return the commands (T, D, F) of the fixed manoeuvres.

        Steered and omnidirectional drives also have each of them ending early: in a
        narrow place noise that stays clear and stops in time is rare.
        """
        limits = self._limits
        forward, turn = limits.max_speed, self._most[-1]
        moves: list[tuple[float, ...]] = [
            (v * (forward if v > 0 else limits.max_reverse), w * turn)
            for v, w in _MANOEUVRES
        ]
        if self._drive == DIFFERENTIAL:
            return np.repeat(np.array(moves).T[None], steps, axis=0)
        if self._drive == OMNI:
            moves = [(v, 0.0, w) for v, w in moves]
            moves += [
                (v * forward, side * limits.max_side_speed, 0.0)
                for v, side in _SIDEWAYS
            ]
        whole = np.repeat(np.array(moves).T[None], steps, axis=0)
        short = whole.copy()
        short[steps // _EARLY :, : 1 if self._drive == ACKERMANN else None] = 0.0
        return np.concatenate([whole, short], axis=2)

    def _swerves(self, steps: int) -> Array:
        """Return the commands (T, D, F) of turns off the path and back."""
        parts = [(speed, turn, time) for speed in _SWERVE_SPEEDS
                 for turn in _SWERVE_TURNS for time in _SWERVE_S]  # fmt: skip
        commands = np.zeros((steps, len(self._most), len(parts)))
        for i, (speed, turn, time_s) in enumerate(parts):
            count = max(1, round(time_s / self._step_s))
            commands[:, 0, i] = speed * self._limits.max_speed
            commands[:count, -1, i] = turn * self._most[-1]
            commands[count : 2 * count, -1, i] = -turn * self._most[-1]
        return commands


@kernel(allocates=False)
def _fill_candidates(
    share: float, commands: Array32, noise: Array32, fixed: Array32, candidates: Array32
) -> None:
    """Move commands (T, D) by a share of a step; add noise (T, D, S) and fixed ones."""
    steps, parts, samples = noise.shape
    for t in range(steps):
        for part in range(parts):
            if t + 1 < steps:
                change = commands[t + 1, part] - commands[t, part]
                commands[t, part] += share * change
            row, about = candidates[t, part], commands[t, part]
            for k in range(samples):
                row[k] = noise[t, part, k] + about
            for k in range(fixed.shape[2]):
                row[samples + k] = fixed[t, part, k]


def _relative(discs: Array, state: MotionState) -> Array32:
    """Return discs relative to the robot's position."""
    return (discs - (state.x, state.y, 0.0, 0.0, 0.0)).astype(np.float32)


def _weights(params: ControlParams) -> CostWeights:
    values = CostWeights(
        align=params.mppi_align_weight,
        heading=params.mppi_heading_weight,
        progress=params.mppi_progress_weight,
        clearance=params.mppi_clearance_weight,
        clearance_m=params.mppi_clearance_m,
        reverse=params.mppi_reverse_weight,
        effort=params.mppi_effort_weight,
        margin_m=params.collision_margin_m,
    )
    return CostWeights._make(map(np.float32, values))


def _limits(params: ControlParams, cap: SpeedCap) -> DriveLimits:
    radius = params.min_turning_radius_m
    values = DriveLimits(
        max_speed=min(params.cruise_speed_mps, cap.forward),
        max_reverse=min(params.reverse_speed_mps, cap.reverse),
        max_turn_rate=params.max_turn_rate_radps,
        acceleration=params.acceleration_mps2,
        deceleration=params.deceleration_mps2,
        turn_acceleration=params.turn_acceleration_radps2,
        lateral_acceleration=params.lateral_acceleration_mps2,
        max_curvature=1.0 / radius if radius else 0.0,
        curvature_rate=1.0 / (radius * params.steering_time_s) if radius else 0.0,
        max_side_speed=min(params.max_side_speed_mps, cap.forward),
    )
    return DriveLimits._make(map(np.float32, values))
