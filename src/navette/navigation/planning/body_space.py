"""Reachability of the body: the proof that no path exists.

The configuration space of the body (Lozano-Pérez 1983) as one bit per heading and cell:
every obstacle closes the poses at which the body covers it, and a flood fill through
the open poses finds everything reachable. A search that exhausts its budget proves
nothing; a flood fill that does not reach the goal proves that no path exists. A flood
by the motions of a drive also has the path.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import ACKERMANN, OMNI, Footprint, Pose2
from navette.navigation.grids import GridSpec, make_outline, signed_distance

_HEADINGS = 64
_WITHIN = 5  # headings tried within one bin, its limits included
_MOST_POSES = 16_000_000  # of a flood by motions, at 12 bytes
_STRAIGHT = 1.5  # cells of a straight motion: it always leaves its cell

Masks = NDArray[np.uint64]


class BodySpace:
    """Poses of the body that no obstacle closes.

    Without a margin a cell is closed only if the body fits nowhere in it: cells that
    are not reached are certainly unreachable. With a margin the body is placed at the
    cell's centre with the middle heading of each bin: cells that are reached are
    certainly reachable.

    Args:
        lethal: (H, W) obstacles.
        spec: their geometry in the map frame.
        footprint: outline of the body.
        start: pose of the body in the map, always open; headings count from its own.
        margin_m: clearance that the body keeps, or None.
    """

    def __init__(
        self,
        lethal: NDArray[np.bool_],
        spec: GridSpec,
        footprint: Footprint,
        start: Pose2,
        *,
        margin_m: float | None = None,
    ) -> None:
        outline = make_outline(footprint)
        reach = int(np.ceil((outline.radius_m + (margin_m or 0.0)) / spec.resolution))
        stamp = np.zeros((2 * reach + 1, 2 * reach + 1), np.uint64)
        if margin_m is None:
            spread, least = np.pi / _HEADINGS, -spec.resolution * np.sqrt(0.5)
        else:
            spread, least = 0.0, margin_m
        _fill_stamp(
            stamp,
            outline.vertices,
            spec.resolution,
            spec.origin.yaw - start.yaw,
            spread,
            least,
        )
        closed = np.zeros((spec.height + 2 * reach, spec.width + 2 * reach), np.uint64)
        _close(closed, np.argwhere(lethal), np.ascontiguousarray(stamp[::-1, ::-1]))
        inner = slice(reach, -reach or None)
        self._open = np.ascontiguousarray(~closed[inner, inner])
        self._spec, self._start = spec, start
        self.start = spec.cell_of(start.x, start.y)
        self._open[self.start] = ~np.uint64(0)

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

    def driven(self, drive: str, radius_m: float) -> "DrivenPoses | None":
        """Return the poses that a drive reaches from the start.

        Moves are straight, forward and in reverse, and to the next heading: in place,
        or along an arc of the radius; an omnidirectional drive also slides. Of the
        poses in a cell and bin the first continues, from its exact position, as in
        hybrid A* (Dolgov et al. 2008). None: the poses are too many.
        """
        spec, size = self._spec, self._spec.resolution
        if drive == ACKERMANN:
            chord = 2 * radius_m * math.sin(math.pi / _HEADINGS) / size
            arcs = [(way * chord, turn) for way in (1, -1) for turn in (0, 1, -1)]
            moves = [(length, turn, 0.0) for length, turn in arcs]
        else:
            sides = (0.0, math.pi / 2) if drive == OMNI else (0.0,)
            ways = (_STRAIGHT, -_STRAIGHT)
            moves = [(way, 0, side) for side in sides for way in ways]
            moves += [(0.0, 1, 0.0), (0.0, -1, 0.0)]
        local = spec.origin.inverse() @ self._start
        reached = np.zeros_like(self._open)
        most = min(_HEADINGS * reached.size, _MOST_POSES)
        position, links = np.empty((most, 2), np.float32), np.empty(most, np.uint32)
        position[0], links[0] = (local.x / size, local.y / size), 0
        table = np.array(moves, np.float64)
        count = _drive(self._open, reached, position, links, table, local.yaw)
        if count < 0:
            return None
        return DrivenPoses(
            reached != 0, position[:count], links[:count], spec, self._start.yaw
        )


class DrivenPoses(NamedTuple):
    """Poses that a drive reaches from a start, by the number of moves.

    Attributes:
        cells: (H, W) where there is such a pose.
        position: (N, 2) u, v in cells.
        links: (N,) index of the pose before · number of headings + heading.
        spec: geometry of the cells in the map frame.
        yaw: heading 0 in the map frame, rad.
    """

    cells: NDArray[np.bool_]
    position: NDArray[np.float32]
    links: NDArray[np.uint32]
    spec: GridSpec
    yaw: float

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
        if not there.any():
            return None
        chain = [int(np.argmax(there))]
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


@kernel(allocates=False)
def _fill_stamp(
    stamp: Masks,
    vertices: NDArray[np.float64],
    size: float,
    grid_yaw: float,
    spread: float,
    least: float,
) -> None:
    """Set the bits of the headings at which the body covers each offset in cells."""
    edge = stamp.shape[0]
    for k in range(_HEADINGS):
        bit = np.uint64(1) << np.uint64(k)
        for i in range(edge):
            for j in range(edge):
                x, y = (j - edge // 2) * size, (i - edge // 2) * size
                covered = True
                for part in range(_WITHIN):
                    share = 2.0 * part / (_WITHIN - 1) - 1.0
                    yaw = 2 * np.pi * k / _HEADINGS - grid_yaw + share * spread
                    c, s = np.cos(yaw), np.sin(yaw)
                    away = signed_distance(vertices, c * x + s * y, c * y - s * x)
                    if away >= least:
                        covered = False
                        break
                if covered:
                    stamp[i, j] |= bit


@kernel(allocates=False)
def _close(closed: Masks, cells: NDArray[np.int64], stamp: Masks) -> None:
    edge = stamp.shape[0]
    for n in range(cells.shape[0]):
        row, column = cells[n, 0], cells[n, 1]
        for i in range(edge):
            line = closed[row + i, column : column + edge]
            for j in range(edge):
                line[j] |= stamp[i, j]


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


@kernel(allocates=False)
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


@kernel(allocates=False)
def _drive(
    open_: Masks, reached: Masks, position: Any, links: Any, moves: Any, yaw: float
) -> int:
    """Reach poses by moves (cells, headings, rad) from the first one, breadth first.

    Return the number of poses, −1 if there is no room for all. ``yaw`` is that of
    heading 0 relative to the grid.
    """
    height, width = open_.shape
    one, step = np.uint64(1), 2 * np.pi / _HEADINGS
    reached[int(position[0, 1]), int(position[0, 0])] = one
    done, count = 0, 1
    while done < count:
        u, v, k = position[done, 0], position[done, 1], int(links[done] % _HEADINGS)
        for m in range(moves.shape[0]):
            length, turn = moves[m, 0], int(moves[m, 1])
            along = yaw + (k + 0.5 * turn) * step + moves[m, 2]
            du, dv = length * math.cos(along), length * math.sin(along)
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
                return -1
            reached[row, column] |= bit
            position[count, 0], position[count, 1] = u + du, v + dv
            links[count] = done * _HEADINGS + heading
            count += 1
        done += 1
    return count
