"""Moves of the lattice search: short motions of a differential drive."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError

# (direction of travel, heading steps to the left) of each move.
MOVES: tuple[tuple[int, int], ...] = (
    (1, 0),
    (1, 1),
    (1, -1),
    (-1, 0),
    (-1, 1),
    (-1, -1),
    (0, 1),
    (0, -1),
)


@dataclass(frozen=True)
class Motions:
    """Straight pieces, arcs and turns in place over evenly spread headings.

    Args:
        step_m: length of a straight piece or an arc.
        reach_m: largest distance of a body point from the base, to sample turns.
        headings: number of headings on the circle.
        sample_m: approximate largest motion of a body point between samples.
        turn_cost_m_per_rad: cost of turning in place, in metres per radian.
        reverse_factor: cost of a metre in reverse, in metres forward.
        cusp_cost_m: cost of a change of direction, in metres.
    """

    step_m: float
    reach_m: float
    headings: int = 32
    sample_m: float = 0.1
    turn_cost_m_per_rad: float = 0.5
    reverse_factor: float = 1.5
    cusp_cost_m: float = 0.5

    def __post_init__(self) -> None:
        if self.headings < 8:
            raise InvalidValueError(f"{self.headings} headings: must be at least 8")
        for name in ("step_m", "reach_m", "sample_m"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise InvalidValueError(f"{name} {value!r}: expected a value > 0")

    @property
    def heading_step(self) -> float:
        """Angle between neighbouring headings, radians."""
        return math.tau / self.headings

    @cached_property
    def sample_counts(self) -> NDArray[np.int64]:
        """Number of samples (8,) along each move, its end included."""
        return np.array([self._samples(*move) for move in MOVES], np.int64)

    @cached_property
    def offsets(self) -> NDArray[np.float64]:
        """(8, S, 3) dx, dy (m) and turn (rad) of the samples, from heading 0.

        An arc of length s that turns by a: (s sin a / a, s (1 − cos a) / a).
        """
        table = np.zeros((len(MOVES), int(self.sample_counts.max()), 3))
        for m, (direction, turn) in enumerate(MOVES):
            count = self.sample_counts[m]
            for k in range(count):
                fraction = (k + 1) / count
                angle = turn * self.heading_step * fraction
                s = direction * self.step_m * fraction
                half = angle / 2
                chord = s * (math.sin(half) / half if half else 1.0)
                table[m, k] = chord * math.cos(half), chord * math.sin(half), angle
        return table

    @cached_property
    def costs_m(self) -> NDArray[np.float64]:
        """(8,) cost of each move, in metres of free driving forward."""
        costs = []
        for direction, turn in MOVES:
            if direction == 0:
                costs.append(self.turn_cost_m_per_rad * self.heading_step)
            else:
                factor = 1.0 if direction > 0 else self.reverse_factor
                # More than the straight move, or the path weaves without need.
                costs.append(self.step_m * factor * (1.1 if turn else 1.0))
        return np.array(costs)

    def _samples(self, direction: int, turn: int) -> int:
        sweep = self.reach_m * self.heading_step * abs(turn)
        travel = self.step_m * abs(direction)
        return max(1, math.ceil((travel + sweep / 2) / self.sample_m - 1e-9))
