"""Split a path with headings into pieces: drive forward, reverse, turn in place.

A heading opposite to the direction of travel means reverse. Poses at one position with
different headings mean a turn in place. Corners too sharp to be rounded become turns.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import angle_difference, wrap_angle
from navette.navigation.control.params import ControlParams
from navette.navigation.control.polyline import (
    Points,
    resample,
    round_corners,
    simplify,
    split_at,
    turn_angles,
)
from navette.navigation.control.records import check_poses

SAMPLE_M = 0.05  # spacing of the points on a piece
_LONGEST_M = 1e5
_STEP_LEG_M = 0.25
_STEP_ANGLE_RAD = 0.6  # less than the 45° of an 8-connected step
_SAME_PLACE_M = 0.005
_SIMPLIFY_M = 0.01  # well below a cell: keeps arcs, drops points between corners


@dataclass(frozen=True)
class DrivePiece:
    """A stretch driven without stopping, sampled every :data:`SAMPLE_M` or less.

    Lists, not arrays: each step reads a few dozen single values.
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
        """Return the index of the sample at or before arc length ``s``."""
        last = len(self.s) - 1
        return min(last, max(0, int(s / self.s[-1] * last)))

    def point_at(self, s: float) -> tuple[float, float]:
        """Return the point (m, map) at arc length ``s``, extended beyond the end."""
        i = min(self.index_at(s), len(self.s) - 2)
        t = s - self.s[i]
        c, d = math.cos(self.heading[i]), math.sin(self.heading[i])
        return self.x[i] + t * c, self.y[i] + t * d


@dataclass(frozen=True)
class TurnPiece:
    """A turn in place to ``yaw`` (rad, map); ``turn`` is the planned, signed angle."""

    yaw: float
    turn: float


Piece = DrivePiece | TurnPiece


def split_path(poses: NDArray[np.float64], params: ControlParams) -> list[Piece]:
    """Split path poses (N, 3) x, y, yaw (m, rad, map) into pieces in driving order.

    Corners up to ``corner_rotate_rad`` are rounded within ``path_tolerance_m``; the
    robot turns in place at sharper ones.

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
            pieces += _drive(points, direction, params)
    return pieces


def _check(poses: NDArray[np.float64]) -> None:
    check_poses(poses)
    span = float(np.abs(np.diff(poses[:, :2], axis=0)).sum())
    if span > _LONGEST_M:
        raise InvalidValueError(f"path of {span:g} m: must be at most {_LONGEST_M:g} m")


def _directions(poses: NDArray[np.float64]) -> list[int]:
    """Return for each step between poses: +1 forward, −1 reverse, 0 turn in place."""
    steps = np.diff(poses[:, :2], axis=0)
    moves = np.hypot(steps[:, 0], steps[:, 1]) > _SAME_PLACE_M
    travel = np.arctan2(steps[:, 1], steps[:, 0])
    along = np.cos(travel - poses[:-1, 2])
    agreement = np.maximum(np.abs(along), np.abs(np.cos(travel - poses[1:, 2])))
    if np.any(agreement[moves] < 0.5):
        # Headings across the travel: the publisher did not set them (all are zero,
        # for example), so they cannot mean reverse either.
        along = np.ones_like(along)
        return [int(m) for m in moves]
    both = along + np.cos(travel - poses[1:, 2])
    return [
        0 if not m else (1 if b >= 0 else -1) for m, b in zip(moves, both, strict=True)
    ]


def _runs(
    poses: NDArray[np.float64], directions: list[int]
) -> list[TurnPiece | tuple[int, Points]]:
    """Group consecutive steps of one direction; sum up turns."""
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


def _drive(points: Points, direction: int, params: ControlParams) -> list[Piece]:
    """Return drive pieces of one direction, with turns at the sharp corners."""
    tolerance = params.path_tolerance_m
    corners = simplify(points, _SIMPLIFY_M)
    if _has_steps(corners):
        corners = simplify(points, 2 * tolerance)
    angles = turn_angles(corners)
    pieces: list[Piece] = []
    for part in split_at(corners, np.abs(angles) > params.corner_rotate_rad):
        piece = sample_piece(round_corners(part, tolerance), direction)
        if pieces:
            before = pieces[-1]
            assert isinstance(before, DrivePiece), "turns occur between drives only"
            turn = angle_difference(piece.heading[0], before.heading[-1])
            facing = piece.heading[0] + (math.pi if direction < 0 else 0.0)
            pieces.append(TurnPiece(wrap_angle(facing), turn))
        pieces.append(piece)
    return pieces


def _has_steps(corners: Points) -> bool:
    """Return whether the waypoints step from cell to cell, as from a raw grid search.

    Rounding each step of such a staircase is slow; turning at each means stopping.
    """
    legs = np.hypot(*np.diff(corners, axis=0).T)
    short = np.minimum(legs[:-1], legs[1:]) < _STEP_LEG_M
    return bool(np.any(short & (np.abs(turn_angles(corners)) > _STEP_ANGLE_RAD)))


def sample_piece(points: Points, direction: int) -> DrivePiece:
    """Sample a polyline (M, 2), metres, evenly; add heading and curvature."""
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
