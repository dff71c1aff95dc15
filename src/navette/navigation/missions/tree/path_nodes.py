"""Leaves about paths, goals and poses, and selectors of plugins."""

from typing import Any, ClassVar

from py_trees.common import Status

from navette.geometry import quaternion_from_yaw
from navette.msgs.geometry_msgs.msg import PoseStamped, Quaternion
from navette.msgs.nav_msgs.msg import Path
from navette.navigation.missions.tree.behaviour import (
    FAILURE,
    SUCCESS,
    LeafNode,
    Ports,
)
from navette.navigation.missions.tree.paths import (
    around,
    truncated,
    without_passed,
)
from navette.navigation.missions.tree.ports import (
    Port,
    output_port,
    parse_count,
    parse_float,
    parse_int,
    parse_message,
)


class RemovePassedGoalsNode(LeafNode):
    """Remove the first goals that the robot has passed."""

    PORTS: ClassVar[Ports] = {
        "radius": Port(parse_float, "0.5"),
        "global_frame": Port(),
        "robot_base_frame": Port(),
        "input_goals": Port(parse_message, required=True),
        "output_goals": output_port(),
        # Of Kilted's feedback, which Jazzy's messages do not have.
        "input_waypoint_statuses": Port(parse_message),
        "output_waypoint_statuses": output_port(),
    }

    def update(self) -> Status:
        pose, goals = self.robot.pose(), self.input("input_goals")
        if pose is None or goals is None:
            return FAILURE
        self.output("output_goals", without_passed(goals, pose, self.input("radius")))
        return SUCCESS


class AppendGoalPoseToGoalsNode(LeafNode):
    """Add a goal to the end of a list."""

    PORTS: ClassVar[Ports] = {
        "goal_pose": Port(parse_message, required=True),
        "input_goals": Port(parse_message),
        "output_goals": output_port(),
    }

    def update(self) -> Status:
        goal = self.input("goal_pose")
        if goal is None:
            return FAILURE
        self.output("output_goals", [*(self.input("input_goals") or ()), goal])
        return SUCCESS


class GetNextFewGoalsNode(LeafNode):
    """Keep the first goals of a list."""

    PORTS: ClassVar[Ports] = {
        "input_goals": Port(parse_message, required=True),
        "num_goals": Port(parse_count, required=True),
        "output_goals": output_port(),
    }

    def update(self) -> Status:
        goals = self.input("input_goals")
        if not goals:
            return FAILURE
        self.output("output_goals", list(goals[: self.input("num_goals")]))
        return SUCCESS


class TruncatePathNode(LeafNode):
    """Remove the end of a path."""

    PORTS: ClassVar[Ports] = {
        "input_path": Port(parse_message, required=True),
        "output_path": output_port(),
        "distance": Port(parse_float, "1.0"),
    }

    def update(self) -> Status:
        path = self.input("input_path")
        if path is None:
            return FAILURE
        self.output("output_path", truncated(path, self.input("distance")))
        return SUCCESS


class TruncatePathLocalNode(LeafNode):
    """Keep the part of a path around the robot."""

    PORTS: ClassVar[Ports] = {
        "input_path": Port(parse_message, required=True),
        "output_path": output_port(),
        "distance_forward": Port(parse_float, "8.0"),
        "distance_backward": Port(parse_float, "4.0"),
        "robot_frame": Port(default="base_link"),
        "robot_base_frame": Port(),
        "transform_tolerance": Port(parse_float, "0.2"),
        "pose": Port(parse_message),
        "angular_distance_weight": Port(parse_float, "0.0"),
        "max_robot_pose_search_dist": Port(parse_float, "inf"),
    }

    def update(self) -> Status:
        path, pose = self.input("input_path"), self.robot.pose()
        if path is None or pose is None:
            return FAILURE
        ahead, behind = self.input("distance_forward"), self.input("distance_backward")
        self.output("output_path", around(path, pose, ahead_m=ahead, behind_m=behind))
        return SUCCESS


class GetPoseFromPathNode(LeafNode):
    """Pick a pose of a path; negative indices count from the end."""

    PORTS: ClassVar[Ports] = {
        "path": Port(parse_message, required=True),
        "index": Port(parse_int, "0"),
        "pose": output_port(),
    }

    def update(self) -> Status:
        path, index = self.input("path"), self.input("index")
        if path is None or not -len(path.poses) <= index < len(path.poses):
            return FAILURE
        pose = path.poses[index].pose
        self.output("pose", PoseStamped(header=path.header, pose=pose))
        return SUCCESS


class GetCurrentPoseNode(LeafNode):
    """Store the robot's pose."""

    PORTS: ClassVar[Ports] = {
        "global_frame": Port(),
        "robot_base_frame": Port(),
        "current_pose": output_port(),
    }

    def update(self) -> Status:
        pose = self.robot.pose()
        if pose is None:
            return FAILURE
        msg = PoseStamped()
        msg.header.frame_id = self.robot.map_frame
        msg.pose.position.x, msg.pose.position.y = pose.x, pose.y
        x, y, z, w = quaternion_from_yaw(pose.yaw)
        msg.pose.orientation = Quaternion(x=x, y=y, z=z, w=w)
        self.output("current_pose", msg)
        return SUCCESS


class ConcatenatePathsNode(LeafNode):
    """Join two paths."""

    PORTS: ClassVar[Ports] = {
        "input_path1": Port(parse_message),
        "input_path2": Port(parse_message),
        "output_path": output_port(),
    }

    def update(self) -> Status:
        paths = [self.input("input_path1"), self.input("input_path2")]
        given = [path for path in paths if path is not None and path.poses]
        if not given:
            return FAILURE
        poses = [pose for path in given for pose in path.poses]
        self.output("output_path", Path(header=given[0].header, poses=poses))
        return SUCCESS


class SelectorNode(LeafNode):
    """Choose a plugin by the newest message of a topic."""

    WHAT: ClassVar[str]

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        cls.PORTS = {
            "topic_name": Port(default=f"{cls.WHAT}_selector"),
            f"default_{cls.WHAT}": Port(),
            f"selected_{cls.WHAT}": output_port(),
        }

    def update(self) -> Status:
        newest = self.robot.newest(
            self.input("topic_name"), "std_msgs/msg/String", latched=True
        )
        default = self.input(f"default_{self.WHAT}")
        selected = default if newest is None else newest.data
        if not selected:
            self.feedback_message = f"no default_{self.WHAT}, no message"
            return FAILURE
        self.output(f"selected_{self.WHAT}", selected)
        return SUCCESS


class PlannerSelectorNode(SelectorNode):
    """Choose the planner."""

    WHAT = "planner"


class ControllerSelectorNode(SelectorNode):
    """Choose the controller."""

    WHAT = "controller"


class SmootherSelectorNode(SelectorNode):
    """Choose the smoother."""

    WHAT = "smoother"


class PathHandlerSelectorNode(SelectorNode):
    """Choose the path handler; control has one, whatever is chosen."""

    WHAT = "path_handler"


class GoalCheckerSelectorNode(SelectorNode):
    """Choose the goal checker."""

    WHAT = "goal_checker"


class ProgressCheckerSelectorNode(SelectorNode):
    """Choose the progress checker."""

    WHAT = "progress_checker"
