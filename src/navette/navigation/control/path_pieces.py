"""Split a path with headings into pieces: drive forward, drive back, turn in place.

A pose whose heading opposes the travel means reverse; equal position with another
heading means a turn in place. Corners too sharp to be rounded become turns as well.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import angle_difference, wrap_angle
from navette.navigation.control.path_shape import (
    Points,
    resample,
    round_corners,
    simplify,
    split_at,
    turn_angles,
)
from navette.navigation.control.records import FARTHEST_M

SAMPLE_M = 0.05  # spacing of the points on a piece
_LONGEST_M = 1e5
_STEP_LEG_M = 0.25
_STEP_ANGLE_RAD = 0.6  # less than the 45° of an 8-connected step
_SAME_PLACE_M = 0.005
_SIMPLIFY_M = 0.01  # well below a cell: keeps arcs, drops the points between corners


@dataclass(frozen=True)
class DrivePiece:
    """A stretch driven without stopping, sampled every :data:`SAMPLE_M` or less.

    Lists, not arrays: each tick reads a few dozen single values.
    """

    direction: int  # +1 forward, −1 reverse
    x: list[float]  # m, map
    y: list[float]
    s: list[float]  # arc length, m
    heading: list[float]  # direction of travel, rad, map
    curvature: list[float]  # 1/m, left positive, seen along the travel
    winding: list[float]  # sum of |change of heading| since the start, rad

    @property
    def length(self) -> float:
        return self.s[-1]

    def index_at(self, s: float) -> int:
        """Index of the sample at or before arc length ``s``."""
        last = len(self.s) - 1
        return min(last, max(0, int(s / self.s[-1] * last)))

    def point_at(self, s: float) -> tuple[float, float]:
        """Point (m, map) at arc length ``s``; past the end straight on."""
        i = min(self.index_at(s), len(self.s) - 2)
        t = s - self.s[i]
        c, d = math.cos(self.heading[i]), math.sin(self.heading[i])
        return self.x[i] + t * c, self.y[i] + t * d


@dataclass(frozen=True)
class TurnPiece:
    """A turn in place to ``yaw`` (rad, map); ``turn`` is the way planned, signed."""

    yaw: float
    turn: float


Piece = DrivePiece | TurnPiece


def split_path(
    poses: NDArray[np.float64], *, tolerance: float, sharp: float
) -> list[Piece]:
    """Path poses (N, 3) x, y, yaw (m, rad, map) → pieces in driving order.

    Corners up to ``sharp`` rad are rounded within ``tolerance`` metres, sharper ones
    are turned in place.

    Raises:
        InvalidValueError: not (N, 3) or not finite.
    """
    _check(poses)
    pieces: list[Piece] = []
    for run in _runs(poses, _directions(poses)):
        if isinstance(run, TurnPiece):
            pieces.append(run)
        else:
            direction, points = run
            pieces += _drive(points, direction, tolerance, sharp)
    return pieces


def _check(poses: NDArray[np.float64]) -> None:
    if poses.ndim != 2 or poses.shape[1] != 3 or not np.all(np.isfinite(poses)):
        raise InvalidValueError(
            f"path of shape {poses.shape}: wanted finite poses (N, 3) x, y, yaw"
        )
    span = float(np.abs(np.diff(poses[:, :2], axis=0)).sum())
    if np.abs(poses[:, :2]).max(initial=0.0) > FARTHEST_M or span > _LONGEST_M:
        raise InvalidValueError(
            f"path of {span:g} m: wanted at most {_LONGEST_M:g} m, "
            f"coordinates up to ±{FARTHEST_M:g} m"
        )


def _directions(poses: NDArray[np.float64]) -> list[int]:
    """Of each step between poses: +1 forward, −1 reverse, 0 turn in place."""
    steps = np.diff(poses[:, :2], axis=0)
    moves = np.hypot(steps[:, 0], steps[:, 1]) > _SAME_PLACE_M
    travel = np.arctan2(steps[:, 1], steps[:, 0])
    along = np.cos(travel - poses[:-1, 2])
    agreement = np.maximum(np.abs(along), np.abs(np.cos(travel - poses[1:, 2])))
    if np.any(agreement[moves] < 0.5):
        # Headings across the travel: the sender left them out (all zero, say), so
        # they cannot mean reverse either.
        along = np.ones_like(along)
        return [int(m) for m in moves]
    both = along + np.cos(travel - poses[1:, 2])
    return [
        0 if not m else (1 if b >= 0 else -1) for m, b in zip(moves, both, strict=True)
    ]


def _runs(
    poses: NDArray[np.float64], directions: list[int]
) -> list[TurnPiece | tuple[int, Points]]:
    """Consecutive steps of one direction together, turns summed up."""
    runs: list[TurnPiece | tuple[int, Points]] = []
    start = 0
    for i in range(1, len(directions) + 1):
        if i < len(directions) and directions[i] == directions[start]:
            continue
        part = poses[start : i + 1]
        if directions and directions[start] == 0:
            turn = sum(
                angle_difference(float(b), float(a))
                for a, b in zip(part[:-1, 2], part[1:, 2], strict=True)
            )
            if abs(turn) > 1e-3:
                runs.append(TurnPiece(wrap_angle(float(part[-1, 2])), turn))
        elif directions:
            runs.append((directions[start], part[:, :2]))
        start = i
    return runs


def _drive(
    points: Points, direction: int, tolerance: float, sharp: float
) -> list[Piece]:
    """One run of one direction: drive pieces with turns at its sharp corners."""
    corners = simplify(points, _SIMPLIFY_M)
    if _has_steps(corners):
        corners = simplify(points, 2 * tolerance)
    angles = turn_angles(corners)
    pieces: list[Piece] = []
    for part in split_at(corners, np.abs(angles) > sharp):
        piece = sample_piece(round_corners(part, tolerance), direction)
        if pieces:
            before = pieces[-1]
            assert isinstance(before, DrivePiece), "turns only stand between drives"
            turn = angle_difference(piece.heading[0], before.heading[-1])
            facing = piece.heading[0] + (math.pi if direction < 0 else 0.0)
            pieces.append(TurnPiece(wrap_angle(facing), turn))
        pieces.append(piece)
    return pieces


def _has_steps(corners: Points) -> bool:
    """Whether the way points go from cell to cell, as a raw grid search gives them.

    Rounding each step of such a stair would be a crawl, turning at each a standstill.
    """
    legs = np.hypot(*np.diff(corners, axis=0).T)
    short = np.minimum(legs[:-1], legs[1:]) < _STEP_LEG_M
    return bool(np.any(short & (np.abs(turn_angles(corners)) > _STEP_ANGLE_RAD)))


def sample_piece(points: Points, direction: int) -> DrivePiece:
    """Polyline (M, 2), metres → evenly sampled piece with heading and curvature."""
    xy, s = resample(points, SAMPLE_M)
    change = turn_angles(xy)
    steps = np.diff(xy, axis=0)
    heading = np.arctan2(steps[:, 1], steps[:, 0])
    heading = np.append(heading, heading[-1])
    curvature = np.zeros(len(s))
    curvature[1:-1] = change / (s[1] - s[0])
    # Where an arc begins between two samples the change of heading is uneven.
    curvature[1:-1] = (curvature[:-2] + 2 * curvature[1:-1] + curvature[2:]) / 4
    winding = np.concatenate(([0.0], np.cumsum(np.abs(change)), [0.0]))
    winding[-1] = winding[-2]
    return DrivePiece(
        direction=direction,
        x=xy[:, 0].tolist(),
        y=xy[:, 1].tolist(),
        s=s.tolist(),
        heading=heading.tolist(),
        curvature=curvature.tolist(),
        winding=winding.tolist(),
    )
