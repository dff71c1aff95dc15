"""Odometry motion models: particles moved as the odometry, with its errors.

Thrun, Burgard, Fox, "Probabilistic Robotics" (2005), section 5.4; parameters as those
of Nav2's AMCL.
"""

import math

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, angle_difference, wrap_angles

# Shorter translations have no direction.
_LEAST_M = 0.01

Alphas = tuple[float, float, float, float, float]


def move_differential(
    particles: NDArray[np.float64],
    motion: Pose2,
    alphas: Alphas,
    rng: np.random.Generator,
) -> None:
    """Move particles (N, 3) in place: a turn, a translation, a turn.

    Args:
        particles: x, y, yaw in the map.
        motion: base_T_base of the odometry, before to after.
        alphas: α₁ … α₅; variances are α times squares, as Nav2's.
        rng: source of the noise.
    """
    a1, a2, a3, a4, _ = alphas
    distance = math.hypot(motion.x, motion.y)
    first = math.atan2(motion.y, motion.x) if distance > _LEAST_M else 0.0
    second = angle_difference(motion.yaw, first)
    # Driving backward is not two turns of 180 degrees.
    first_noise = min(abs(first), math.pi - abs(first))
    second_noise = min(abs(second), math.pi - abs(second))
    count = len(particles)
    turn_1 = first + _normal(a1 * first_noise**2 + a2 * distance**2, count, rng)
    turn_2 = second + _normal(a1 * second_noise**2 + a2 * distance**2, count, rng)
    along = distance + _normal(
        a3 * distance**2 + a4 * (first_noise**2 + second_noise**2), count, rng
    )
    heading = particles[:, 2] + turn_1
    particles[:, 0] += along * np.cos(heading)
    particles[:, 1] += along * np.sin(heading)
    particles[:, 2] = wrap_angles(heading + turn_2)


def move_omni(
    particles: NDArray[np.float64],
    motion: Pose2,
    alphas: Alphas,
    rng: np.random.Generator,
) -> None:
    """Move particles (N, 3) in place: a translation in any direction, and a turn.

    Args:
        particles: x, y, yaw in the map.
        motion: base_T_base of the odometry, before to after.
        alphas: α₁ … α₅; variances are α times squares, as Nav2's.
        rng: source of the noise.
    """
    a1, a2, a3, a4, a5 = alphas
    distance, turn = math.hypot(motion.x, motion.y), motion.yaw
    count = len(particles)
    along = distance + _normal(a3 * distance**2 + a1 * turn**2, count, rng)
    side = _normal(a5 * distance**2 + a1 * turn**2, count, rng)
    turned = turn + _normal(a4 * turn**2 + a2 * distance**2, count, rng)
    heading = particles[:, 2] + math.atan2(motion.y, motion.x)
    particles[:, 0] += along * np.cos(heading) - side * np.sin(heading)
    particles[:, 1] += along * np.sin(heading) + side * np.cos(heading)
    particles[:, 2] = wrap_angles(particles[:, 2] + turned)


def noise_of_motion(
    odom_T_before: Pose2,
    covariance_before: NDArray[np.float64],
    odom_T_after: Pose2,
    covariance_after: NDArray[np.float64],
) -> NDArray[np.float64] | None:
    """Return the covariance (3, 3) that a motion adds, base frame after it.

    ``Q = P_after - F P_before F'`` with the Jacobian F of the motion.

    Args:
        odom_T_before: pose of the base according to the odometry.
        covariance_before: (3, 3) of its x, y, yaw in the odometry's frame.
        odom_T_after: the same after the motion.
        covariance_after: likewise.

    Returns:
        None if the covariances are not those of odometry, which grow with each motion.
    """
    jacobian = np.eye(3)
    jacobian[0, 2] = odom_T_before.y - odom_T_after.y
    jacobian[1, 2] = odom_T_after.x - odom_T_before.x
    added = covariance_after - jacobian @ covariance_before @ jacobian.T
    if not (np.isfinite(added).all() and added[2, 2] > 0.0):
        return None
    c, s = math.cos(odom_T_after.yaw), math.sin(odom_T_after.yaw)
    base_R_odom = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    values, vectors = np.linalg.eigh(base_R_odom @ added @ base_R_odom.T)
    noise: NDArray[np.float64] = (vectors * np.maximum(values, 0.0)) @ vectors.T
    return noise


def add_noise(
    particles: NDArray[np.float64],
    covariance: NDArray[np.float64],
    rng: np.random.Generator,
) -> None:
    """Move particles (N, 3) in place by noise of a covariance (3, 3), base frame."""
    dx, dy, turn = rng.multivariate_normal(
        np.zeros(3), covariance, len(particles), check_valid="ignore"
    ).T
    c, s = np.cos(particles[:, 2]), np.sin(particles[:, 2])
    particles[:, 0] += c * dx - s * dy
    particles[:, 1] += s * dx + c * dy
    particles[:, 2] = wrap_angles(particles[:, 2] + turn)


def _normal(
    variance: float, count: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    return rng.normal(0.0, math.sqrt(variance), count)
