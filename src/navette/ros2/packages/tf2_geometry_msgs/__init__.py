"""tf2_geometry_msgs: transformation of geometry messages."""

from navette.msgs.geometry_msgs.msg import (
    PointStamped,
    PolygonStamped,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
    WrenchStamped,
)
from navette.runtime.tf.do_transform import (
    do_transform_point,
    do_transform_polygon_stamped,
    do_transform_pose,
    do_transform_pose_stamped,
    do_transform_pose_with_covariance_stamped,
    do_transform_vector3,
    do_transform_wrench_stamped,
    from_msg_msg,
    to_msg_msg,
    transform_covariance,
)
