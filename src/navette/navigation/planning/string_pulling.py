"""String pulling: straighten a chain of cells to a short line of any angle.

Greedy line-of-sight smoothing as in Thorpe 1984 and in Theta* (Nash et al. 2007), run
along the chain, backwards, and forwards again, with the line resampled to points about
a cell apart in between. The corners then lie where a taut string would turn. A straight
segment replaces a stretch only if it passes no closed cell, cuts no corner of one, and
costs no more than the stretch; its cost is integrated over the cells that it crosses.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.navigation.planning.traversal import STRAIGHT, EdgeTable

Points = NDArray[np.float64]

_PASSES = 3  # along the chain, backwards, and forwards again


def pull(
    cost: NDArray[np.uint8],
    points: Points,
    *,
    table: EdgeTable | None = None,
) -> Points:
    """Return points (M, 2) of a straighter line with the same ends.

    Args:
        cost: (H, W) cell costs; ``table`` maps them to edge costs.
        points: (N, 2) u, v of a passable line, in cells from the grid's outer
            corner: the centre of cell (row, column) is (column + 0.5, row + 0.5).
    """
    table = table or EdgeTable()
    factor = table.straight / STRAIGHT
    line = _checked(cost, points)
    for _ in range(_PASSES):
        # Reversed each time: a forward pass leaves slack at the far side.
        fine = _cut(line)
        kept = np.empty(len(fine), np.int64)
        count = _pull_once(cost, fine, factor, np.empty(len(fine)), kept)
        line = fine[kept[:count]][::-1]
    return np.ascontiguousarray(line[::-1])


def centers(cells: NDArray[np.int64]) -> Points:
    """Return the centres (N, 2) u, v of cells (N, 2) row, column."""
    return np.ascontiguousarray(cells[:, ::-1] + 0.5, np.float64)


def _checked(cost: NDArray[np.uint8], points: Points) -> Points:
    """Return the line as the kernels require it: one of inner points stays inside."""
    line = np.ascontiguousarray(points, np.float64)
    height, width = cost.shape
    inside = (line >= 0).all() and (line < (width, height)).all()
    if cost.dtype != np.uint8 or line.ndim != 2 or len(line) < 1 or not inside:
        raise InvalidValueError(
            f"line of shape {line.shape} on a {cost.dtype} grid of {height} x {width} "
            f"cells: expected (N, 2) points u, v inside a uint8 grid"
        )
    return line


def _cut(line: Points) -> Points:
    """Return the same line with points at most a cell and a half apart."""
    longest = math.ceil(float(np.abs(np.diff(line, axis=0)).sum()))
    fine = np.empty((longest + len(line), 2))
    return fine[: _cut_into(line, fine)]


@kernel(allocates=False)
def _cut_into(line: Any, fine: Any) -> int:
    """Fill ``fine`` with the points of :func:`_cut`; return their number."""
    last, filled = line.shape[0] - 1, 0
    for i in range(last):
        du, dv = line[i + 1, 0] - line[i, 0], line[i + 1, 1] - line[i, 1]
        count = max(1, math.ceil(math.hypot(du, dv) - 0.5))
        for k in range(count):
            part = k / count
            fine[filled, 0] = line[i, 0] + part * du
            fine[filled, 1] = line[i, 1] + part * dv
            filled += 1
    fine[filled, 0], fine[filled, 1] = line[last, 0], line[last, 1]
    return filled + 1


@kernel(allocates=False)
def _pull_once(cost: Any, fine: Any, factor: Any, paid: Any, kept: Any) -> int:
    """Fill ``kept`` with as few of the points as possible; return their number.

    ``paid`` (N,) becomes the cost from the first point to each.
    """
    n = fine.shape[0]
    paid[0], kept[0] = 0.0, 0
    for i in range(n - 1):
        paid[i + 1] = paid[i] + segment_cost(
            cost, fine[i, 0], fine[i, 1], fine[i + 1, 0], fine[i + 1, 1], factor
        )
    count = 1
    while kept[count - 1] < n - 1:
        kept[count] = _furthest(cost, fine, paid, kept[count - 1], factor)
        count += 1
    return count


@kernel(allocates=False)
def _furthest(cost: Any, fine: Any, paid: Any, anchor: int, factor: Any) -> int:
    """Return the furthest point of a straight segment by doubling, then bisection."""
    last = fine.shape[0] - 1
    good, step = anchor + 1, 1
    bad = last + 1
    while good < last:
        tried = anchor + 2 * step
        tried = tried if tried < last else last
        if not _shorter(cost, fine, paid, anchor, tried, factor):
            bad = tried
            break
        good, step = tried, 2 * step
    while bad - good > 1 and good < last:
        tried = (good + bad) // 2
        if _shorter(cost, fine, paid, anchor, tried, factor):
            good = tried
        else:
            bad = tried
    return good


@kernel(allocates=False)
def _shorter(
    cost: Any, fine: Any, paid: Any, anchor: int, reached: int, factor: Any
) -> bool:
    straight = segment_cost(
        cost,
        fine[anchor, 0],
        fine[anchor, 1],
        fine[reached, 0],
        fine[reached, 1],
        factor,
    )
    return bool(straight <= (paid[reached] - paid[anchor]) * (1.0 + 1e-9))


@kernel(allocates=False)
def segment_cost(
    cost: Any, u0: float, v0: float, u1: float, v1: float, factor: Any
) -> float:
    """Integrate the factor along a segment (Amanatides and Woo 1987); inf = closed.

    A segment through a corner needs both cells beside the corner free.
    """
    du, dv = u1 - u0, v1 - v0
    length = math.hypot(du, dv)
    column, row = int(u0), int(v0)
    step_u, step_v = (1 if du > 0 else -1), (1 if dv > 0 else -1)
    per_u = abs(1.0 / du) if du != 0.0 else np.inf
    per_v = abs(1.0 / dv) if dv != 0.0 else np.inf
    next_u = per_u * (column + (du > 0) - u0) * step_u if du != 0.0 else np.inf
    next_v = per_v * (row + (dv > 0) - v0) * step_v if dv != 0.0 else np.inf
    total, t = 0.0, 0.0
    while True:
        each = factor[cost[np.uint64(row), np.uint64(column)]]
        if each == 0.0:
            return np.inf
        until = next_u if next_u < next_v else next_v
        if until >= 1.0:
            return float(total + (1.0 - t) * length * each)
        total += (until - t) * length * each
        t = until
        if abs(next_u - next_v) * length < 1e-9:
            if (
                factor[cost[row + step_v, column]] == 0.0
                or factor[cost[row, column + step_u]] == 0.0
            ):
                return np.inf
            column, row = column + step_u, row + step_v
            next_u, next_v = next_u + per_u, next_v + per_v
        elif next_u < next_v:
            column, next_u = column + step_u, next_u + per_u
        else:
            row, next_v = row + step_v, next_v + per_v
