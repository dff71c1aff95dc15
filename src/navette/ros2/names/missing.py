"""Advice for programs that import a package of ROS that Navette does not provide."""

from navette.msgs.registry import PATH_VARIABLE

_ROS_1 = frozenset(
    "actionlib catkin dynamic_reconfigure genpy nodelet rosbag roscpp roslaunch roslib "
    "rosmsg rosnode rosparam rospkg rospy rosservice rostest rostopic tf".split()
)
_INTERFACES = ("_msgs", "_interfaces", "_msg", "_srvs", "_actions")
#: Package of ROS 2 → what to use instead.
_ROS_2 = {
    "ament_copyright": "leave the linters' tests out",
    "ament_flake8": "leave the linters' tests out",
    "ament_pep257": "leave the linters' tests out",
    "ros2node": "navette's commands do the same: navette node --help",
    "ros2param": "navette's commands do the same: navette param --help",
    "ros2service": "navette's commands do the same: navette service --help",
    "xacro": "pip install xacro",
}


def advice(module: str) -> str | None:
    """Return the advice for a program that imports ``module``; None if not ROS's."""
    top = module.partition(".")[0]
    if top in _ROS_1:
        return (
            f"{top} belongs to ROS 1; docs/reference/idioms.md lists the equivalents "
            "in Navette"
        )
    if top in _ROS_2:
        return f"Navette does not provide {top}; instead: {_ROS_2[top]}"
    if top.endswith(_INTERFACES):
        return (
            f"no package {top} with msg/, srv/ or action/ is in the workspace "
            f"(the folder navette was started in, NAVETTE_PATH) or on {PATH_VARIABLE}"
        )
    return None
