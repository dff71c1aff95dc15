"""Cell values of an occupancy grid, and where a grid lies."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.geometry import Pose2

# Cell values of nav_msgs/OccupancyGrid; values between FREE and LETHAL are costs.
UNKNOWN = -1
FREE = 0
LETHAL = 100

Cells = NDArray[np.int8]

_ORIGIN = Pose2(0.0, 0.0, 0.0)

# Kernels compute cell indices in fixed point without bounds checks; an overflow would
# access foreign memory. Grids outside these limits (metres) never reach a kernel.
_RESOLUTIONS = (1e-3, 100.0)
_FARTHEST = 1e9
_FARTHEST_CELL = 1e15


@dataclass(frozen=True)
class GridSpec:
    """Geometry of a grid stored as ``data[row, column]`` = ``data[y, x]``.

    Attributes:
        resolution: edge of a cell, m.
        width: columns.
        height: rows.
        origin: pose of the outer corner of cell (0, 0) in the grid's frame, as in
            nav_msgs/MapMetaData; a cell's centre lies half a cell further in.

    Raises:
        InvalidValueError: no cells, a resolution outside 1 mm to 100 m, or an origin
            that is not finite or farther than 1e9 m.
    """

    resolution: float
    width: int
    height: int
    origin: Pose2 = _ORIGIN

    def __post_init__(self) -> None:
        finest, coarsest = _RESOLUTIONS
        if not finest <= self.resolution <= coarsest:
            raise InvalidValueError(
                f"grid resolution {self.resolution!r}: allowed are {finest:g} to "
                f"{coarsest:g} m"
            )
        if self.width < 1 or self.height < 1:
            raise InvalidValueError(
                f"grid of {self.width} x {self.height} cells: at least 1 x 1 required"
            )
        if not all(map(math.isfinite, self.origin)):
            raise InvalidValueError(f"grid origin {self.origin} is not finite")
        if max(abs(self.origin.x), abs(self.origin.y)) > _FARTHEST:
            raise InvalidValueError(
                f"grid origin {self.origin}: x and y must be within {_FARTHEST:g} m"
            )

    @property
    def shape(self) -> tuple[int, int]:
        """(height, width): the shape of the data array."""
        return (self.height, self.width)

    def cell_of(self, x: float, y: float) -> tuple[int, int]:
        """(row, column) of the cell that contains the point (m, grid's frame).

        Points outside the grid give indices outside it; check with :meth:`contains`.
        """
        dx, dy = x - self.origin.x, y - self.origin.y
        c, s = math.cos(self.origin.yaw), math.sin(self.origin.yaw)
        column = _index((c * dx + s * dy) / self.resolution)
        row = _index((c * dy - s * dx) / self.resolution)
        return row, column

    def center_of(self, row: int, column: int) -> tuple[float, float]:
        """Centre (x, y) of a cell in metres in the grid's frame."""
        u = (column + 0.5) * self.resolution
        v = (row + 0.5) * self.resolution
        c, s = math.cos(self.origin.yaw), math.sin(self.origin.yaw)
        return self.origin.x + c * u - s * v, self.origin.y + s * u + c * v

    def centers_of(self, cells: NDArray[np.int64]) -> NDArray[np.float64]:
        """Centres (N, 2) x, y in metres of cells (N, 2) row, column."""
        uv = (cells[:, ::-1].astype(np.float64) + 0.5) * self.resolution
        return self.origin.apply(uv)

    def contains(self, row: int, column: int) -> bool:
        """Whether the cell lies in the grid."""
        return 0 <= row < self.height and 0 <= column < self.width


def _index(cells: float) -> int:
    """Round down; a number too large for an index, or NaN, gives one outside."""
    return math.floor(min(max(-_FARTHEST_CELL, cells), _FARTHEST_CELL))


class GridFrame(NamedTuple):
    """Origin and resolution of a grid, as kernels take them."""

    x: float
    y: float
    cos: float
    sin: float
    resolution: float


def grid_frame(spec: GridSpec) -> GridFrame:
    """Return the :class:`GridFrame` of a spec."""
    yaw = spec.origin.yaw
    return GridFrame(
        float(spec.origin.x),
        float(spec.origin.y),
        math.cos(yaw),
        math.sin(yaw),
        float(spec.resolution),
    )
