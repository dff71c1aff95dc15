"""Reachability of the body: the proof that no path exists.

The configuration space of the body (Lozano-Pérez 1983) as one bit per heading and cell:
every obstacle closes the poses at which the body covers it, and a flood fill through
the open poses finds everything reachable. A search that exhausts its budget proves
nothing; a flood fill that does not reach the goal proves that no path exists. A flood
by the motions of a drive also has the path.
"""

import functools
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import ACKERMANN, OMNI, Footprint, Pose2
from navette.navigation.grids import (
    GridFrame,
    GridSpec,
    grid_frame,
    make_outline,
    signed_distance,
)

_HEADINGS = 64
HEADING_STEP = math.tau / _HEADINGS
_WITHIN = 5  # headings tried within one bin, its limits included
_MOST_POSES = 16_000_000  # of a flood by motions, at 12 bytes
_STRAIGHT = 1.5  # cells of a straight motion: it always leaves its cell

Masks = NDArray[np.uint64]


class OpenPoses(NamedTuple):
    """Poses for kernels: a bit per heading, counted from the x axis of the map.

    Attributes:
        masks: (H, W) headings at which the body may be in each cell, or empty.
        frame: of the cells.
    """

    masks: Masks
    frame: GridFrame


ALL_POSES = OpenPoses(np.empty((0, 0), np.uint64), grid_frame(GridSpec(1.0, 1, 1)))


class BodySpace:
    """Poses of the body that no obstacle closes.

    Made by :meth:`possible` or :meth:`certain`; the start is open in both.
    """

    def __init__(
        self,
        lethal: NDArray[np.bool_],
        spec: GridSpec,
        start: Pose2,
        stamp: Masks,
        yaw: float,
    ) -> None:
        reach = stamp.shape[0] // 2
        closed = np.zeros((spec.height + 2 * reach, spec.width + 2 * reach), np.uint64)
        _close(closed, np.argwhere(lethal), stamp)
        inner = slice(reach, -reach or None)
        self._open = np.ascontiguousarray(~closed[inner, inner])
        self._spec, self._start, self._yaw = spec, start, yaw
        self.start = spec.cell_of(start.x, start.y)
        self._open[self.start] = ~np.uint64(0)

    @classmethod
    def possible(
        cls,
        lethal: NDArray[np.bool_],
        spec: GridSpec,
        footprint: Footprint,
        start: Pose2,
        margin_m: float = 0.0,
    ) -> "BodySpace":
        """Return the poses with a margin; what they do not reach is unreachable.

        A cell is closed only if the body fits nowhere in it: with the margin to
        obstacles anywhere in their cells, and without touching their centres.

        Args:
            lethal: (H, W) obstacles.
            spec: their geometry in the map frame.
            footprint: outline of the body.
            start: pose of the body in the map.
            margin_m: clearance that the body keeps.
        """
        half = math.sqrt(0.5) * spec.resolution
        least = max(margin_m - 2 * half, -half)
        spread, yaw = math.pi / _HEADINGS, spec.origin.yaw
        stamp = _stamp(footprint, spec.resolution, yaw, spread, least)
        return cls(lethal, spec, start, stamp, 0.0)

    @classmethod
    def certain(
        cls,
        lethal: NDArray[np.bool_],
        spec: GridSpec,
        footprint: Footprint,
        start: Pose2,
        margin_m: float = 0.0,
        *,
        yaw: float = 0.0,
    ) -> "BodySpace":
        """Return the poses with a margin; what they reach is certainly reachable.

        The body is at the centre of its cell with the middle heading of its bin;
        headings count from ``yaw`` (map). Other arguments as of :meth:`possible`.
        """
        stamp = _stamp(footprint, spec.resolution, spec.origin.yaw - yaw, 0.0, margin_m)
        return cls(lethal, spec, start, stamp, yaw)

    @property
    def poses(self) -> OpenPoses:
        """The open poses; headings count from 0."""
        return OpenPoses(self._open, grid_frame(self._spec))

    def has_room(self) -> NDArray[np.bool_]:
        """Return (H, W) the cells in which all headings are open."""
        return np.asarray(self._open == ~np.uint64(0))

    def close(self, cells: NDArray[np.bool_]) -> None:
        """Close cells (H, W) for the base."""
        self._open[cells] = 0

    def open_near_start(self, other: "BodySpace", reach_m: float) -> None:
        """Open what is open in another space of the same cells near the start."""
        reach = math.ceil(reach_m / self._spec.resolution)
        row, column = self.start
        near = (
            slice(max(0, row - reach), row + reach + 1),
            slice(max(0, column - reach), column + reach + 1),
        )
        self._open[near] |= other._open[near]

    def reached_from(self, cells: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Return (H, W) the cells that the body reaches from any of cells (N, 2)."""
        reached = np.zeros_like(self._open)
        stack = np.empty(4 * reached.size + len(cells) + 16, np.int64)
        _flood(self._open, reached, np.ascontiguousarray(cells, np.int64), stack)
        return np.asarray(reached != 0)

    def driven(
        self, drive: str, radius_m: float, until: Masks = ALL_POSES.masks
    ) -> "DrivenPoses":
        """Return the poses that a drive reaches from the start with heading 0.

        Moves are straight, forward and in reverse, and to the next heading: in place,
        or along an arc of the radius; an omnidirectional drive also slides. Of the
        poses in a cell and bin the first continues, from its exact position, as in
        hybrid A* (Dolgov et al. 2008). The first pose of ``until`` (H, W) is the last.
        """
        spec, size = self._spec, self._spec.resolution
        first = Pose2(self._start.x, self._start.y, self._yaw)
        local = spec.origin.inverse() @ first
        reached = np.zeros_like(self._open)
        most = min(_HEADINGS * reached.size, _MOST_POSES)
        position, links = np.empty((most, 2), np.float32), np.empty(most, np.uint32)
        position[0], links[0] = (local.x / size, local.y / size), 0
        moves = _moves(drive, radius_m / size, local.yaw)
        count, stopped, complete = _drive(
            self._open, reached, position, links, moves, until
        )
        return DrivenPoses(
            reached != 0,
            position[:count],
            links[:count],
            spec,
            self._yaw,
            bool(stopped),
            bool(complete),
        )

    def at_yaw(
        self, cells: NDArray[np.int64], yaw: float | None, tolerance_rad: float
    ) -> Masks:
        """Return (H, W) the headings in cells (N, 2) within the tolerance of a yaw.

        At least the nearest one; all with None.
        """
        masks = np.zeros_like(self._open)
        headings = np.arange(_HEADINGS)
        if yaw is not None:
            yaws = self._yaw + headings.astype(np.float64) * HEADING_STEP
            off = _wrapped(yaws - yaw)
            within = max(tolerance_rad, HEADING_STEP / 2 + 1e-9)
            headings = headings[np.abs(off) <= within]
        bits = np.uint64(1) << headings.astype(np.uint64)
        masks[tuple(cells.T)] = np.bitwise_or.reduce(bits)
        return masks


def _moves(drive: str, radius: float, yaw: float) -> NDArray[np.float64]:
    """Return (headings, M, 3) the moves of a drive: du, dv in cells, headings.

    Args:
        drive: kind of the drive.
        radius: least turning radius of a car, in cells.
        yaw: of heading 0 relative to the grid.
    """
    if drive == ACKERMANN:
        chord = 2 * radius * math.sin(HEADING_STEP / 2)
        arcs = [(way * chord, turn) for way in (1, -1) for turn in (0, 1, -1)]
        moves = [(length, turn, 0.0) for length, turn in arcs]
    else:
        sides = (0.0, math.pi / 2) if drive == OMNI else (0.0,)
        moves = [(way, 0, side) for side in sides for way in (_STRAIGHT, -_STRAIGHT)]
        moves += [(0.0, 1, 0.0), (0.0, -1, 0.0)]
    length, turn, side = np.array(moves, np.float64).T
    headings = np.arange(_HEADINGS)[:, None]
    along = yaw + (headings + 0.5 * turn) * HEADING_STEP + side
    turns = np.broadcast_to(turn, along.shape)
    return np.stack([length * np.cos(along), length * np.sin(along), turns], -1)


class DrivenPoses(NamedTuple):
    """Poses that a drive reaches from a start, by the number of moves.

    Attributes:
        cells: (H, W) where there is such a pose.
        position: (N, 2) u, v in cells.
        links: (N,) index of the pose before · number of headings + heading.
        spec: geometry of the cells in the map frame.
        yaw: heading 0 in the map frame, rad.
        stopped: whether the last one is where the drive was to stop.
        complete: whether these are all, or up to that one; False: they are too many.
    """

    cells: NDArray[np.bool_]
    position: NDArray[np.float32]
    links: NDArray[np.uint32]
    spec: GridSpec
    yaw: float
    stopped: bool
    complete: bool

    def path_to(
        self,
        cells: NDArray[np.int64],
        yaw: float | None = None,
        tolerance_rad: float = 0.0,
    ) -> NDArray[np.float64] | None:
        """Return poses (M, 3) of the fewest moves to one of cells (N, 2), or None.

        With a yaw (map) the last heading is within the tolerance of it, or the nearest.
        """
        wanted = np.zeros_like(self.cells)
        wanted[tuple(cells.T)] = True
        # Rounded up, a position may be the edge of the grid.
        last = np.array(wanted.shape) - 1
        cell = np.minimum(self.position[:, ::-1].astype(np.int64), last)
        there = wanted[tuple(cell.T)]
        if yaw is not None:
            within = max(tolerance_rad, math.pi / _HEADINGS + 1e-9)
            there &= np.abs(_wrapped(self._yaws(self.links) - yaw)) <= within
        return self._path(int(np.argmax(there))) if there.any() else None

    def last_path(self) -> NDArray[np.float64]:
        """Return poses (M, 3) of the fewest moves to the last pose."""
        return self._path(len(self.links) - 1)

    def _path(self, last: int) -> NDArray[np.float64]:
        chain = [last]
        while chain[-1]:
            chain.append(int(self.links[chain[-1]]) // _HEADINGS)
        chain.reverse()
        uv = self.position[chain].astype(np.float64)
        xy = self.spec.origin.apply(uv * self.spec.resolution)
        return np.column_stack([xy, _wrapped(self._yaws(self.links[chain]))])

    def _yaws(self, links: NDArray[np.uint32]) -> NDArray[np.float64]:
        headings = (links % _HEADINGS).astype(np.float64)
        return self.yaw + headings * (math.tau / _HEADINGS)


def _wrapped(yaw: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.remainder(yaw + math.pi, math.tau) - math.pi)


@functools.lru_cache(maxsize=64)
def _stamp(
    footprint: Footprint, size: float, grid_yaw: float, spread: float, least: float
) -> Masks:
    """Return the headings that an obstacle closes at each offset of the body in cells.

    Args:
        footprint: outline of the body.
        size: edge of a cell, m.
        grid_yaw: of the grid relative to heading 0.
        spread: a heading is closed if the body is too near with each one this near.
        least: distance from which the obstacle is not too near, m.
    """
    outline = make_outline(footprint)
    reach = max(0, math.ceil((outline.radius_m + least) / size))
    stamp = np.zeros((2 * reach + 1, 2 * reach + 1), np.uint64)
    shares = np.linspace(-1.0, 1.0, _WITHIN) if spread else np.zeros(1)
    yaws = np.arange(_HEADINGS)[:, None] * HEADING_STEP - grid_yaw + shares * spread
    turns = np.stack([np.cos(yaws), np.sin(yaws)], axis=-1)
    radii = footprint.inscribed_radius, outline.radius_m
    _fill_stamp(stamp, outline.vertices, radii, size, turns, least)
    return np.ascontiguousarray(stamp[::-1, ::-1])


@kernel
def _fill_stamp(
    stamp: Masks,
    vertices: NDArray[np.float64],
    radii: tuple[float, float],
    size: float,
    turns: NDArray[np.float64],
    least: float,
) -> None:
    """Set the bits of the headings at which the body is too near to each offset.

    ``turns`` (headings, N, 2) cos, sin: the body is too near at each of the N.
    """
    edge = stamp.shape[0]
    for i in range(edge):
        for j in range(edge):
            x, y = (j - edge // 2) * size, (i - edge // 2) * size
            away = math.hypot(x, y)
            if away - radii[1] >= least:
                continue
            if away - radii[0] < least:
                stamp[i, j] = ~np.uint64(0)
                continue
            for k in range(turns.shape[0]):
                if _is_near(vertices, x, y, turns[k], least):
                    stamp[i, j] |= np.uint64(1) << np.uint64(k)


@kernel
def _is_near(
    vertices: NDArray[np.float64],
    x: float,
    y: float,
    turns: NDArray[np.float64],
    least: float,
) -> bool:
    """Return whether (x, y) is too near to the body at each of its turns."""
    for part in range(turns.shape[0]):
        c, s = turns[part, 0], turns[part, 1]
        if signed_distance(vertices, c * x + s * y, c * y - s * x) >= least:
            return False
    return True


@kernel
def _close(closed: Masks, cells: NDArray[np.int64], stamp: Masks) -> None:
    edge = stamp.shape[0]
    for n in range(cells.shape[0]):
        row, column = cells[n, 0], cells[n, 1]
        for i in range(edge):
            line = closed[row + i, column : column + edge]
            for j in range(edge):
                line[j] |= stamp[i, j]


@kernel
def is_closed(poses: Any, x: float, y: float, yaw: float) -> bool:
    """Return whether a pose (map) is known not to be among open poses."""
    frame = poses.frame
    dx, dy = x - frame.x, y - frame.y
    u = (frame.cos * dx + frame.sin * dy) / frame.resolution
    v = (frame.cos * dy - frame.sin * dx) / frame.resolution
    height, width = poses.masks.shape
    if not (0.0 <= u < width and 0.0 <= v < height):
        return False
    heading = np.uint64(math.floor(yaw * _HEADINGS / (2 * np.pi) + 0.5) % _HEADINGS)
    return bool((poses.masks[int(v), int(u)] >> heading) & np.uint64(1) == 0)


@kernel
def _flood(open_: Masks, reached: Masks, cells: NDArray[np.int64], stack: Any) -> None:
    """Reach neighbouring cells with the same heading, and neighbouring headings."""
    height, width = open_.shape
    count = cells.shape[0]
    for n in range(count):
        row, column = cells[n, 0], cells[n, 1]
        reached[row, column] = open_[row, column]
        stack[n] = row * width + column
    while count > 0:
        count -= 1
        row, column = stack[count] // width, stack[count] % width
        here = reached[row, column]
        for i in range(max(0, row - 1), min(height, row + 2)):
            for j in range(max(0, column - 1), min(width, column + 2)):
                new = here & open_[i, j] & ~reached[i, j]
                if new == 0:
                    continue
                reached[i, j] = _turned(reached[i, j] | new, open_[i, j])
                if count < stack.size:
                    stack[count] = i * width + j
                    count += 1


@kernel
def _turned(mask: np.uint64, open_: np.uint64) -> np.uint64:
    """Return the headings that turning in place reaches from those of a mask."""
    one, last = np.uint64(1), np.uint64(_HEADINGS - 1)
    while True:
        left = (mask << one) | (mask >> last)
        right = (mask >> one) | (mask << last)
        more = (mask | left | right) & open_
        if more == mask:
            return mask
        mask = more


@kernel
def _drive(
    open_: Masks, reached: Masks, position: Any, links: Any, moves: Any, until: Masks
) -> tuple[int, bool, bool]:
    """Reach poses by moves of each heading from the first pose, breadth first.

    Return the number of poses, whether the last is one of ``until``, and whether these
    are all up to that one.
    """
    height, width = open_.shape
    one = np.uint64(1)
    first_row, first_column = int(position[0, 1]), int(position[0, 0])
    reached[first_row, first_column] = one
    done, count = 0, 1
    if until.size and until[first_row, first_column] & one:
        return count, True, True
    while done < count:
        u, v, k = position[done, 0], position[done, 1], int(links[done] % _HEADINGS)
        for m in range(moves.shape[1]):
            du, dv, turn = moves[k, m, 0], moves[k, m, 1], int(moves[k, m, 2])
            if not (0.0 <= u + du < width and 0.0 <= v + dv < height):
                continue
            row, column = int(v + dv), int(u + du)
            heading = (k + turn) % _HEADINGS
            bit = one << np.uint64(heading)
            if reached[row, column] & bit or not open_[row, column] & bit:
                continue
            middle = open_[int(v + 0.5 * dv), int(u + 0.5 * du)]
            if not (middle & (bit | one << np.uint64(k))):
                continue
            if count == links.size:
                return count, False, False
            reached[row, column] |= bit
            position[count, 0], position[count, 1] = u + du, v + dv
            links[count] = done * _HEADINGS + heading
            count += 1
            if until.size and until[row, column] & bit:
                return count, True, True
        done += 1
    return count, False, True
