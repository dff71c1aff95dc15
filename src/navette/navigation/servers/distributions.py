"""Fields of Nav2's interfaces whose types differ between distributions of ROS 2."""

from typing import Any

from navette.msgs.geometry_msgs.msg import PoseStamped


def poses_in(field: Any) -> list[PoseStamped]:
    """Return several poses: a list up to Jazzy, ``nav_msgs/Goals`` since Kilted."""
    return list(getattr(field, "goals", field))


def add_missed_waypoint(
    result: Any, index: int, pose: PoseStamped, error_code: int, error_msg: str
) -> None:
    """Add a waypoint to the missed ones of a result of FollowWaypoints.

    Elements are indices up to Humble, ``MissedWaypoint`` up to Jazzy,
    ``WaypointStatus`` since Kilted.
    """
    from navette.msgs.nav2_msgs import msg

    kind = result.get_fields_and_field_types()["missed_waypoints"]
    if kind.startswith("sequence<int32"):
        result.missed_waypoints.append(index)
        return
    if hasattr(msg, "WaypointStatus"):
        missed: Any = msg.WaypointStatus(
            waypoint_status=msg.WaypointStatus.FAILED,
            waypoint_index=index,
            waypoint_pose=pose,
            error_code=error_code,
            error_msg=error_msg,
        )
    else:
        missed = msg.MissedWaypoint(index=index, goal=pose, error_code=error_code)
    result.missed_waypoints = [*result.missed_waypoints, missed]
