"""nav2_simple_commander: costs of cells, lines and footprints."""

import math

import numpy as np
import pytest

from navette.msgs.geometry_msgs.msg import Point32, Polygon
from navette.msgs.nav2_msgs.msg import Costmap
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.ros2.packages.nav2_simple_commander.costmap_2d import PyCostmap2D
from navette.ros2.packages.nav2_simple_commander.footprint_collision_checker import (
    LETHAL_OBSTACLE,
    FootprintCollisionChecker,
)
from navette.ros2.packages.nav2_simple_commander.line_iterator import LineIterator


def grid(width: int = 10, height: int = 8) -> OccupancyGrid:
    msg = OccupancyGrid()
    msg.header.frame_id = "map"
    msg.info.width, msg.info.height, msg.info.resolution = width, height, 0.5
    msg.info.origin.position.x, msg.info.origin.position.y = -1.0, 2.0
    msg.data = [0] * (width * height)
    return msg


def square(size: float) -> Polygon:
    corners = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    return Polygon(points=[Point32(x=size * x, y=size * y) for x, y in corners])


def test_cells_and_positions() -> None:
    costmap = PyCostmap2D(grid())
    assert (costmap.getSizeInCellsX(), costmap.getSizeInCellsY()) == (10, 8)
    assert costmap.getSizeInMetersX() == pytest.approx(4.75)
    assert costmap.getSizeInMetersY() == pytest.approx(3.75)
    assert (costmap.getOriginX(), costmap.getOriginY()) == (-1.0, 2.0)
    assert costmap.getResolution() == pytest.approx(0.5)
    assert costmap.getGlobalFrameID() == "map"
    assert costmap.mapToWorld(0, 1) == pytest.approx((-0.75, 2.75))
    assert costmap.worldToMapValidated(-0.75, 2.75) == (0, 1)
    assert costmap.worldToMapValidated(-1.01, 2.5) == (None, None)
    assert costmap.worldToMapValidated(4.0, 2.5) == (None, None)
    costmap.setCost(3, 2, np.uint8(77))
    assert costmap.getCostXY(3, 2) == 77
    assert costmap.getCostIdx(costmap.getIndex(3, 2)) == 77


def test_unknown_cells_and_costmap_messages() -> None:
    msg = grid()
    msg.data = [-1] * 80
    assert PyCostmap2D(msg).getCostXY(0, 0) == 255
    costmap = Costmap()
    costmap.metadata.size_x, costmap.metadata.size_y = 2, 1
    costmap.metadata.resolution = 0.1
    costmap.data = [0, 254]
    assert PyCostmap2D(costmap).getCostXY(1, 0) == 254


@pytest.mark.parametrize(
    ("ends", "points"),
    [
        ((0, 0, 3, 0), [(0, 0), (1, 0), (2, 0), (3, 0)]),
        ((2, 1, 2, 3), [(2, 1), (2, 2), (2, 3)]),
        ((2, 2, 0, 3), [(2, 2), (1, 2.5), (0, 3)]),
        ((0, 3, 0, 1), [(0, 3), (0, 2), (0, 1)]),
        ((0, 0, 2.5, 5), [(0, 0), (1, 2), (2, 4), (2.5, 5)]),
    ],
)
def test_a_line_has_its_points(
    ends: tuple[float, float, float, float], points: list[tuple[float, float]]
) -> None:
    line = LineIterator(*ends)
    found = []
    while line.isValid():
        found.append((line.getX(), line.getY()))
        line.advance()
    assert found == points
    length = math.dist(ends[:2], ends[2:])
    assert line.get_line_length() == pytest.approx(length)


def test_invalid_lines_are_refused() -> None:
    with pytest.raises(ValueError, match="zero length"):
        LineIterator(1, 1, 1, 1)
    with pytest.raises(ValueError, match="positive"):
        LineIterator(0, 0, 1, 1, 0)
    with pytest.raises(TypeError, match="y1"):
        LineIterator(0, 0, 1, "1")  # type: ignore[arg-type]


def test_the_cost_of_a_footprint_is_the_largest_of_its_outline() -> None:
    costmap = PyCostmap2D(grid())
    checker = FootprintCollisionChecker()
    with pytest.raises(ValueError, match="setCostmap"):
        checker.pointCost(0, 0)
    checker.setCostmap(costmap)
    assert checker.footprintCostAtPose(1.0, 4.0, 0.0, square(0.6)) == 0.0
    mx, my = costmap.worldToMapValidated(1.6, 4.2)
    assert mx is not None
    assert my is not None
    costmap.setCost(mx, my, np.uint8(60))
    assert checker.footprintCostAtPose(1.0, 4.0, 0.0, square(0.6)) == 60.0
    costmap.setCost(mx, my, np.uint8(254))
    cost = checker.footprintCostAtPose(1.0, 4.0, math.pi, square(0.6))
    assert cost == LETHAL_OBSTACLE
    outside = checker.footprintCostAtPose(-0.9, 4.0, 0.0, square(0.6))
    assert outside == LETHAL_OBSTACLE
