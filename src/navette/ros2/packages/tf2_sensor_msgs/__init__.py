"""tf2_sensor_msgs: transformation of point clouds."""

from navette.ros2.packages.tf2_sensor_msgs.tf2_sensor_msgs import (
    do_transform_cloud,
    from_msg_msg,
    to_msg_msg,
    transform_points,
)

__all__ = ["do_transform_cloud", "from_msg_msg", "to_msg_msg", "transform_points"]
