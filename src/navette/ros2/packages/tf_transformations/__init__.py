"""tf_transformations: Euler angles, quaternions (x, y, z, w) and 4 × 4 matrices."""

from navette.ros2.packages.tf_transformations.euler import (
    euler_from_matrix,
    euler_from_quaternion,
    euler_matrix,
    quaternion_from_euler,
)
from navette.ros2.packages.tf_transformations.matrices import (
    concatenate_matrices,
    identity_matrix,
    inverse_matrix,
    quaternion_from_matrix,
    quaternion_matrix,
    translation_from_matrix,
    translation_matrix,
)
from navette.ros2.packages.tf_transformations.quaternions import (
    quaternion_about_axis,
    quaternion_conjugate,
    quaternion_inverse,
    quaternion_multiply,
    quaternion_slerp,
)

__all__ = [
    "concatenate_matrices",
    "euler_from_matrix",
    "euler_from_quaternion",
    "euler_matrix",
    "identity_matrix",
    "inverse_matrix",
    "quaternion_about_axis",
    "quaternion_conjugate",
    "quaternion_from_euler",
    "quaternion_from_matrix",
    "quaternion_inverse",
    "quaternion_matrix",
    "quaternion_multiply",
    "quaternion_slerp",
    "translation_from_matrix",
    "translation_matrix",
]
