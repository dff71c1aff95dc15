"""Pruning of neighbours that a grid search reaches by another path for no more.

Of the paths from a cell's predecessor to a cell's neighbour, one may lead past the cell
and cost less; of two that cost the same, the one with the diagonal move first is kept.
On a uniform grid these are the pruning rules of jump point search (Harabor and Grastien
2011). Costs make them conditions, which are checked exactly.

Moves are numbered around the cell, from row − 1 clockwise: even ones are straight, odd
ones diagonal, and the move opposite of k is (k + 4) mod 8.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel

_ROWS = np.array([-1, -1, 0, 1, 1, 1, 0, -1])
_COLUMNS = np.array([0, 1, 1, 1, 0, -1, -1, -1])


def steps_around(stride: int) -> NDArray[np.int64]:
    """Return (8,) what each move adds to row * stride + column."""
    return np.asarray(_ROWS * stride + _COLUMNS, np.int64)


@kernel(allocates=False, forceinline=True)
def successors(grid: Any, steps: Any, index: int, move: int, offers: Any) -> int:
    """Write the neighbours to offer as (move, cost of the edge); return how many.

    Args:
        grid: the :class:`~.traversal.SearchGrid`.
        steps: (8,) what a move adds to an index.
        index: the cell.
        move: the last one of the path to the cell.
        offers: (8, 2) for the result; the most promising one comes last.
    """
    if move & 1:
        return _after_diagonal(grid, steps, index, move, offers)
    return _after_straight(grid, steps, index, move, offers)


@kernel(allocates=False, forceinline=True)
def all_neighbours(grid: Any, steps: Any, index: int, offers: Any) -> int:
    """Write all neighbours of a cell, as :func:`successors` does."""
    cost, _, straight, diagonal = grid
    count = 0
    for k in range(8):
        there = _cost(cost, steps, index, k)
        edge = diagonal[there] if k & 1 else straight[there]
        if k & 1 and (
            straight[_cost(cost, steps, index, k - 1)] == 0
            or straight[_cost(cost, steps, index, k + 1)] == 0
        ):
            continue
        if edge != 0:
            count = _add(offers, count, k, edge)
    return count


@kernel(allocates=False, forceinline=True)
def _after_straight(grid: Any, steps: Any, index: int, move: int, offers: Any) -> int:
    """Cells beside and obliquely ahead are reached by a diagonal move before."""
    cost, _, straight, diagonal = grid
    here = cost[np.uint64(index)]
    onward = straight[_cost(cost, steps, index, move)]
    count = 0
    if not _is_level(cost, steps, index, move):
        enter = straight[here]
        for side in range(-1, 2, 2):
            beside = _cost(cost, steps, index, move + 2 * side)
            oblique = _cost(cost, steps, index, move + side)
            if straight[beside] == 0:
                continue
            is_met = straight[_cost(cost, steps, index, move + 3 * side)] != 0
            past = diagonal[beside]
            if not (is_met and past < enter + straight[beside]):
                count = _add(offers, count, move + 2 * side, straight[beside])
            if onward == 0 or diagonal[oblique] == 0:
                continue
            if not (is_met and past + straight[oblique] <= enter + diagonal[oblique]):
                count = _add(offers, count, move + side, diagonal[oblique])
    if onward != 0:
        count = _add(offers, count, move, onward)
    return count


@kernel(allocates=False, forceinline=True)
def _after_diagonal(grid: Any, steps: Any, index: int, move: int, offers: Any) -> int:
    """Cells across, and straight ones where that costs less, are reached past a corner.

    The corners, beside which the move led, are open.
    """
    cost, _, straight, diagonal = grid
    enter = diagonal[cost[np.uint64(index)]]
    level = _is_level(cost, steps, index, move)
    count, open_sides = 0, 0
    for side in range(-1, 2, 2):
        ahead = _cost(cost, steps, index, move + side)
        if straight[ahead] == 0:
            continue
        open_sides += 1
        if level:
            count = _add(offers, count, move + side, straight[ahead])
            continue
        past = straight[_cost(cost, steps, index, move + 3 * side)]
        across = _cost(cost, steps, index, move + 2 * side)
        is_open = straight[across] != 0
        if not (is_open and past + diagonal[ahead] < enter + straight[ahead]):
            count = _add(offers, count, move + side, straight[ahead])
        if is_open and past + straight[across] >= enter + diagonal[across]:
            count = _add(offers, count, move + 2 * side, diagonal[across])
    onward = diagonal[_cost(cost, steps, index, move)]
    if onward != 0 and open_sides == 2:
        count = _add(offers, count, move, onward)
    return count


@kernel(allocates=False, forceinline=True)
def _is_level(cost: Any, steps: Any, index: int, move: int) -> bool:
    """Return whether the cells on both sides cost as much as the cell itself."""
    here = cost[np.uint64(index)]
    level = True
    for turn in range(1, 4):
        level &= _cost(cost, steps, index, move - turn) == here
        level &= _cost(cost, steps, index, move + turn) == here
    return level


@kernel(allocates=False, forceinline=True)
def _cost(cost: Any, steps: Any, index: int, move: int) -> int:
    """Return the cost of the cell that a move, modulo 8, leads to."""
    there: int = cost[np.uint64(index + steps[np.uint64(move & 7)])]
    return there


@kernel(allocates=False, forceinline=True)
def _add(offers: Any, count: int, move: int, edge: int) -> int:
    offers[np.uint64(count), 0] = move & 7
    offers[np.uint64(count), 1] = edge
    return count + 1
