"""One revolution of a planar scanner."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError


@dataclass(frozen=True, eq=False)
class PlanarScan:
    """One revolution of a planar scanner (as sensor_msgs/LaserScan)."""

    ranges: NDArray[np.float32]
    """(N,) m; invalid values: see :func:`navette.navigation.grids.trace_beams`"""
    angle_min: float
    """of the first beam, rad from the sensor's x axis, counter-clockwise"""
    angle_increment: float
    """between beams, rad"""
    range_min: float
    """m; readings up to it are ignored"""
    range_max: float
    """m; readings from it on mean that the beam is free up to it"""

    def __post_init__(self) -> None:
        if not (math.isfinite(self.angle_min) and math.isfinite(self.angle_increment)):
            raise InvalidValueError(
                f"scan: angle_min {self.angle_min}, angle_increment "
                f"{self.angle_increment}; expected finite values"
            )
        if not 0.0 <= self.range_min < self.range_max:
            raise InvalidValueError(
                f"scan: range_min {self.range_min}, range_max {self.range_max}; "
                f"expected 0 <= range_min < range_max"
            )
