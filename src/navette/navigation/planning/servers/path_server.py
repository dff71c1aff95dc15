"""Nav2's planner server: compute_path_to_pose, …_through_poses, is_path_valid.

The requests are answered from the newest map. They have no effect on the goal that is
being driven. A request that is cancelled ends at once, also while its path is computed.
"""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from navette.geometry import Pose2
from navette.msgs.geometry_msgs.msg import PoseStamped
from navette.msgs.known_fields import fill
from navette.msgs.nav2_msgs.action import ComputePathThroughPoses, ComputePathToPose
from navette.msgs.nav2_msgs.srv import IsPathValid
from navette.msgs.nav_msgs.msg import Path
from navette.navigation.planning.methods import PLANNERS
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.path_queries import (
    PlannedRoute,
    blocked_poses,
    plan_through,
)
from navette.navigation.planning.planner import Goal, Planner
from navette.navigation.planning.servers.planning_host import (
    PlanningHost,
    path_on_map,
)
from navette.navigation.servers.distributions import poses_in
from navette.runtime import Stopwatch
from navette.runtime.input_check import FARTHEST
from navette.runtime.node import Node
from navette.runtime.stage.goal_server import (
    Activation,
    GoalEnd,
    GoalServer,
    GoalStepper,
    goal_end,
)
from navette.runtime.stage.path_messages import (
    has_heading,
    path_message,
    pose_of,
)
from navette.runtime.time import Duration

DEFAULT_PLANNER = "GridBased"
"""Name of the configured planner, as in Nav2's default parameters."""

_ERRORS = {
    Outcome.START_BLOCKED: "START_OCCUPIED",
    Outcome.START_OUTSIDE_MAP: "START_OUTSIDE_MAP",
    Outcome.GOAL_BLOCKED: "GOAL_OCCUPIED",
    Outcome.GOAL_OUTSIDE_MAP: "GOAL_OUTSIDE_MAP",
    Outcome.GOAL_NOT_FINITE: "GOAL_OUTSIDE_MAP",
    Outcome.NO_PATH: "NO_VALID_PATH",
    Outcome.SEARCH_LIMIT: "TIMEOUT",
    Outcome.METHOD_FAILED: "UNKNOWN",
}


class _RequestError(Exception):
    """A request without a path: the name of Nav2's error code, and the reason."""

    def __init__(self, code: str, reason: str) -> None:
        super().__init__(reason)
        self.code = code


class _PathRequest(NamedTuple):
    """Arguments of plan_through."""

    planner: Planner
    start: Pose2
    goals: list[Goal]


class PathServer:
    """The actions that compute paths, and the service that checks one."""

    def __init__(
        self, node: Node, *, host: PlanningHost, activation: Activation
    ) -> None:
        self._host = host
        self.node = node
        for action, name in (
            (ComputePathToPose, "compute_path_to_pose"),
            (ComputePathThroughPoses, "compute_path_through_poses"),
        ):
            _PathAction(self, action, name, activation)
        node.create_service(IsPathValid, "is_path_valid", self._check_path)

    def compute(self, server: GoalServer, action: Any, goal: Any) -> None:
        """Compute the result in the worker, unless the goal ends before."""
        timer = Stopwatch()
        active = server.goal

        map_frame = self._host.params.map_frame
        now_ns = self.node.get_clock().now().nanoseconds

        def compute() -> tuple[PlannedRoute, Path]:
            route = plan_through(*request)
            return route, path_message(route.poses, map_frame, now_ns)

        def finish(computed: tuple[PlannedRoute, Path]) -> None:
            route, path = computed
            try:
                _check(route, request)
            except _RequestError as error:
                server.end(self._refused(action, error))
                return
            planning_time = Duration(seconds=timer.elapsed_s).to_msg()
            self._host.publish_plan(path)
            server.end(goal_end(action, path=path, planning_time=planning_time))

        try:
            request = self._request(goal)
        except _RequestError as error:
            server.end(self._refused(action, error))
            return
        self._host.worker.run(
            compute,
            finish,
            is_dropped=lambda: server.goal is not active,
        )

    def _refused(self, action: Any, error: _RequestError) -> GoalEnd:
        self.node.get_logger().warning(f"path request: {error.code}: {error}")
        return goal_end(action, error.code, str(error))

    def _request(self, goal: Any) -> _PathRequest:
        planner, goals = self._planner(goal.planner_id), _goals_of(goal)
        if not goals:
            raise _RequestError("NO_VIAPOINTS_GIVEN", "no goals given")
        start = self._on_map(goal.start, "start") if goal.use_start else self._robot()
        targets = [self._target(each) for each in goals]
        return _PathRequest(planner.copy(), start, targets)

    def _planner(self, planner_id: str) -> Planner:
        params = self._host.params
        if planner_id not in ("", DEFAULT_PLANNER, params.method, *PLANNERS):
            known = ", ".join((DEFAULT_PLANNER, *PLANNERS))
            raise _RequestError(
                "INVALID_PLANNER",
                f"planner_id {planner_id!r} is unknown; known: {known}",
            )
        planner = self._host.planner_with_map()
        if planner is None:
            raise _RequestError("TIMEOUT", "no map has arrived yet")
        if planner_id in ("", DEFAULT_PLANNER, params.method):
            return planner
        return planner.with_params(replace(params, method=planner_id))

    def _robot(self) -> Pose2:
        robot = self._host.fresh_pose()
        if robot is None:
            raise _RequestError(
                "TF_ERROR", "the robot's pose is unknown or stale: no recent odometry"
            )
        return robot

    def _target(self, msg: PoseStamped) -> Goal:
        x, y, yaw = self._on_map(msg, "goal")
        return Goal(x, y, yaw if has_heading(msg.pose) else None)

    def _on_map(self, msg: PoseStamped, name: str) -> Pose2:
        frame_id = msg.header.frame_id or self._host.params.map_frame
        map_T_frame = self._host.frame_on_map(frame_id)
        if map_T_frame is None:
            raise _RequestError(
                "TF_ERROR",
                f"{name} in unknown frame {frame_id!r}; expected a frame on /tf",
            )
        pose = pose_of(msg.pose)
        if not (np.abs(pose) <= FARTHEST).all():
            return pose  # refused by the planner
        return map_T_frame @ pose

    def _check_path(self, request: Any, response: Any) -> Any:
        host = self._host
        planner, poses = host.planner_with_map(), path_on_map(host, request.path)
        if planner is None or poses is None or len(poses) == 0:
            return response
        blocked = blocked_poses(planner, poses, host.fresh_pose())
        fill(response, success=True)
        response.is_valid = len(blocked) == 0
        response.invalid_pose_indices = blocked.tolist()
        return response


class _PathAction(GoalStepper):
    """One of the actions that compute paths."""

    def __init__(
        self, path_server: PathServer, action: Any, name: str, activation: Activation
    ) -> None:
        self._path_server, self._action = path_server, action
        self._server = GoalServer(
            path_server.node, action, name, owner=self, activation=activation
        )

    def on_goal(self, request: Any) -> None:
        self._path_server.compute(self._server, self._action, request)

    def on_cancel(self) -> None:
        self._server.end(goal_end(self._action))


def _goals_of(goal: Any) -> list[PoseStamped]:
    """Return the poses to plan through: those of either action's goal."""
    if isinstance(goal, ComputePathThroughPoses.Goal):
        return poses_in(goal.goals)
    return [*getattr(goal, "viapoints", ()), goal.goal]


def _check(route: PlannedRoute, request: _PathRequest) -> None:
    """Raise the error of a route without poses."""
    if route.outcome.has_path:
        return
    start, goals = request.start, request.goals
    goal = goals[route.leg]
    which = f"goal {route.leg + 1} of {len(goals)}" if len(goals) > 1 else "goal"
    raise _RequestError(
        _ERRORS[route.outcome],
        f"{route.outcome} (start ({start.x:.6g}, {start.y:.6g}), {which} "
        f"({goal.x:.6g}, {goal.y:.6g})) {route.fault}".rstrip(),
    )
