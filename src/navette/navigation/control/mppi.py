"""Model-predictive path integral control of a robot along a path.

Williams, Aldrich and Theodorou, "Model Predictive Path Integral Control: From Theory to
Parallel Computing" (2017), algorithm 2:

1. shift the previous command sequence by the time that passed;
2. add noise: K candidate sequences, a few of them fixed manoeuvres;
3. roll every candidate out with the robot's limits and sum its cost;
4. average the candidates, weighted by exp(−cost / temperature);
5. the first command of the average is the result.

The noise is drawn once from a seeded generator and used in turns, so that equal inputs
give equal commands.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.navigation.control.limits import SpeedCap, VelocityCommand
from navette.navigation.control.params import ControlParams
from navette.navigation.control.rollouts import (
    CostWeights,
    DriveLimits,
    LocalField,
    PathWindow,
    rollout_costs,
)

Array = NDArray[np.float64]

# Sets of noise that are used in turns.
_NOISE_SETS = 8
# Share of the previous noise in the next step's: smooth candidates.
_NOISE_MEMORY = 0.7
# Candidates that are fixed manoeuvres: speed shares and turn-rate shares.
_MANOEUVRES = tuple(
    (v, w)
    for v in (1.0, 0.6, 0.3, 0.0, -1.0)
    for w in (-1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0)
)


class MotionState(NamedTuple):
    """Pose in the map (m, rad), speed (m/s) and turn rate (rad/s)."""

    x: float
    y: float
    yaw: float
    speed: float
    turn_rate: float


class Mppi:
    """The optimiser; keeps the command sequence between steps."""

    def __init__(self, params: ControlParams, body: Array, seed: int = 0) -> None:
        """Args: params; body (P, 3) x, y, disc radius (base frame, m); noise seed."""
        self._params = params
        self._limits = DriveLimits(
            max_speed=params.cruise_speed_mps,
            max_reverse=params.reverse_speed_mps,
            max_turn_rate=params.max_turn_rate_radps,
            acceleration=params.acceleration_mps2,
            deceleration=params.deceleration_mps2,
            turn_acceleration=params.turn_acceleration_radps2,
            lateral_acceleration=params.lateral_acceleration_mps2,
        )
        self._weights = CostWeights(
            align=params.mppi_align_weight,
            heading=params.mppi_heading_weight,
            progress=params.mppi_progress_weight,
            clearance=params.mppi_clearance_weight,
            clearance_m=params.mppi_clearance_m,
            reverse=params.mppi_reverse_weight,
            effort=params.mppi_effort_weight,
            margin_m=params.collision_margin_m,
        )
        self._step_s = params.mppi_step_s
        self._temperature = params.mppi_temperature
        self._body = np.ascontiguousarray(body)
        self._reach = float(np.hypot(body[:, 0], body[:, 1]).max())
        steps, samples = params.mppi_steps, params.mppi_samples
        self._noise = self._draw(samples, steps, np.random.default_rng(seed))
        self._fixed = self._manoeuvres(steps)
        self._commands = np.zeros((steps, 2))
        self._costs = np.empty(samples + len(self._fixed))
        self._turn = 0

    def limit_speed(self, limits: SpeedCap) -> None:
        """Drive no faster than these limits, from the next step on."""
        params = self._params
        self._limits = self._limits._replace(
            max_speed=min(params.cruise_speed_mps, limits.forward),
            max_reverse=min(params.reverse_speed_mps, limits.reverse),
        )

    def reset(self) -> None:
        """Forget the command sequence: the robot stands."""
        self._commands[:] = 0.0

    @property
    def horizon_s(self) -> float:
        """Length of the prediction."""
        return self._step_s * len(self._commands)

    def step(
        self, state: MotionState, path: PathWindow, field: LocalField, dt: float
    ) -> VelocityCommand:
        """Return the command for the next ``dt`` seconds."""
        self._shift(dt)
        noise = self._noise[self._turn]
        self._turn = (self._turn + 1) % _NOISE_SETS
        candidates = self._candidates(noise)
        rollout_costs(
            candidates,
            np.array(state),
            self._step_s,
            self._limits,
            path,
            field,
            self._body,
            self._reach,
            self._weights,
            self._costs,
        )
        self._average(candidates)
        v, w = self._commands[0]
        return VelocityCommand(float(v), float(w))

    def _shift(self, dt: float) -> None:
        """Move the sequence by ``dt``, interpolating between its steps."""
        share = min(1.0, dt / self._step_s)
        self._commands[:-1] += share * (self._commands[1:] - self._commands[:-1])

    def _candidates(self, noise: Array) -> Array:
        return np.concatenate([self._commands + noise, self._fixed])

    def _average(self, candidates: Array) -> None:
        costs = self._costs
        least = costs.min()
        weight = np.exp(-(costs - least) / self._temperature)
        weight /= weight.sum()
        self._commands = np.tensordot(weight, candidates, 1)
        limits = self._limits
        np.clip(
            self._commands,
            (-limits.max_reverse, -limits.max_turn_rate),
            (limits.max_speed, limits.max_turn_rate),
            out=self._commands,
        )

    def _draw(self, samples: int, steps: int, rng: np.random.Generator) -> Array:
        """Return noise (sets, K, T, 2), correlated over time; the first K is zero."""
        scale = np.array(
            [0.3 * self._limits.max_speed, 0.4 * self._limits.max_turn_rate]
        )
        white = rng.standard_normal((_NOISE_SETS, samples, steps, 2))
        keep = _NOISE_MEMORY
        for t in range(1, steps):
            white[:, :, t] = (
                keep * white[:, :, t - 1] + (1 - keep**2) ** 0.5 * white[:, :, t]
            )
        white[:, 0] = 0.0
        noise: Array = white * scale
        return noise

    def _manoeuvres(self, steps: int) -> Array:
        limits = self._limits
        commands = np.array(
            [
                (
                    v * (limits.max_speed if v > 0 else limits.max_reverse),
                    w * limits.max_turn_rate,
                )
                for v, w in _MANOEUVRES
            ]
        )
        return np.repeat(commands[:, None, :], steps, axis=1)
