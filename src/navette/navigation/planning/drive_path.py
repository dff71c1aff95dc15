"""A path by the motions of a drive, or the proof that none exists: two floods.

Moves are straight, forward and in reverse, and to the next heading: in place, or along
an arc; an omnidirectional drive also slides. Start and goal, from which moves are
undone, are flooded in turns (Pohl 1971): the smaller of two separate regions decides.
Guided floods come first: most paths are found long before all poses between are
reached.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.geometry import ACKERMANN, OMNI, Pose2, wrap_angles
from navette.navigation.planning.pose_flood import (
    HEADING_RAD,
    HEADINGS,
    Fit,
    Masks,
    Meeting,
    Space,
    Steps,
    Toward,
    away_from,
    flood,
)

_AROUND = 4  # cells beside two floods' path in which one exact path is looked for
_STRAIGHT = 1.5  # cells of a straight motion: it always leaves its cell


class DriveMoves(NamedTuple):
    """What a drive can do.

    Attributes:
        drive: differential, ackermann or omni.
        radius_m: radius of the tightest arc of an Ackermann drive.
    """

    drive: str
    radius_m: float

    def table(self, size_m: float) -> NDArray[np.float64]:
        """Return moves (N, 3): cells, headings, direction from the heading in rad."""
        ways = (1, -1)
        if self.drive == ACKERMANN:
            chord = 2 * self.radius_m * math.sin(math.pi / HEADINGS) / size_m
            moves = [(way * chord, turn, 0.0) for way in ways for turn in (0, 1, -1)]
        else:
            sides = (0.0, math.pi / 2) if self.drive == OMNI else (0.0,)
            moves = [(way * _STRAIGHT, 0, side) for side in sides for way in ways]
            moves += [(0.0, 1, 0.0), (0.0, -1, 0.0)]
        return np.array(moves, np.float64)

    def motions(self, size_m: float, reach_m: float) -> NDArray[np.float64]:
        """Return (N,) metres that a point of a body of a radius moves at most."""
        cells, turn, _ = np.abs(self.table(size_m)).T
        motions: NDArray[np.float64] = size_m * cells + reach_m * HEADING_RAD * turn
        return motions

    def longest_m(self, size_m: float, reach_m: float) -> float:
        """Return the largest motion but for turns in place."""
        drives = self.table(size_m)[:, 0] != 0.0
        return float(self.motions(size_m, reach_m)[drives].max())


class DrivePath(NamedTuple):
    """Result of :func:`find_drive_path`.

    Attributes:
        poses: (M, 3) x, y (m), yaw (rad) of a path, or None. Near it, none has fewer
            moves.
        is_proof: without poses: whether all motions from one end were tried.
    """

    poses: NDArray[np.float64] | None
    is_proof: bool


def find_drive_path(
    open_: Masks,
    turns: Masks,
    seen: Masks,
    start: Pose2,
    size_m: float,
    cells: NDArray[np.int64],
    headings: NDArray[np.int64],
    moves: DriveMoves,
    fit: Fit,
    *,
    thorough: bool,
) -> DrivePath:
    """Return a path through open poses to one of cells (N, 2) at one of headings.

    Args:
        open_: poses of the body that nothing closes.
        turns: turns in place, each from a heading to the next, that nothing closes.
        seen: poses between which the body may move in reverse and sideways.
        start: pose in the frame of the grid; heading 0 is its yaw.
        size_m: edge of a cell.
        cells: row, column of the ends.
        headings: indices of the headings at the ends.
        moves: those of the drive.
        fit: decides about the exact poses of the path.
        thorough: decide, if there is room; otherwise only guided floods are tried.
    """
    table = moves.table(size_m)
    undone = table * (-1.0, -1.0, 1.0)
    steps = _steps(np.array([table, undone]), start.yaw)
    is_blind = (table[:, 0] < 0.0) | (table[:, 2] != 0.0)
    is_turn = table[:, 0] == 0.0
    motions = moves.motions(size_m, fit.outline.radius_m)
    anywhere = fit._replace(sure=open_, sure_turns=turns)
    space = Space(open_, turns, seen, is_turn, is_blind, motions, anywhere)
    begin = np.array([[start.x / size_m, start.y / size_m, 0.0]])
    bits = np.uint64(1) << headings.astype(np.uint64)
    nth, which = np.nonzero(open_[tuple(cells.T)][:, None] & bits)
    ends = np.column_stack([cells[nth, ::-1] + 0.5, headings[which]])
    first = np.floor(begin[:, 1::-1]).astype(np.int64)
    toward = away_from(open_, cells), away_from(open_, first)
    met = _decided(space, begin, ends, steps, toward, both=True, thorough=thorough)
    if not met.chains:
        return DrivePath(None, is_proof=met.is_complete)
    # Where two floods meet they are off by a part of a cell: one along them is exact,
    # or one from the start decides.
    space = space._replace(fit=fit)
    exact = _near(space, begin, ends, steps, met)
    if not exact.chains:
        if not thorough:
            return DrivePath(None, is_proof=False)
        met = _decided(space, begin, ends, steps, toward, both=False, thorough=True)
        if not met.chains:
            return DrivePath(None, is_proof=met.is_complete)
        exact = _near(space, begin, ends, steps, met)
    chain = (exact.chains or met.chains)[0]
    path = _replayed(begin[0], chain, steps)
    yaw = wrap_angles(start.yaw + path[:, 2] * HEADING_RAD)
    return DrivePath(np.column_stack([path[:, :2] * size_m, yaw]), is_proof=True)


def _decided(
    space: Space,
    start: NDArray[np.float64],
    ends: NDArray[np.float64],
    steps: Steps,
    toward: Toward,
    *,
    both: bool,
    thorough: bool,
) -> Meeting:
    """Flood towards the other end; in the order of moves if that does not decide."""
    met = flood(space, start, ends, steps, toward, both=both)
    if met.is_complete or not thorough:
        return met
    return flood(space, start, ends, steps, None, both=both)


def _near(
    space: Space,
    start: NDArray[np.float64],
    ends: NDArray[np.float64],
    steps: Steps,
    met: Meeting,
) -> Meeting:
    """Flood from the start along the chains of floods that met: the fewest moves."""
    corridor = np.zeros_like(space.open)
    for chain in met.chains:
        _copy_around(corridor, space.open, chain[:, :2])
    near = space._replace(open=corridor)
    return flood(near, start, ends, steps, None, both=False)


def _copy_around(to: Masks, of: Masks, cells: NDArray[np.int64]) -> None:
    """Copy the cells (N, 2: row, column) and those around them."""
    height, width = of.shape
    for i, j in np.ndindex(2 * _AROUND + 1, 2 * _AROUND + 1):
        rows = (cells[:, 0] + i - _AROUND).clip(0, height - 1)
        columns = (cells[:, 1] + j - _AROUND).clip(0, width - 1)
        to[rows, columns] = of[rows, columns]


def _steps(table: NDArray[np.float64], yaw: float) -> Steps:
    """Return du, dv in cells (2, headings, moves, 2), and the headings after them.

    The first half of the tables (2, N, 3) is for the flood from the start, the second,
    the same moves undone, for that from the ends.
    """
    length, turn, aside = np.moveaxis(table[:, None], -1, 0)
    heading = np.arange(HEADINGS)[:, None]
    along = yaw + (heading + 0.5 * turn) * HEADING_RAD + aside
    shift = np.stack([length * np.cos(along), length * np.sin(along)], axis=-1)
    return shift, ((heading + turn) % HEADINGS).astype(np.int64)


def _replayed(
    start: NDArray[np.float64],
    chain: NDArray[np.int64],
    steps: Steps,
) -> NDArray[np.float64]:
    """Return the exact poses (M, 3) u, v, heading of a flood's chain from the start."""
    shift, after = steps[0][0], steps[1][0]
    poses = np.empty((len(chain), 3), np.float32)
    poses[0] = start
    for i, (k, move) in enumerate(zip(chain[:-1, 2], chain[1:, 3], strict=True)):
        poses[i + 1, :2] = poses[i, :2] + shift[k, move]
        poses[i + 1, 2] = after[k, move]
    return poses.astype(np.float64)
