"""Nav2's smoother server: the action smooth_path."""

from typing import Any

from navette.msgs.nav2_msgs.action import SmoothPath
from navette.navigation.planning.footprint_check import check_path
from navette.navigation.planning.path_shape import lengths
from navette.navigation.planning.path_smoothing import smooth_path
from navette.navigation.planning.servers.planning_host import (
    PlanningHost,
    path_on_map,
)
from navette.runtime import Stopwatch
from navette.runtime.node import Node
from navette.runtime.stage.goal_server import (
    Activation,
    GoalEnd,
    GoalServer,
    GoalStepper,
    goal_end,
)
from navette.runtime.stage.path_messages import path_message
from navette.runtime.time import Duration

SMOOTHERS = ("", "simple_smoother")
"""The empty name selects the only one; the other is that of Nav2's parameters."""

_MOST_POSES = 100_000


class SmootherServer(GoalStepper):
    """Smooths the path of a goal on the newest map.

    A goal ends at once: before a request to cancel it could arrive.
    """

    def __init__(
        self, node: Node, *, host: PlanningHost, activation: Activation
    ) -> None:
        self._node = node
        self._host = host
        self._server = GoalServer(
            node, SmoothPath, "smooth_path", owner=self, activation=activation
        )

    def on_goal(self, request: Any) -> None:
        timer = Stopwatch()
        end = self._smoothed(request)
        end.result.smoothing_duration = Duration(seconds=timer.elapsed_s).to_msg()
        self._server.finish(end)

    def _refused(self, code: str, reason: str, **fields: Any) -> GoalEnd:
        self._node.get_logger().warning(f"smooth_path: {reason}")
        return goal_end(SmoothPath, code, reason, **fields)

    def _smoothed(self, goal: Any) -> GoalEnd:
        if goal.smoother_id not in SMOOTHERS:
            text = f"smoother_id {goal.smoother_id!r}: unknown; known: {SMOOTHERS[1]}"
            return self._refused("INVALID_SMOOTHER", text)
        params, planner = self._host.params, self._host.planner_with_map()
        poses = path_on_map(self._host, goal.path)
        if poses is None or len(poses) == 0:
            text = "the path is empty, not finite, or in an unknown frame"
            return self._refused("INVALID_PATH", text)
        if planner is None:
            text = "no map has arrived yet"
            return self._refused("FAILED_TO_SMOOTH_PATH", text)
        grid = planner.grid()
        if lengths(poses).sum() > _MOST_POSES * params.path_spacing_m:
            text = f"the path is longer than {_MOST_POSES} poses of path_spacing_m"
            return self._refused("INVALID_PATH", text)
        poses = smooth_path(poses, grid, planner.body, params.path_spacing_m)
        stamp_ns = self._node.get_clock().now().nanoseconds
        path = path_message(poses, params.map_frame, stamp_ns)
        if goal.check_for_collisions:
            check = check_path(poses, grid, planner.body, 0.0)
            if not check.fits:
                text = f"the smoothed path is in collision at pose {check.first_bad}"
                return self._refused("SMOOTHED_PATH_IN_COLLISION", text, path=path)
        return goal_end(SmoothPath, path=path, was_completed=True)
