"""tf2_sensor_msgs: transformation of point clouds.

Importing this package registers PointCloud2 for ``buffer.transform``.
"""

import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

from navette.geometry.se3 import rotation_matrix
from navette.msgs import copy_message
from navette.msgs.geometry_msgs.msg import Transform, TransformStamped
from navette.msgs.sensor_msgs.msg import PointCloud2
from navette.msgs.std_msgs.msg import Header
from navette.ros2.packages.sensor_msgs_py.point_cloud2 import (
    PointCloudError,
    dtype_from_fields,
    read_points,
)
from navette.runtime.tf.do_transform import from_msg_msg, to_msg_msg
from navette.runtime.tf.registration import ConvertRegistration, TransformRegistration

__all__ = ["do_transform_cloud", "from_msg_msg", "to_msg_msg", "transform_points"]


def transform_points(
    point_cloud: NDArray[Any], transform: Transform
) -> NDArray[np.float64]:
    """Transform points: p_a = R·p_b + t.

    Args:
        point_cloud: (N, 3) points (m) in b.
        transform: a_T_b.

    Returns:
        (N, 3) points (m) in a.
    """
    t, q = transform.translation, transform.rotation
    R = rotation_matrix((q.x, q.y, q.z, q.w))
    transformed: NDArray[np.float64] = point_cloud @ R.T + (t.x, t.y, t.z)
    return transformed


def do_transform_cloud(
    cloud: PointCloud2, transform: Transform | TransformStamped
) -> PointCloud2:
    """Return the cloud with x, y and z in the transform's frame.

    The stamp and other fields do not change. The cloud's frame becomes the frame of a
    TransformStamped; a Transform has none.

    Raises:
        PointCloudError: the cloud has no field x, y or z.
    """
    header = Header(stamp=cloud.header.stamp, frame_id=cloud.header.frame_id)
    if isinstance(transform, TransformStamped):
        header.frame_id = transform.header.frame_id
        transform = transform.transform
    names = dtype_from_fields(cloud.fields, cloud.point_step).names or ()
    if not {"x", "y", "z"} <= set(names):
        raise PointCloudError(
            "the transformation requires the fields x, y and z; the cloud has "
            f"{', '.join(names)}"
        )
    points = read_points(cloud).copy()  # native byte order, no padding of rows
    xyz = np.stack([points[axis] for axis in "xyz"], axis=-1)
    for axis, column in zip("xyz", transform_points(xyz, transform).T, strict=True):
        points[axis] = column
    return PointCloud2(
        header=header,
        height=cloud.height,
        width=cloud.width,
        fields=[copy_message(field) for field in cloud.fields],
        is_bigendian=sys.byteorder != "little",
        point_step=cloud.point_step,
        row_step=cloud.point_step * cloud.width,
        data=points.tobytes(),
        is_dense=cloud.is_dense,
    )


TransformRegistration().add(PointCloud2, do_transform_cloud)
ConvertRegistration().add_to_msg(PointCloud2, to_msg_msg)
ConvertRegistration().add_from_msg(PointCloud2, from_msg_msg)
