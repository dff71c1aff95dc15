"""Cost of a footprint on a costmap."""

# ruff: noqa: N802 - the names are Nav2's

import math
from typing import Any

from navette.msgs.geometry_msgs.msg import Point32, Polygon
from navette.ros2.packages.nav2_simple_commander.costmap_2d import PyCostmap2D
from navette.ros2.packages.nav2_simple_commander.line_iterator import LineIterator

NO_INFORMATION = 255
LETHAL_OBSTACLE = 254
INSCRIBED_INFLATED_OBSTACLE = 253
MAX_NON_OBSTACLE = 252
FREE_SPACE = 0


class FootprintCollisionChecker:
    """Checks the outline of a footprint against a costmap."""

    def __init__(self) -> None:
        self.costmap_: PyCostmap2D | None = None

    def setCostmap(self, costmap: PyCostmap2D) -> None:
        self.costmap_ = costmap

    def footprintCost(self, footprint: Polygon) -> float:
        """Return the largest cost along the outline; 254 outside the map.

        Args:
            footprint: corners in metres, in the costmap's frame.
        """
        cells = [self.worldToMapValidated(p.x, p.y) for p in footprint.points]
        if any(x is None for x, _ in cells):
            return LETHAL_OBSTACLE
        cost = 0.0
        # The costs of the sides, the closing one last.
        for (x0, y0), (x1, y1) in zip(cells, [*cells[1:], cells[0]], strict=True):
            if (x0, y0) == (x1, y1):
                side = self.pointCost(x0, y0)
            else:
                side = self.lineCost(x0, x1, y0, y1)
            cost = max(cost, float(side))
            if cost == LETHAL_OBSTACLE:
                break
        return cost

    def lineCost(
        self, x0: float, x1: float, y0: float, y1: float, step_size: float = 0.5
    ) -> float:
        """Return the largest cost along a line between two cells."""
        cost = 0.0
        line = LineIterator(x0, y0, x1, y1, step_size)
        while line.isValid():
            cost = max(cost, float(self.pointCost(int(line.getX()), int(line.getY()))))
            if cost == LETHAL_OBSTACLE:
                break
            line.advance()
        return cost

    def worldToMapValidated(self, wx: float, wy: float) -> tuple[Any, Any]:
        """Return the cell of a position; (None, None) outside the map.

        Raises:
            ValueError: no costmap has been set.
        """
        return self._costmap().worldToMapValidated(wx, wy)

    def pointCost(self, x: int, y: int) -> Any:
        """Return the cost of a cell.

        Raises:
            ValueError: no costmap has been set.
        """
        return self._costmap().getCostXY(x, y)

    def footprintCostAtPose(
        self, x: float, y: float, theta: float, footprint: Polygon
    ) -> float:
        """Return the cost of a footprint, given in the robot's frame, at a pose."""
        cos, sin = math.cos(theta), math.sin(theta)
        moved = Polygon(
            points=[
                Point32(x=x + p.x * cos - p.y * sin, y=y + p.x * sin + p.y * cos)
                for p in footprint.points
            ]
        )
        return self.footprintCost(moved)

    def _costmap(self) -> PyCostmap2D:
        if self.costmap_ is None:
            raise ValueError(
                "Costmap not specified, use setCostmap to specify the costmap first"
            )
        return self.costmap_
