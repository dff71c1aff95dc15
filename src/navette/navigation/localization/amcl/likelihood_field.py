"""Likelihood field of a map: how well scans fit it, from any pose.

Thrun, Burgard, Fox, "Probabilistic Robotics" (2005), section 6.4: a beam that ends at
distance d from the nearest obstacle of the map has likelihood
``z_hit · exp(−d² / 2σ²) + z_rand``, here with ``z_hit + z_rand = 1``. Beams without an
echo are not used.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel
from navette.navigation.grids import GridSpec
from navette.navigation.grids.distance import metres_by_square, square_field

# Values of map_server from which a cell is an obstacle, and up to which it is free.
OCCUPIED, FREE_UP_TO = 65, 25

Points = NDArray[np.float64]
Poses = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LikelihoodField:
    """A map for scoring poses.

    The likelihood of a beam depends on the distance alone. All fields of a map share
    the grid of squared distances, and differ in a table of values: at 200 m a grid of
    likelihoods would take 0.4 s to compute for each search.

    Attributes:
        spec: geometry of the grids in the map frame.
        squares: (H, W) squared distance to the nearest obstacle, cells².
        metres: (S,) distance by its square, m.
        log_likelihood: (S,) of a beam that ends at such a distance; at most 0.
        outside: log likelihood of a beam that ends outside the map.
        cells: (H, W) the map: -1 unknown, 0 free … 100 occupied; not copied.
        sigma: standard deviation of a beam's end, m.
        random: share of beams that hit something else, 0 … 1.
    """

    spec: GridSpec
    squares: NDArray[np.integer[Any]]
    metres: NDArray[np.float32]
    log_likelihood: NDArray[np.float32]
    outside: float
    cells: NDArray[np.int8]
    sigma: float
    random: float

    @classmethod
    def of(
        cls,
        cells: NDArray[np.int8],
        spec: GridSpec,
        *,
        sigma: float,
        random: float,
        reach_m: float,
    ) -> "LikelihoodField":
        """Make the field of a map.

        Args:
            cells: (H, W) -1 unknown, 0 free … 100 occupied.
            spec: their geometry.
            sigma: standard deviation of a beam's end, m.
            random: share of beams that hit something else, 0 … 1.
            reach_m: distance beyond which all places are equal.
        """
        radius = math.ceil(reach_m / spec.resolution)
        occupied = (cells >= OCCUPIED).view(np.uint8)
        metres = metres_by_square(spec.resolution, radius, reach_m)
        return cls(
            spec,
            square_field(occupied, radius),
            metres,
            _log_likelihood(metres, sigma, random),
            _log_likelihood(np.array([reach_m]), sigma, random).item(),
            cells,
            sigma,
            random,
        )

    def blurred(self, sigma: float, random: float) -> "LikelihoodField":
        """Return the field of another standard deviation, for a coarse search."""
        values = _log_likelihood(self.metres, sigma, random)
        return replace(
            self,
            log_likelihood=values,
            outside=float(values[self._largest]),
            sigma=sigma,
            random=random,
        )

    def is_free(self) -> NDArray[np.bool_]:
        """Return which cells (H, W) are free."""
        return (self.cells >= 0) & (self.cells <= FREE_UP_TO)

    @cached_property
    def _largest(self) -> int:
        return int(self.squares.max(initial=0))

    @cached_property
    def tolerant(self) -> "LikelihoodField":
        """The field in which ends of beams within a cell of an obstacle are on it."""
        return self.best_within(self.spec.resolution)

    def best_within(self, radius_m: float) -> "LikelihoodField":
        """Return the field of the largest value within a radius of each place."""
        away = np.maximum(self.metres - np.float32(radius_m), 0.0)
        return replace(
            self, log_likelihood=_log_likelihood(away, self.sigma, self.random)
        )

    def scores(self, poses: Poses, points: Points) -> NDArray[np.float64]:
        """Return the mean log likelihood (N,) of a scan's points from poses.

        Args:
            poses: (N, 3) x, y, yaw of the base in the map.
            points: (M, 2) ends of the beams in the base frame, m.
        """
        found = np.zeros(len(poses))
        if len(points):
            _scores(
                self.squares, self.log_likelihood, self.outside, _frame(self.spec),
                np.ascontiguousarray(poses), np.ascontiguousarray(points), found,
            )  # fmt: skip
        return found

    def share_within(
        self, pose: NDArray[np.float64], points: Points, within_m: float
    ) -> float:
        """Return the share of points at most ``within_m`` from an obstacle; 0…1."""
        if not len(points):
            return 0.0
        return float(
            _share_within(
                self.squares, self.metres, _frame(self.spec),
                np.asarray(pose, np.float64), np.ascontiguousarray(points), within_m,
            )
        )  # fmt: skip

    def agreement(
        self, poses: Poses, points: Points, within_m: float
    ) -> NDArray[np.float64]:
        """Return the share (M,) of poses from which each point is near an obstacle.

        Args:
            poses: (N, 3) x, y, yaw of the base in the map.
            points: (M, 2) ends of the beams in the base frame, m.
            within_m: largest distance from an obstacle.
        """
        near = np.zeros(len(points))
        _agreement(
            self.squares, self.metres, _frame(self.spec), np.ascontiguousarray(poses),
            np.ascontiguousarray(points), within_m, near,
        )  # fmt: skip
        return near

    def refined(
        self, poses: Poses, points: Points, step_m: float, step_rad: float
    ) -> tuple[Poses, NDArray[np.float64]]:
        """Return poses (N, 3) moved uphill, and their scores (N,).

        Pattern search: steps along x, y and yaw, halved three times.
        """
        found, scores = np.array(poses, np.float64), np.zeros(len(poses))
        _refine(
            self.squares, self.log_likelihood, self.outside, _frame(self.spec), found,
            np.ascontiguousarray(points), scores, step_m, step_rad,
        )  # fmt: skip
        return found, scores


def _log_likelihood(
    distance: NDArray[Any], sigma: float, random: float
) -> NDArray[np.float32]:
    hit = np.exp(-(distance.astype(np.float64) ** 2) / (2 * sigma**2))
    return np.log((1.0 - random) * hit + random).astype(np.float32)


def _frame(spec: GridSpec) -> tuple[float, float, float, float]:
    return spec.origin.x, spec.origin.y, spec.origin.yaw, spec.resolution


@kernel(allocates=False)
def _view_from(
    frame: tuple[float, float, float, float], x: float, y: float, yaw: float
) -> tuple[float, float, float, float]:
    """Return the transform of points seen from a pose into the grid, in cells.

    Column and row of the pose, then cosine and sine of its heading over the resolution.

    Args:
        frame: x, y, yaw of the grid's corner, m, rad, and its resolution, m.
        x: of the pose, m; likewise y, m, and yaw, rad.
    """
    x0, y0, yaw0, resolution = frame
    dx, dy = x - x0, y - y0
    c0, s0 = math.cos(yaw0), math.sin(yaw0)
    return (
        (c0 * dx + s0 * dy) / resolution,
        (c0 * dy - s0 * dx) / resolution,
        math.cos(yaw - yaw0) / resolution,
        math.sin(yaw - yaw0) / resolution,
    )


@kernel(allocates=False)
def _cell_at(
    view: tuple[float, float, float, float],
    px: float,
    py: float,
    height: int,
    width: int,
) -> tuple[int, int]:
    """Return row and column of the cell in which a point of a view lies; −1 outside.

    The grid itself is not passed: Numba would count its references at each point.
    """
    u = view[0] + view[2] * px - view[3] * py
    v = view[1] + view[3] * px + view[2] * py
    if 0.0 <= u < width and 0.0 <= v < height:
        return int(v), int(u)
    return -1, -1


@kernel(allocates=False)
def _score(
    squares: Any,
    values: Any,
    outside: float,
    frame: tuple[float, float, float, float],
    x: float,
    y: float,
    yaw: float,
    points: Any,
) -> float:
    """Return the mean of the values at the points, seen from a pose."""
    view, total = _view_from(frame, x, y, yaw), 0.0
    height, width = squares.shape
    for k in range(points.shape[0]):
        row, column = _cell_at(view, points[k, 0], points[k, 1], height, width)
        total += outside if row < 0 else values[squares[row, column]]
    return float(total / points.shape[0])


@kernel(allocates=False)
def _scores(
    squares: Any,
    values: Any,
    outside: float,
    frame: tuple[float, float, float, float],
    poses: Any,
    points: Any,
    scores: Any,
) -> None:
    for i in range(poses.shape[0]):
        x, y, yaw = poses[i, 0], poses[i, 1], poses[i, 2]
        scores[i] = _score(squares, values, outside, frame, x, y, yaw, points)


@kernel
def _share_within(
    squares: Any,
    metres: Any,
    frame: tuple[float, float, float, float],
    pose: Any,
    points: Any,
    within: float,
) -> float:
    view, near = _view_from(frame, pose[0], pose[1], pose[2]), 0
    height, width = squares.shape
    for k in range(points.shape[0]):
        row, column = _cell_at(view, points[k, 0], points[k, 1], height, width)
        near += row >= 0 and metres[squares[row, column]] <= within
    return float(near / points.shape[0])


@kernel
def _agreement(
    squares: Any,
    metres: Any,
    frame: tuple[float, float, float, float],
    poses: Any,
    points: Any,
    within: float,
    near: Any,
) -> None:
    height, width = squares.shape
    for i in range(poses.shape[0]):
        view = _view_from(frame, poses[i, 0], poses[i, 1], poses[i, 2])
        for k in range(points.shape[0]):
            row, column = _cell_at(view, points[k, 0], points[k, 1], height, width)
            near[k] += row >= 0 and metres[squares[row, column]] <= within
    near /= poses.shape[0]


@kernel(allocates=False)
def _refine(
    squares: Any,
    values: Any,
    outside: float,
    frame: tuple[float, float, float, float],
    poses: Any,
    points: Any,
    scores: Any,
    step_m: float,
    step_rad: float,
) -> None:
    for i in range(poses.shape[0]):
        x, y, yaw = poses[i, 0], poses[i, 1], poses[i, 2]
        best = _score(squares, values, outside, frame, x, y, yaw, points)
        along, turn = step_m, step_rad
        for _ in range(4):
            for _ in range(20):
                bx, by, byaw, before = x, y, yaw, best
                for axis in range(6):
                    sign = 1.0 if axis % 2 == 0 else -1.0
                    tx = x + sign * along * (axis // 2 == 0)
                    ty = y + sign * along * (axis // 2 == 1)
                    tyaw = yaw + sign * turn * (axis // 2 == 2)
                    score = _score(
                        squares, values, outside, frame, tx, ty, tyaw, points
                    )
                    if score > best:
                        best, bx, by, byaw = score, tx, ty, tyaw
                x, y, yaw = bx, by, byaw
                if best <= before:
                    break
            along, turn = along / 2, turn / 2
        poses[i, 0], poses[i, 1], poses[i, 2], scores[i] = x, y, yaw, best
