"""A window of voxels that moves with the robot: marking, and clearing by ray.

Voxels are bits of one integer per column, as in Nav2's VoxelLayer. Cells are addressed
by their index in the world modulo the size of the window, so that moving the window
clears only the columns that enter it.

Rays are traced voxel by voxel (Amanatides, Woo: "A fast voxel traversal algorithm for
ray tracing", Eurographics 1987).
"""

import math

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel

MAX_VOXELS = 31
_DROP = np.uint32(1 << 31)  # bit of a column whose floor is missing

Points = NDArray[np.float64]


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
        self, origin: Points, ends: Points, *, margin: float, least_chord: float
    ) -> None:
        """Clear the voxels that rays cross.

        Args:
            origin: (3,) m.
            ends: (N, 3) m.
            margin: each ray clears up to this far before its end, m.
            least_chord: voxels crossed on less than this length stay, m: a ray that
                grazes one does not prove that it is free.
        """
        if self._corner is not None:
            _clear_rays(
                self._columns, self._corner, self.resolution, self._z,
                np.ascontiguousarray(origin), np.ascontiguousarray(ends),
                float(margin), float(least_chord),
            )  # fmt: skip

    def mark(self, points: Points) -> None:
        """Mark the voxels of points (N, 3), m."""
        if self._corner is not None:
            _mark_points(
                self._columns, self._corner, self.resolution, self._z,
                np.ascontiguousarray(points),
            )  # fmt: skip

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
        rows, columns = np.nonzero(self._columns)
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
    columns, corner, resolution, z, origin, ends, margin, least_chord
):
    """Clear along each ray, in units of voxels from the window's corner."""
    start = (
        origin[0] / resolution - corner[0],
        origin[1] / resolution - corner[1],
        (origin[2] - z[0]) / z[1],
    )
    for i in range(ends.shape[0]):
        dx, dy = ends[i, 0] - origin[0], ends[i, 1] - origin[1]
        dz = ends[i, 2] - origin[2]
        length = math.sqrt(dx * dx + dy * dy + dz * dz)
        if length > margin:
            speed = dx / resolution, dy / resolution, dz / z[1]
            _clear_ray(
                columns, corner, z[2], start, speed, 1.0 - margin / length,
                least_chord / length,
            )  # fmt: skip


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
    columns, corner, z_voxels, start, speed, until, least
):
    """Clear along start + t · speed for t in 0 … until."""
    count = columns.shape[0]
    x, step_x, next_x, delta_x = _edge(start[0], speed[0])
    y, step_y, next_y, delta_y = _edge(start[1], speed[1])
    z, step_z, next_z, delta_z = _edge(start[2], speed[2])
    row, column = (y + corner[1]) % count, (x + corner[0]) % count  # in storage
    entered = 0.0
    while entered < until:
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
