"""Costs of an occupancy grid or costmap message, by cell and by position."""

# ruff: noqa: N802 - the names are Nav2's

from typing import Any

import numpy as np


class PyCostmap2D:
    """A grid of costs with conversions between positions (m) and cells.

    Args:
        occupancy_map: nav_msgs OccupancyGrid, or nav2_msgs Costmap as
            ``BasicNavigator.getGlobalCostmap`` returns it.
    """

    def __init__(self, occupancy_map: Any) -> None:
        header = occupancy_map.header
        if hasattr(occupancy_map, "metadata"):
            grid = occupancy_map.metadata
            self.size_x, self.size_y = grid.size_x, grid.size_y
        else:
            grid = occupancy_map.info
            self.size_x, self.size_y = grid.width, grid.height
        self.resolution: float = grid.resolution
        self.origin_x: float = grid.origin.position.x
        self.origin_y: float = grid.origin.position.y
        self.global_frame_id: str = header.frame_id
        self.costmap_timestamp = header.stamp
        # Occupancy -1 (unknown) becomes 255.
        self.costmap = np.array(occupancy_map.data).astype(np.uint8)

    def getSizeInCellsX(self) -> int:
        return int(self.size_x)

    def getSizeInCellsY(self) -> int:
        return int(self.size_y)

    def getSizeInMetersX(self) -> float:
        """Distance from the first cell's edge to the last cell's centre."""
        return float((self.size_x - 0.5) * self.resolution)

    def getSizeInMetersY(self) -> float:
        """Distance from the first cell's edge to the last cell's centre."""
        return float((self.size_y - 0.5) * self.resolution)

    def getOriginX(self) -> float:
        return self.origin_x

    def getOriginY(self) -> float:
        return self.origin_y

    def getResolution(self) -> float:
        return self.resolution

    def getGlobalFrameID(self) -> str:
        return self.global_frame_id

    def getCostmapTimestamp(self) -> Any:
        return self.costmap_timestamp

    def getCostXY(self, mx: int, my: int) -> np.uint8:
        """Return the cost of a cell."""
        return self.getCostIdx(self.getIndex(mx, my))

    def getCostIdx(self, index: int) -> np.uint8:
        """Return the cost of a cell by its index, row by row."""
        cost: np.uint8 = self.costmap[index]
        return cost

    def setCost(self, mx: int, my: int, cost: np.uint8) -> None:
        self.costmap[self.getIndex(mx, my)] = cost

    def mapToWorld(self, mx: int, my: int) -> tuple[float, float]:
        """Return the position of a cell's centre."""
        return (
            self.origin_x + (mx + 0.5) * self.resolution,
            self.origin_y + (my + 0.5) * self.resolution,
        )

    def worldToMapValidated(
        self, wx: float, wy: float
    ) -> tuple[int, int] | tuple[None, None]:
        """Return the cell that contains a position; (None, None) outside the map."""
        if wx < self.origin_x or wy < self.origin_y:
            return None, None
        mx = int((wx - self.origin_x) // self.resolution)
        my = int((wy - self.origin_y) // self.resolution)
        return (mx, my) if mx < self.size_x and my < self.size_y else (None, None)

    def getIndex(self, mx: int, my: int) -> int:
        return int(my * self.size_x + mx)
