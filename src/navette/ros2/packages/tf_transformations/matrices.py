"""Homogeneous 4 × 4 matrices."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from navette.geometry.se3 import rotation_matrix
from navette.ros2.packages.tf_transformations.quaternions import Array, unit


def identity_matrix() -> Array:
    return np.eye(4)


def translation_matrix(direction: Sequence[float]) -> Array:
    """Return the matrix of a translation (x, y, z)."""
    matrix = np.eye(4)
    matrix[:3, 3] = direction[:3]
    return matrix


def translation_from_matrix(matrix: ArrayLike) -> Array:
    """Return the translation (x, y, z) of a matrix."""
    return np.array(matrix, dtype=np.float64)[:3, 3].copy()


def quaternion_matrix(quaternion: ArrayLike) -> Array:
    """Return the matrix of a quaternion's rotation."""
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_matrix(unit(quaternion))
    return matrix


def quaternion_from_matrix(matrix: ArrayLike) -> Array:
    """Return the quaternion (w ≥ 0) of a 3 × 3 or 4 × 4 rotation matrix.

    It is the eigenvector of the largest eigenvalue of Bar-Itzhack's K, which tolerates
    rounding errors in the matrix (Bar-Itzhack 2000, eq. 10).
    """
    R = np.asarray(matrix, dtype=np.float64)[:3, :3]
    K = np.zeros((4, 4))
    K[:3, :3] = R + R.T - np.trace(R) * np.eye(3)
    K[3, :3] = K[:3, 3] = (R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1])
    K[3, 3] = np.trace(R)
    quaternion: Array = np.linalg.eigh(K)[1][:, -1]
    return -quaternion if quaternion[3] < 0 else quaternion


def concatenate_matrices(*matrices: ArrayLike) -> Array:
    """Return the product of the matrices; the last one acts first."""
    product = np.eye(4)
    for matrix in matrices:
        product = product @ np.asarray(matrix, dtype=np.float64)
    return product


def inverse_matrix(matrix: ArrayLike) -> Array:
    return np.linalg.inv(np.asarray(matrix, dtype=np.float64))
