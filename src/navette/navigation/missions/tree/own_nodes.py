"""Leaves of Navette: drive with planner and control, back up, avoid a place."""

from typing import Any, ClassVar

from py_trees.common import Status

from navette.navigation.missions.tree.behaviour import (
    FAILURE,
    SUCCESS,
    Ports,
)
from navette.navigation.missions.tree.calls import (
    SERVER_PORTS,
    ActionLeaf,
    CallLeaf,
    MissingInputError,
    ServiceLeaf,
)
from navette.navigation.missions.tree.ports import (
    Port,
    parse_float,
    parse_message,
    parse_milliseconds,
)
from navette.navigation.missions.tree.robot_access import CallResult, ServerCall


class NavigateNode(CallLeaf):
    """Navette: drive to the goal by planner and control, which run on their own.

    Fails with a named ``failure`` such as ``stuck`` or ``no_path``.
    """

    PORTS: ClassVar[Ports] = {
        "goal": Port(parse_message, entry="goal"),
        "failure": Port(parse_message, output=True, entry="failure"),
        "error_code_id": Port(parse_message, output=True, entry="navigate_error_code"),
        "error_msg": Port(parse_message, output=True, entry="navigate_error_msg"),
    }

    def start(self) -> ServerCall:
        self._goal = self.needed("goal")
        return self.robot.navigate(self._goal)

    def needs_restart(self) -> bool:
        goal = self.input("goal")
        return goal is not None and goal is not self._goal

    def succeeded(self, message: Any) -> None:
        self._report("", 0, "")

    def failed(self, result: CallResult) -> None:
        self._report(str(result.message), ERROR_CODES.get(str(result.message), 200),
                     result.reason)  # fmt: skip

    def _report(self, failure: str, code: int, text: str) -> None:
        self.output("failure", failure)
        self.output("error_code_id", code)
        self.output("error_msg", text)


class BackUpAlongPathNode(ActionLeaf):
    """Navette: drive back along the path that the robot came."""

    ACTION, SERVER, IS_RECOVERY = "FollowPath", "follow_path", True
    PORTS: ClassVar[Ports] = {
        "distance": Port(parse_float, "0.5"),
        **SERVER_PORTS,
    }

    def goal(self) -> Any:
        path = self.robot.driven_path(self.input("distance"))
        if path is None:
            raise MissingInputError("no driven path: the robot has not moved yet")
        return self.new_goal(path=path)


class AvoidPlaceNode(ServiceLeaf):
    """Navette: plan around the place where the robot got stuck; fail without one."""

    TYPE, IS_RECOVERY = "std_srvs/srv/Trigger", True
    PORTS: ClassVar[Ports] = {
        "service_name": Port(default="/planner/avoid_place"),
        "server_timeout": Port(parse_milliseconds),
    }

    def update(self) -> Status:
        status = super().update()
        if status is not SUCCESS or self._call is None or self._call.result is None:
            return status
        self.feedback_message = self._call.result.message.message
        return SUCCESS if self._call.result.message.success else FAILURE


ERROR_CODES = {
    "unknown_frame": 202,
    "start_outside_map": 203,
    "goal_outside_map": 204,
    "start_blocked": 205,
    "goal_blocked": 206,
    "search_limit": 207,
    "no_path": 208,
    "goal_not_finite": 200,
    "goal_orientation_invalid": 200,
    "goal_stamp_invalid": 200,
    "stale_odometry": 102,
    "lost": 102,
    "stuck": 105,
    "timed_out": 107,
}
"""Nav2's codes (ComputePathToPose, FollowPath) of the planner's failures."""
