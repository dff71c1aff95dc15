"""A window of voxels that moves with the robot: marking, and clearing by ray.

Voxels are bits of one integer per column, as in Nav2's VoxelLayer. Cells are addressed
by their index in the world modulo the size of the window, so that moving the window
clears only the columns that enter it.

Rays are traced voxel by voxel (Amanatides, Woo: "A fast voxel traversal algorithm for
ray tracing", Eurographics 1987).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel

MAX_VOXELS = 31
_BLOCK = 8  # columns along an edge of a block
_DROP = np.uint32(1 << 31)  # bit of a column whose floor is missing

Points = NDArray[np.float64]


class _RayLimits(NamedTuple):
    """Lengths of rays in m; see :meth:`VoxelWindow.clear`."""

    longer_than: float
    farthest: float
    margin: float
    least_chord: float


class VoxelWindow:
    """Marked voxels within a square of ``size_m`` around the robot.

    Heights are above the floor, from ``origin_z`` on in ``z_voxels`` steps of
    ``z_resolution``. A column is an obstacle with more than ``mark_threshold`` marked
    voxels, or where its floor was found missing.
    """

    def __init__(
        self,
        size_m: float,
        resolution: float,
        *,
        origin_z: float,
        z_resolution: float,
        z_voxels: int,
        mark_threshold: int = 0,
    ) -> None:
        self.resolution = resolution
        self._count = max(1, math.ceil(size_m / resolution - 1e-9))
        self._z = (origin_z, z_resolution, z_voxels)
        self._threshold = mark_threshold
        self._columns = np.zeros((self._count, self._count), np.uint32)
        self._corner: tuple[int, int] | None = None

    def reset(self) -> None:
        """Clear all voxels."""
        self._columns[:] = 0

    def move_to(self, x: float, y: float) -> None:
        """Centre the window on a point; what leaves it is cleared."""
        half, r = self._count // 2, self.resolution
        corner = math.floor(x / r) - half, math.floor(y / r) - half
        before, self._corner = self._corner, corner
        if before is None:
            return
        for axis, (new, old) in enumerate(zip(corner, before, strict=True)):
            shift = new - old
            if abs(shift) >= self._count:
                self.reset()
                return
            first = old + self._count if shift > 0 else new
            entered = np.arange(first, first + abs(shift)) % self._count
            if axis == 0:
                self._columns[:, entered] = 0
            else:
                self._columns[entered] = 0

    def clear(
        self,
        origin: Points,
        ends: Points,
        *,
        margin: float,
        least_chord: float,
        longer_than: float = 0.0,
        farthest: float = math.inf,
    ) -> None:
        """Clear the voxels that rays cross.

        Of the rays that end in one voxel only the first is traced: the others clear
        nearly the same, and a depth camera has dozens to a near voxel.

        Args:
            origin: (3,) m.
            ends: (N, 3) m.
            margin: each ray clears up to this far before its end, m.
            least_chord: voxels crossed on less than this length stay, m: a ray that
                grazes one does not prove that it is free.
            longer_than: shorter rays clear nothing, m.
            farthest: rays clear up to this distance, m.
        """
        if self._corner is None:
            return
        limits = _RayLimits(
            float(longer_than), float(farthest), float(margin), float(least_chord)
        )
        reached = np.zeros(1 << max(4, (2 * len(ends)).bit_length()), np.int64)
        _clear_rays(
            self._columns, self._corner, self.resolution, self._z,
            np.ascontiguousarray(origin), np.ascontiguousarray(ends), limits, reached,
        )  # fmt: skip

    def mark(self, points: Points) -> None:
        """Mark the voxels of points (N, 3), m."""
        if self._corner is not None:
            _mark_points(
                self._columns, self._corner, self.resolution, self._z,
                np.ascontiguousarray(points),
            )  # fmt: skip

    @property
    def has_drops(self) -> bool:
        """Whether the floor of any column is missing."""
        return bool((self._columns & _DROP).any())

    def mark_drops(self, places: Points, floor: Points) -> None:
        """Note missing floor at ``places`` (N, 2), and its presence at ``floor``."""
        for points, is_missing in ((floor, False), (places, True)):
            rows, columns = self._cells(points)
            if is_missing:
                self._columns[rows, columns] |= _DROP
            else:
                self._columns[rows, columns] &= ~_DROP

    def clear_region(self, points: Points) -> None:
        """Clear the columns of points (N, 2), m."""
        rows, columns = self._cells(points)
        self._columns[rows, columns] = 0

    def obstacles(self) -> Points:
        """Return the centres (N, 2) of the columns that are obstacles, m."""
        if self._corner is None:
            return np.empty((0, 2))
        # Twice as fast as nonzero() of two dimensions.
        rows, columns = np.divmod(np.flatnonzero(self._columns), self._count)
        found = self._columns[rows, columns]
        marked = (
            np.bitwise_count(found & ~_DROP)
            if hasattr(np, "bitwise_count")
            else _popcount(found & ~_DROP)
        )
        keep = (marked > self._threshold) | ((found & _DROP) != 0)
        stored = np.stack([columns[keep], rows[keep]], axis=1)
        corner = np.array(self._corner)
        index = corner + (stored - corner) % self._count
        centres: Points = (index + 0.5) * self.resolution
        return centres

    def _cells(self, points: Points) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return rows and columns in storage of the points within the window."""
        if self._corner is None or not len(points):
            return np.empty(0, np.int64), np.empty(0, np.int64)
        index = np.floor(points[:, :2] / self.resolution).astype(np.int64)
        inside = index - np.array(self._corner)
        kept = ((inside >= 0) & (inside < self._count)).all(axis=1)
        columns, rows = (index[kept] % self._count).T
        return rows, columns


def _popcount(values: NDArray[np.uint32]) -> NDArray[np.int64]:
    """Number of set bits of each value."""
    octets = np.ascontiguousarray(values).view(np.uint8).reshape(-1, 4)
    counts: NDArray[np.int64] = np.unpackbits(octets, axis=1).sum(axis=1)
    return counts


@kernel
def _mark_points(columns, corner, resolution, z, points):  # type: ignore[no-untyped-def]
    count = columns.shape[0]
    origin_z, z_resolution, z_voxels = z
    for i in range(points.shape[0]):
        x = math.floor(points[i, 0] / resolution)
        y = math.floor(points[i, 1] / resolution)
        k = math.floor((points[i, 2] - origin_z) / z_resolution)
        if not (0 <= x - corner[0] < count and 0 <= y - corner[1] < count):
            continue
        if 0 <= k < z_voxels:
            columns[y % count, x % count] |= np.uint32(1 << k)


@kernel
def _clear_rays(  # type: ignore[no-untyped-def]
    columns, corner, resolution, z, origin, ends, limits, reached
):
    """Clear along each ray, in units of voxels from the window's corner.

    ``reached``: zeros, for a hash table of the voxels in which rays end.
    """
    edge = (columns.shape[0] + _BLOCK - 1) // _BLOCK
    blocks = np.zeros((edge, edge), np.bool_)
    _find_blocks(columns, corner, blocks)
    start = (
        origin[0] / resolution - corner[0],
        origin[1] / resolution - corner[1],
        (origin[2] - z[0]) / z[1],
    )
    for i in range(ends.shape[0]):
        dx, dy = ends[i, 0] - origin[0], ends[i, 1] - origin[1]
        dz = ends[i, 2] - origin[2]
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        if not length > limits.longer_than:
            continue
        # A ray that is cut off ends in free space; the others stop before the hit.
        is_cut = length > limits.farthest
        used = limits.farthest + limits.margin if is_cut else length
        share = used / length
        dx, dy, dz = dx * share, dy * share, dz * share
        key = _key(origin[0] + dx, origin[1] + dy, origin[2] + dz, resolution, z[1])
        if used <= limits.margin or not _is_first(key, reached):
            continue
        speed = dx / resolution, dy / resolution, dz / z[1]
        until = 1.0 - limits.margin / used
        begin = _reach_block(blocks, start, speed, until)
        if begin < until:
            _clear_ray(
                columns, corner, z[2], start, speed, begin, until,
                limits.least_chord / used,
            )  # fmt: skip


@kernel(inline="never")
def _find_blocks(columns, corner, blocks):  # type: ignore[no-untyped-def]
    """Note the blocks of the window, counted from its corner, that are not empty."""
    count = columns.shape[0]
    for row in range(count):
        y = (row - corner[1]) % count
        for column in range(count):
            if columns[row, column] != 0:
                x = (column - corner[0]) % count
                blocks[y // _BLOCK, x // _BLOCK] = True


@kernel(inline="never")
def _reach_block(blocks, start, speed, until):  # type: ignore[no-untyped-def]
    """Return the time at which a ray enters a block that is not empty; or inf.

    Most of the space that rays cross is empty.
    """
    count = blocks.shape[0]
    x, step_x, next_x, delta_x = _edge(start[0] / _BLOCK, speed[0] / _BLOCK)
    y, step_y, next_y, delta_y = _edge(start[1] / _BLOCK, speed[1] / _BLOCK)
    entered = 0.0
    while entered < until:
        if (x >= count if step_x > 0 else x < 0) or (
            y >= count if step_y > 0 else y < 0
        ):
            break
        if 0 <= x < count and 0 <= y < count and blocks[y, x]:
            return entered
        if next_x < next_y:
            entered = next_x
            x += step_x
            next_x += delta_x
        else:
            entered = next_y
            y += step_y
            next_y += delta_y
    return np.inf


@kernel(inline="never")
def _key(x, y, height, resolution, z_resolution):  # type: ignore[no-untyped-def]
    """Number of a voxel, > 0 within ±2²⁰ voxels: far beyond every window."""
    column, row = math.floor(x / resolution), math.floor(y / resolution)
    level = math.floor(height / z_resolution)
    middle = 1 << 20
    return ((column + middle) << 42) ^ ((row + middle) << 21) ^ (level + middle)


@kernel(inline="never")
def _is_first(key, reached):  # type: ignore[no-untyped-def]
    """Add a key to the hash table; return whether it was not in it."""
    last = reached.size - 1
    at = ((key * 0x9E3779B97F4A7C1) >> 20) & last
    while reached[at] != 0:
        if reached[at] == key:
            return False
        at = (at + 1) & last
    reached[at] = key
    return True


@kernel(inline="never")
def _edge(start, speed):  # type: ignore[no-untyped-def]
    """Voxel, step, time of the first edge and time between edges along one axis."""
    at = math.floor(start)
    if speed == 0.0:
        return at, 0, np.inf, np.inf
    if speed > 0.0:
        return at, 1, (at + 1 - start) / speed, 1.0 / speed
    return at, -1, (at - start) / speed, -1.0 / speed


@kernel(inline="never")
def _clear_ray(  # type: ignore[no-untyped-def]
    columns, corner, z_voxels, start, speed, begin, until, least
):
    """Clear along start + t · speed for t in begin … until."""
    count = columns.shape[0]
    x, step_x, next_x, delta_x = _edge(start[0] + begin * speed[0], speed[0])
    y, step_y, next_y, delta_y = _edge(start[1] + begin * speed[1], speed[1])
    z, step_z, next_z, delta_z = _edge(start[2] + begin * speed[2], speed[2])
    next_x, next_y, next_z = next_x + begin, next_y + begin, next_z + begin
    row, column = (y + corner[1]) % count, (x + corner[0]) % count  # in storage
    entered = begin
    while entered < until:
        # Beyond the window, and further away with each step.
        if (x >= count if step_x > 0 else x < 0) or (
            y >= count if step_y > 0 else y < 0
        ):
            return
        if z >= z_voxels if step_z > 0 else z < 0:
            return
        left = min(next_x, next_y, next_z)
        if (
            0 <= z < z_voxels
            and 0 <= x < count
            and 0 <= y < count
            and min(left, until) - entered >= least
        ):
            columns[row, column] &= ~np.uint32(1 << z)
        entered = left
        if left == next_x:
            x += step_x
            next_x += delta_x
            column += step_x
            column = 0 if column == count else (count - 1 if column < 0 else column)
        elif left == next_y:
            y += step_y
            next_y += delta_y
            row += step_y
            row = 0 if row == count else (count - 1 if row < 0 else row)
        else:
            z += step_z
            next_z += delta_z
