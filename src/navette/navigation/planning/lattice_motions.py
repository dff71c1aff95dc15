"""Moves of the lattice search: short motions of each kind of drive."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import ACKERMANN, DIFFERENTIAL, OMNI


class Move(NamedTuple):
    """Direction of travel forward and to the left (−1, 0, 1), heading steps left."""

    forward: int
    side: int
    turn: int


MOVES: dict[str, tuple[Move, ...]] = {
    DIFFERENTIAL: tuple(
        Move(forward, 0, turn)
        for forward, turns in ((1, (0, 1, -1)), (-1, (0, 1, -1)), (0, (1, -1)))
        for turn in turns
    ),
    # The bends of two heading steps have the least radius.
    ACKERMANN: tuple(
        Move(forward, 0, turn) for forward in (1, -1) for turn in (0, 1, -1, 2, -2)
    ),
    OMNI: (
        *(Move(1, 0, turn) for turn in (0, 1, -1)),
        Move(-1, 0, 0),
        *(Move(forward, side, 0) for side in (1, -1) for forward in (0, 1, -1)),
        *(Move(0, 0, turn) for turn in (1, -1)),
    ),
}
"""Motion set of each drive."""


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
        drive: kind of the drive; an Ackermann drive does not turn in place, an
            omnidirectional one also moves sideways.
        bins_per_step: of two poses of a heading in the same square, the search keeps
            one; squares in a step. At least two: a move always leaves its square.
    """

    step_m: float
    reach_m: float
    headings: int = 32
    sample_m: float = 0.1
    turn_cost_m_per_rad: float = 0.5
    reverse_factor: float = 1.5
    cusp_cost_m: float = 0.5
    drive: str = DIFFERENTIAL
    bins_per_step: int = 2

    def __post_init__(self) -> None:
        if self.headings < 8:
            raise InvalidValueError(f"{self.headings} headings: must be at least 8")
        for name in ("step_m", "reach_m", "sample_m"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise InvalidValueError(f"{name} {value!r}: expected a value > 0")

    @property
    def moves(self) -> tuple[Move, ...]:
        """The motion set."""
        return MOVES[self.drive]

    @property
    def bin_m(self) -> float:
        """Edge of the squares in which the search keeps one pose per heading."""
        return self.step_m / self.bins_per_step

    @property
    def heading_step(self) -> float:
        """Angle between neighbouring headings, radians."""
        return math.tau / self.headings

    @cached_property
    def sample_counts(self) -> NDArray[np.int64]:
        """Number of samples (M,) along each move, its end included."""
        return np.array([self._samples(move) for move in self.moves], np.int64)

    @property
    def directions(self) -> NDArray[np.int8]:
        """(M,) 1 forward, −1 reverse, 0 without a cusp before and after it."""
        cusps = self.drive != OMNI
        return np.array([cusps * move.forward for move in self.moves], np.int8)

    @property
    def turns(self) -> NDArray[np.int64]:
        """(M,) heading steps to the left."""
        return np.array([move.turn for move in self.moves], np.int64)

    @cached_property
    def offsets(self) -> NDArray[np.float64]:
        """(M, S, 3) dx, dy (m) and turn (rad) of the samples, from heading 0.

        An arc of length s that turns by a: (s sin a / a, s (1 − cos a) / a).
        """
        table = np.zeros((len(self.moves), int(self.sample_counts.max()), 3))
        for m, move in enumerate(self.moves):
            count = self.sample_counts[m]
            for k in range(count):
                fraction = (k + 1) / count
                angle = move.turn * self.heading_step * fraction
                half = angle / 2
                chord = self.step_m * fraction * (math.sin(half) / half if half else 1)
                c, s = chord * math.cos(half), chord * math.sin(half)
                table[m, k] = (
                    move.forward * c - move.side * s,
                    move.forward * s + move.side * c,
                    angle,
                )
        return table

    @cached_property
    def costs_m(self) -> NDArray[np.float64]:
        """(M,) cost of each move, in metres of free driving forward."""
        return np.array([self._cost(move) for move in self.moves])

    def _cost(self, move: Move) -> float:
        if not (move.forward or move.side):
            return self.turn_cost_m_per_rad * self.heading_step
        length = self.step_m * math.hypot(move.forward, move.side)
        backwards = move.forward < 0 and not move.side
        factor = self.reverse_factor if backwards else 1.0
        # More than the straight move, or the path weaves without need. Sideways is
        # for where nothing else fits: sensors and most drives are better forward.
        weaving = 1.3 if move.side else 1.0 + 0.1 * abs(move.turn)
        return length * factor * weaving

    def _samples(self, move: Move) -> int:
        sweep = self.reach_m * self.heading_step * abs(move.turn)
        travel = self.step_m * math.hypot(move.forward, move.side)
        return max(1, math.ceil((travel + sweep / 2) / self.sample_m - 1e-9))
