"""The map as the planner has it: the received one, enlarged to hold the goal."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.geometry import Pose2
from navette.navigation.grids import (
    NO_CELLS,
    UNKNOWN,
    CellWindow,
    GridSpec,
    SharedCells,
    copied,
    padded,
)

Cells = NDArray[np.int8]

# The map is enlarged by multiples of this, and holds this much around a goal.
_STEP_M = 10.0
# Largest edge in cells: 100 million cells in all.
_MOST_CELLS = 10_000


class PlanningMap(SharedCells):
    """The received map, in an extent that also holds the goals.

    Attributes:
        cells: (H, W) −1 unknown, 0 free … 100 occupied.
        spec: their geometry.
    """

    def __init__(self, cells: Cells, spec: GridSpec, *, is_own: bool = False) -> None:
        """Args: cells; their geometry; whether nothing else uses the array."""
        super().__init__(cells, is_own=is_own)
        self.spec = self._received_spec = spec

    def receive(
        self, cells: Cells, spec: GridSpec, changed: CellWindow | None = None
    ) -> CellWindow | None:
        """Use a newer map; return the cells that may have changed, None if all.

        Args:
            cells: (h, w), kept: write to them only to give them again with ``changed``.
            spec: geometry of ``cells``.
            changed: the cells that differ from those of the last call; None: not known,
                the maps are compared.
        """
        offset = _offset(self.spec, spec)
        # What a smaller map leaves out is unknown again.
        is_smaller = _offset(spec, self._received_spec) is None
        self._received_spec = spec
        if offset is None or is_smaller:
            self.replace(cells)
            self.spec = spec
            return None
        if cells is self.cells:
            return CellWindow.whole(spec.shape) if changed is None else changed
        rows, columns = offset
        mine = CellWindow(rows, rows + spec.height, columns, columns + spec.width)
        if changed is None:
            changed = differences(self.cells[mine.slices], cells)
        here = changed.shifted(rows, columns)
        if mine == CellWindow.whole(self.spec.shape):
            self.replace(cells)
        elif not changed.is_empty:
            self.writable()[here.slices] = cells[changed.slices]
        return NO_CELLS if changed.is_empty else here

    def hold(self, x: float, y: float, max_size_m: float) -> bool:
        """Enlarge the extent to hold a point (m, map); return whether it changed.

        A point that would make it larger than the limits stays outside.
        """
        if self.spec.contains(*self.spec.cell_of(x, y)):
            return False
        spec = self.spec
        step = max(1, round(_STEP_M / spec.resolution))
        most = min(_MOST_CELLS, math.floor(max_size_m / spec.resolution + 1e-9))
        row, column = spec.cell_of(x, y)
        rows = _sides(row, spec.height, step, most)
        columns = _sides(column, spec.width, step, most)
        if rows is None or columns is None:
            return False
        shift = Pose2(-columns[0] * spec.resolution, -rows[0] * spec.resolution, 0.0)
        self.spec = GridSpec(
            spec.resolution,
            spec.width + sum(columns),
            spec.height + sum(rows),
            spec.origin @ shift,
        )
        self.replace(padded(self.cells, (rows, columns), UNKNOWN), is_own=True)
        return True

    def copy(self) -> "PlanningMap":
        """Return a map that changes independently."""
        other = PlanningMap(copied(self.cells), self.spec, is_own=True)
        other._received_spec = self._received_spec
        return other


def _sides(at: int, size: int, step: int, most: int) -> tuple[int, int] | None:
    """Return the cells to add before and after an axis to hold a cell in it."""
    before = 0 if at >= 0 else step * math.ceil((step - at) / step)
    after = 0 if at < size else step * math.ceil((at + step - size) / step)
    if size + before + after <= most:
        return before, after
    # Less room around the goal, if that is what fits.
    before, after = max(0, -at), max(0, at - size + 1)
    return (before, after) if size + before + after <= most else None


def _offset(outer: GridSpec, inner: GridSpec) -> tuple[int, int] | None:
    """Return (row, column) in ``outer`` of the first cell of ``inner``.

    None: the cells do not coincide, or ``inner`` leaves ``outer``.
    """
    if outer == inner:
        return 0, 0
    if outer.resolution != inner.resolution:
        return None
    shift = outer.origin.inverse() @ inner.origin
    column, row = round(shift.x / outer.resolution), round(shift.y / outer.resolution)
    off = max(
        abs(shift.x / outer.resolution - column), abs(shift.y / outer.resolution - row)
    )
    if off > 1e-3 or abs(shift.yaw) * max(outer.shape) > 1e-3:
        return None
    inside = (
        row >= 0
        and column >= 0
        and row + inner.height <= outer.height
        and column + inner.width <= outer.width
    )
    return (row, column) if inside else None


def differences(before: Cells, after: Cells) -> CellWindow:
    """Return the smallest window that contains all cells that differ."""
    return CellWindow(*_differences(before, after))


@kernel
def _differences(before: Any, after: Any) -> Any:
    top, bottom = before.shape[0], 0
    left, right = before.shape[1], 0
    for row in range(before.shape[0]):
        mine, other = before[row], after[row]
        if not _differ(mine, other):
            continue
        first, last = 0, mine.size
        while mine[first] == other[first]:
            first += 1
        while mine[last - 1] == other[last - 1]:
            last -= 1
        top, bottom = min(top, row), row + 1
        left, right = min(left, first), max(right, last)
    if bottom == 0:
        return 0, 0, 0, 0
    return top, bottom, left, right


@kernel
def _differ(mine: Any, other: Any) -> bool:
    found = 0
    for k in range(mine.size):
        found |= mine[k] ^ other[k]
    return found != 0
