"""Calls every Nav2 server of the stack with the definitions of ``NAVETTE_DISTRO``.

Prints one line for each action and service: its name and how the call ended. All in one
process in virtual time, with a simulated robot in a room.
"""

import sys
from typing import Any

from navette import ActionClient, Context, Node
from navette.geometry import Pose2
from navette.msgs import get_interface
from navette.msgs.action_msgs.msg import GoalStatus
from navette.msgs.builtin_interfaces.msg import Duration
from navette.msgs.geometry_msgs.msg import Point, PoseStamped
from navette.msgs.known_fields import several_poses
from navette.msgs.nav2_msgs.action import ComputePathThroughPoses, NavigateThroughPoses
from navette.navigation.stack.robot import simulate_robot
from navette.navigation.stack.stack import NavigationStack
from navette.ros2.packages.nav2_simple_commander.robot_navigator import BasicNavigator
from navette.runtime import Executor, VirtualClock
from navette.runtime.stage.path_messages import pose_message
from navette.sim import World

LIMIT_NS = 60 * 10**9


def write(*parts: object) -> None:
    sys.stdout.write(" ".join(map(str, parts)).rstrip() + "\n")


class Caller:
    """A client of the stack, which runs in the same context."""

    def __init__(self) -> None:
        self.context = Context(clock=VirtualClock(), transport="inprocess")
        scene = World("room").add_walls((12.0, 12.0)).scene()
        self.node = Node("caller", context=self.context)
        sim = simulate_robot(
            scene, "jackal", start=Pose2(0, 0, 0), context=self.context
        )
        stack = NavigationStack.create(self.context)
        self.executor = Executor(context=self.context)
        for node in (self.node, sim, *stack.nodes):
            self.executor.add_node(node)
        self.executor.spin_for(5 * 10**9)

    def act(self, kind: str, name: str, **goal: Any) -> Any:
        """Send a goal; return the response."""
        action = get_interface(f"nav2_msgs/action/{kind}")
        client = ActionClient(self.node, action, name)
        feedback: list[Any] = []
        sent = client.send_goal_async(
            action.Goal(**goal), feedback_callback=feedback.append
        )
        assert self.executor.spin_until_complete(sent, LIMIT_NS), f"{name}: no reply"
        handle: Any = sent.result()
        assert handle.accepted, f"{name}: rejected"
        future = handle.get_result_async()
        assert self.executor.spin_until_complete(future, LIMIT_NS), f"{name}: no end"
        response: Any = future.result()
        status = GoalStatus.STATUS_SUCCEEDED
        how = "succeeded" if response.status == status else f"ended {response.status}"
        text = getattr(response.result, "error_msg", "")
        write(f"{name}: {how}", f"({text})" if text else "")
        client.destroy()
        return response

    def call(self, kind: str, name: str, **request: Any) -> Any:
        """Call a service; return the response."""
        service = get_interface(f"nav2_msgs/srv/{kind}")
        client = self.node.create_client(service, name)
        future = client.call_async(service.Request(**request))
        assert self.executor.spin_until_complete(future, LIMIT_NS), f"{name}: no reply"
        response = future.result()
        write(f"{name}: {getattr(response, 'success', 'done')}")
        return response


def stamped(x: float, y: float) -> PoseStamped:
    pose = PoseStamped(pose=pose_message(Pose2(x, y, 0.0)))
    pose.header.frame_id = "map"
    return pose


def main() -> None:
    caller = Caller()
    here = [stamped(1.0, 0.0), stamped(1.5, 0.5)]
    path = caller.act("ComputePathToPose", "compute_path_to_pose", goal=here[0])
    caller.act(
        "ComputePathThroughPoses",
        "compute_path_through_poses",
        goals=several_poses(ComputePathThroughPoses.Goal, "goals", here),
    )
    caller.act("SmoothPath", "smooth_path", path=path.result.path)
    caller.act("SmoothPath", "smooth_path", path=path.result.path, smoother_id="none")
    caller.act("FollowPath", "follow_path", path=path.result.path)
    caller.act("FollowPath", "follow_path", path=path.result.path, controller_id="none")
    caller.act("Spin", "spin", target_yaw=0.5)
    caller.act("BackUp", "backup", target=Point(x=0.2), speed=0.2)
    caller.act("DriveOnHeading", "drive_on_heading", target=Point(x=0.2), speed=0.2)
    caller.act("DriveOnHeading", "drive_on_heading", target=Point(x=90.0), speed=0.2)
    caller.act("Wait", "wait")
    caller.act("AssistedTeleop", "assisted_teleop", time_allowance=Duration(sec=1))
    caller.act("NavigateToPose", "navigate_to_pose", pose=here[1])
    caller.act(
        "NavigateToPose", "navigate_to_pose", pose=here[1], behavior_tree="/no/tree.xml"
    )
    caller.act(
        "NavigateThroughPoses",
        "navigate_through_poses",
        poses=several_poses(NavigateThroughPoses.Goal, "poses", here),
    )
    missed = [stamped(0.0, 0.0), stamped(90.0, 90.0)]
    caller.act("FollowWaypoints", "follow_waypoints", poses=missed)
    for name in ("global_costmap", "local_costmap"):
        for kind, service in (
            ("ClearEntireCostmap", "clear_entirely"),
            ("ClearCostmapAroundRobot", "clear_around"),
            ("ClearCostmapExceptRegion", "clear_except"),
        ):
            caller.call(kind, f"/{name}/{service}_{name}")
        caller.call("GetCostmap", f"/{name}/get_costmap")
    valid = caller.call("IsPathValid", "/is_path_valid", path=path.result.path)
    write("is_path_valid:", valid.is_valid)
    command(caller, here)


def command(caller: Caller, here: list[PoseStamped]) -> None:
    """Do the same with BasicNavigator, which chooses the fields itself."""
    navigator = BasicNavigator(context=caller.context)
    caller.executor.add_node(navigator)
    path = navigator.getPathThroughPoses(here[0], here)
    write("commander, path:", path is not None)
    for name, start in (
        ("through", lambda: navigator.goThroughPoses(here)),
        ("waypoints", lambda: navigator.followWaypoints(here)),
        ("follow", lambda: navigator.followPath(path)),
    ):
        assert start(), f"{name}: rejected"
        while not navigator.isTaskComplete():
            pass
        write(f"commander, {name}:", navigator.getResult().name)
    navigator.clearAllCostmaps()


if __name__ == "__main__":
    main()
