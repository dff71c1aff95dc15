"""Beams of a range sensor traced through a grid."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.files.kernels import kernel
from navette.navigation.grids.checks import grid_array, kernel_array
from navette.navigation.grids.spec import (
    FREE,
    LETHAL,
    Cells,
    GridFrame,
    GridSpec,
    grid_frame,
)

# Change of range per distance between neighbouring beams on a wall met at 10°.
_STEEPEST = 1.0 / math.tan(math.radians(10.0))

_UNIT = 4294967296.0  # of the fixed-point numbers with 32 binary places


class _Beams(NamedTuple):
    """One scan for the kernel: (x, y) of the sensor, arrays per beam, limits."""

    sensor: tuple[float, float]
    directions: NDArray[np.float64]
    ranges: NDArray[np.float32]
    margins: NDArray[np.float32]
    range_min: float
    range_max: float


def beam_directions(
    angle_min: float, angle_increment: float, count: int
) -> NDArray[np.float64]:
    """Unit vectors (N, 2) of a scan's beams in the sensor's frame."""
    angles = angle_min + angle_increment * np.arange(count)
    return np.column_stack([np.cos(angles), np.sin(angles)])


def trace_beams(
    cost: Cells,
    spec: GridSpec,
    sensor: tuple[float, float],
    directions: NDArray[np.float64],
    ranges: NDArray[np.float32],
    *,
    range_min: float,
    range_max: float,
    margins: NDArray[np.float32] | None = None,
    fills: bool = False,
) -> int:
    """Write one scan into ``cost``: free up to each hit, lethal at the hit.

    Cells on the line from the sensor's cell to the last cell (Bresenham 1965) become
    free, with ``fills`` also those between neighbouring beams that end on one surface;
    cells that contain a hit become lethal. Nothing is written beyond a hit, and a hit
    is never freed by another beam of the same scan. Readings:

    - range_min < r < range_max: a hit at r;
    - r >= range_max, also infinite: no hit, free up to range_max;
    - r <= range_min, negative or not a number: no information, nothing is written.

    Args:
        cost: (H, W) int8, changed in place; -1 unknown, 0 free … 100 lethal.
        spec: geometry of the grid.
        sensor: (x, y) in the grid's frame, m; inside the grid.
        directions: (N, 2) unit vectors of the beams in the grid's frame.
        ranges: (N,) float32, m.
        range_min: least valid range, m.
        range_max: largest valid range, m.
        margins: (N,) float32, m: each beam stops freeing cells this far before its
            hit.
        fills: whether the space between neighbouring beams is freed.

    Returns:
        The number of beams with a hit inside the grid.

    Raises:
        InvalidValueError: arrays that do not match, a sensor outside the grid, or an
            empty interval of ranges.
    """
    if isinstance(cost, np.ndarray) and not cost.flags.carray:
        raise InvalidValueError("cost: not a writable C-ordered array")
    grid = grid_array("cost", cost, np.int8, spec)
    rays = kernel_array("directions", directions, np.float64, allow_empty=True)
    metres = kernel_array("ranges", ranges, np.float32, 1, allow_empty=True)
    if margins is None:
        margins = np.zeros_like(metres)
    before = kernel_array("margins", margins, np.float32, 1, allow_empty=True)
    if rays.shape != (metres.size, 2) or before.shape != metres.shape:
        raise InvalidValueError(
            f"{metres.size} ranges, directions {rays.shape}, margins {before.shape}: "
            f"expected (N,), (N, 2), (N,)"
        )
    if not spec.contains(*spec.cell_of(*sensor)):
        raise InvalidValueError(f"sensor at {sensor}: outside the grid {spec}")
    if not (0.0 <= range_min < range_max < math.inf):
        raise InvalidValueError(
            f"range_min {range_min}, range_max {range_max}: must be 0 <= min < max"
        )
    position = float(sensor[0]), float(sensor[1])
    beams = _Beams(position, rays, metres, before, float(range_min), float(range_max))
    ends = np.empty(metres.size, np.int64)
    hits: int = _trace_kernel(grid, grid_frame(spec), beams, ends, fills)
    return hits


@kernel
def _trace_kernel(
    cost: Cells,
    frame: GridFrame,
    beams: _Beams,
    ends: NDArray[np.int64],
    fills: bool,
) -> int:
    height, width = cost.shape
    flat = cost.reshape(height * width)
    per_metre = 1.0 / frame.resolution
    dx = (beams.sensor[0] - frame.x) * per_metre
    dy = (beams.sensor[1] - frame.y) * per_metre
    u, v = frame.cos * dx + frame.sin * dy, frame.cos * dy - frame.sin * dx
    directions, ranges, margins = beams.directions, beams.ranges, beams.margins
    for i in range(ranges.size):
        ends[i] = -1
        reading = ranges[i]
        if not reading > beams.range_min:  # also not a number
            continue
        reach = min(reading, beams.range_max)
        bx, by = directions[i, 0] * per_metre, directions[i, 1] * per_metre
        du, dv = frame.cos * bx + frame.sin * by, frame.cos * by - frame.sin * bx
        inside = min(reach, _exit(u, du, width), _exit(v, dv, height))
        column = min(max(int(u + inside * du), 0), width - 1)
        row = min(max(int(v + inside * dv), 0), height - 1)
        hit = reading < beams.range_max and inside == reach
        if hit:
            ends[i] = row * width + column
        share = 1.0 - margins[i] / reach if hit else 1.0
        _free_line(flat, width, int(v), int(u), row, column, share)
        if fills and i > 0:
            _free_between(flat, height, width, u, v, frame, beams, i)
    hits = 0
    for i in range(ranges.size):
        if ends[i] >= 0:
            flat[ends[i]] = LETHAL
            hits += 1
    return hits


@kernel(allocates=False)
def _free_between(
    flat: Cells,
    height: int,
    width: int,
    u: float,
    v: float,
    frame: GridFrame,
    beams: _Beams,
    i: int,
) -> None:
    """Free the cells between the beams i − 1 and i, if both end on one surface.

    Nothing that the beams missed can then stand in front of it, except thinner objects
    than the beams are apart. Beams that end on different objects may pass an edge, so
    nothing is freed between them.
    """
    reach = _surface(beams, i)
    if reach <= 0.0:
        return
    per_metre = 1.0 / frame.resolution
    ax, ay = beams.directions[i - 1, 0], beams.directions[i - 1, 1]
    bx, by = beams.directions[i, 0], beams.directions[i, 1]
    apart = np.hypot(bx - ax, by - ay)
    wide = apart * reach * per_metre
    lines = int(1.5 * wide)
    for k in range(1, lines + 1):
        part = k / (lines + 1)
        dx, dy = ax + part * (bx - ax), ay + part * (by - ay)
        du = (frame.cos * dx + frame.sin * dy) * per_metre
        dv = (frame.cos * dy - frame.sin * dx) * per_metre
        last = min(reach, _exit(u, du, width), _exit(v, dv, height))
        # Nearer than this the beams themselves are less than a cell apart.
        steps = int((last - 1.0 / (apart * per_metre)) * per_metre) + 1
        nearest = last - (steps - 1) * frame.resolution
        row, column = _fixed(v + last * dv, height), _fixed(u + last * du, width)
        between = max(steps - 1, 1)
        down = int((_fixed(v + nearest * dv, height) - row) / between)
        right = int((_fixed(u + nearest * du, width) - column) / between)
        for _ in range(steps):
            flat[np.uintp((row >> 32) * width + (column >> 32))] = FREE
            row += down
            column += right


@kernel(allocates=False)
def _fixed(cells: float, size: int) -> int:
    """Return a coordinate in 1/2³² cells, inside [0, size) by more than steps round.

    Stepping integers needs no conversion and no test for each cell.
    """
    least = 1 << 16
    return min(max(int(cells * _UNIT), least), (size << 32) - least)


@kernel(allocates=False)
def _surface(beams: _Beams, i: int) -> float:
    """Return how far the space between beams i − 1 and i is free; 0 = not known.

    Two echoes belong to one surface if they are at most as far apart as on a wall that
    the beams hit at 10°, or if both beams end without an echo.
    """
    near, far = beams.ranges[i - 1], beams.ranges[i]
    if not (near > beams.range_min and far > beams.range_min):
        return 0.0
    if near >= beams.range_max and far >= beams.range_max:
        return beams.range_max
    if near >= beams.range_max or far >= beams.range_max:
        return 0.0
    shorter = min(near, far)
    ax, ay = beams.directions[i - 1, 0], beams.directions[i - 1, 1]
    bx, by = beams.directions[i, 0], beams.directions[i, 1]
    apart = np.hypot(bx - ax, by - ay)
    if abs(near - far) > shorter * apart * _STEEPEST:
        return 0.0
    reach: float = shorter - max(beams.margins[i - 1], beams.margins[i])
    return reach


@kernel(allocates=False)
def _exit(start: float, speed: float, size: int) -> float:
    """Time at which a point that moves from ``start`` at ``speed`` leaves [0, size)."""
    if speed > 0.0:
        return (size - start) / speed
    if speed < 0.0:
        return -start / speed
    return np.inf


@kernel(allocates=False)
def _free_line(
    flat: Cells, width: int, r0: int, c0: int, r1: int, c1: int, share: float
) -> None:
    """Free the first ``share`` of the cells from (r0, c0) to (r1, c1)."""
    across, along = abs(r1 - r0), abs(c1 - c0)
    minor = width if r1 > r0 else -width
    major = 1 if c1 > c0 else -1
    if across > along:
        across, along = along, across
        minor, major = major, minor
    # Cells moved across, in fixed point and rounded up: exact for up to 2¹⁵ cells,
    # since fractions are multiples of 1 / along.
    scale = _UNIT / max(along, 1)
    crossed, slope = int(along // 2 * scale) + 1, int(across * scale) + 1
    at = r0 * width + c0
    for _ in range(int(share * along + 0.5)):
        flat[np.uintp(at + (crossed >> 32) * minor)] = FREE
        at += major
        crossed += slope
    # The last cell: free without a hit; with one, overwritten as lethal afterwards.
    if share >= 1.0:
        flat[np.uintp(r1 * width + c1)] = FREE
