"""A program as Nav2's users write it: drive to poses, cancel, turn, back up."""

# ruff: noqa: T201 - what the test reads

from copy import deepcopy

import rclpy
from geometry_msgs.msg import PoseStamped
from nav2_simple_commander.robot_navigator import BasicNavigator, TaskResult
from rclpy.duration import Duration


def finish(navigator: BasicNavigator) -> TaskResult:
    while not navigator.isTaskComplete():
        feedback = navigator.getFeedback()
        if feedback and hasattr(feedback, "navigation_time"):
            assert Duration.from_msg(feedback.navigation_time) < Duration(seconds=300.0)
    return navigator.getResult()


def main() -> None:
    rclpy.init()
    navigator = BasicNavigator()
    start = PoseStamped()
    start.header.frame_id = "map"
    start.header.stamp = navigator.get_clock().now().to_msg()
    start.pose.position.x = start.pose.position.y = -7.5
    start.pose.orientation.w = 1.0
    navigator.setInitialPose(start)
    navigator.waitUntilNav2Active()

    goal = deepcopy(start)
    goal.pose.position.x = -6.0
    path = navigator.getPath(start, goal)
    print("path", len(path.poses) > 5)
    smooth = navigator.smoothPath(path)
    print("smoothed", len(smooth.poses) > 5)
    navigator.goToPose(goal)
    print("pose", finish(navigator).name)
    navigator.spin(spin_dist=1.57)
    print("spin", finish(navigator).name)
    navigator.goThroughPoses([start, goal])
    for _ in range(5):
        navigator.isTaskComplete()
    navigator.cancelTask()
    print("cancelled", finish(navigator).name)
    navigator.followWaypoints([goal])
    print("waypoints", finish(navigator).name)
    print("costmap", navigator.getGlobalCostmap().metadata.size_x > 0)
    navigator.clearAllCostmaps()
    navigator.lifecycleShutdown()
    print("end")


if __name__ == "__main__":
    main()
