"""Services of one of Nav2's costmaps: clear it, get it, get a cost of it."""

from typing import Any, Protocol

import numpy as np

from navette.geometry import Footprint, Pose2
from navette.msgs.known_fields import fill
from navette.msgs.nav2_msgs.srv import (
    ClearCostmapAroundPose,
    ClearCostmapAroundRobot,
    ClearCostmapExceptRegion,
    ClearEntireCostmap,
    GetCost,
    GetCostmap,
)
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.navigation.grids import (
    SquareRegion,
    cells_in_footprint,
    grid_from_message,
)
from navette.navigation.grids.costmap_values import costmap_message, costmap_values
from navette.runtime.node import Node
from navette.runtime.stage.path_messages import pose_of

_OUTSIDE = -1.0


class CostmapSource(Protocol):
    """The node whose costmap the services offer."""

    def newest_grid(self) -> OccupancyGrid | None:
        """Return the newest grid; None before the first."""

    def clear_costmap(self, region: SquareRegion | None) -> None:
        """Clear a region, or everything for None."""

    def robot_on_grid(self) -> Pose2 | None:
        """Return the pose of the robot's base in the grid's frame; None if unknown."""

    def frame_on_grid(self, frame_id: str) -> Pose2 | None:
        """Return the pose of a frame in the grid's frame; None if unknown."""

    @property
    def footprint(self) -> Footprint | None:
        """The robot's outline in the frame of its base; None if unknown."""


class CostmapServices:
    """The services of a costmap, under Nav2's names and BasicNavigator's.

    Args:
        node: the node that offers them.
        name: ``local_costmap`` or ``global_costmap``.
        source: the costmap.
    """

    def __init__(self, node: Node, name: str, *, source: CostmapSource) -> None:
        self._node, self._name, self._source = node, name, source
        for service, names, callback in (
            (ClearEntireCostmap, (f"clear_entirely_{name}",), self._clear_all),
            (
                ClearCostmapAroundRobot,
                (f"clear_around_{name}", "clear_costmap_around_robot"),
                self._clear_around_robot,
            ),
            (
                ClearCostmapAroundPose,
                (f"clear_around_pose_{name}", "clear_costmap_around_pose"),
                self._clear_around_pose,
            ),
            (
                ClearCostmapExceptRegion,
                (f"clear_except_{name}", "clear_costmap_except_region"),
                self._clear_except,
            ),
            (GetCostmap, ("get_costmap",), self._get_costmap),
            (GetCost, (f"get_cost_{name}",), self._get_cost),
        ):
            for each in names:
                node.create_service(service, f"{name}/{each}", callback)

    def _clear_all(self, request: Any, response: Any) -> Any:
        self._node.get_logger().info(f"{self._name}: cleared on request")
        self._source.clear_costmap(None)
        fill(response, success=True)  # since Lyrical; also below
        return response

    def _clear_around_robot(self, request: Any, response: Any) -> Any:
        robot = self._robot()
        if robot is not None:
            cleared = self._clear(robot, request.reset_distance)
            fill(response, success=cleared)
        return response

    def _clear_around_pose(self, request: Any, response: Any) -> Any:
        frame_id = request.pose.header.frame_id
        grid_T_frame = self._source.frame_on_grid(frame_id)
        pose = pose_of(request.pose.pose)
        if grid_T_frame is None or not np.isfinite(pose).all():
            text = f"{self._name}: pose {tuple(pose)} in frame {frame_id!r}"
            self._node.get_logger().error(
                f"{text} not used; expected finite values and a frame on /tf"
            )
        else:
            cleared = self._clear(grid_T_frame @ pose, request.reset_distance)
            fill(response, success=cleared)
        return response

    def _clear_except(self, request: Any, response: Any) -> Any:
        robot = self._robot()
        if robot is not None:
            cleared = self._clear(robot, request.reset_distance, outside=True)
            fill(response, success=cleared)
        return response

    def _clear(self, at: Pose2, edge: float, *, outside: bool = False) -> bool:
        """Clear a square; return whether its edge is valid."""
        if not (np.isfinite(edge) and edge >= 0):
            self._node.get_logger().error(
                f"{self._name}: reset_distance {edge} not used; must be finite and >= 0"
            )
            return False
        self._node.get_logger().info(
            f"{self._name}: cleared {'all but ' if outside else ''}{edge:g} m "
            f"around ({at.x:.6g}, {at.y:.6g})"
        )
        self._source.clear_costmap(SquareRegion(at.x, at.y, edge, outside))
        return True

    def _robot(self) -> Pose2 | None:
        robot = self._source.robot_on_grid()
        if robot is None:
            self._node.get_logger().error(
                f"{self._name}: not cleared: the robot's pose is unknown"
            )
        return robot

    def _get_costmap(self, request: Any, response: Any) -> Any:
        grid = self._source.newest_grid()
        if grid is not None:
            response.map = costmap_message(grid)
        return response

    def _get_cost(self, request: Any, response: Any) -> Any:
        """Return the cost (0 … 255) at a point, or the highest under the footprint."""
        pose = Pose2(request.x, request.y, request.theta)
        response.cost = _OUTSIDE
        grid = self._source.newest_grid()
        if grid is None or not np.isfinite(pose).all():
            return response
        cells, spec = grid_from_message(grid)
        cell = spec.cell_of(pose.x, pose.y)
        if not spec.contains(*cell):
            return response
        values = costmap_values(cells)
        response.cost = float(values[cell])
        footprint = self._source.footprint
        if request.use_footprint and footprint is not None:
            under = cells_in_footprint(footprint, pose, spec)
            costs = values[under[:, 0], under[:, 1]]
            response.cost = float(costs.max(initial=response.cost))
        return response
