"""Pose and covariance of the heaviest cluster of particles."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2, largest_stddev, wrap_angles
from navette.navigation.localization.amcl.bins import in_heaviest_bin

_BIN_M, _BIN_HEADINGS = 0.5, 18
_RADIUS_M, _RADIUS_RAD = 0.75, 0.5
_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class ParticleEstimate:
    """The heaviest cluster.

    Attributes:
        pose: mean x, y, yaw.
        covariance: (3, 3) of x, y, yaw.
        share: weight of the cluster, 0 … 1.
    """

    pose: Pose2
    covariance: NDArray[np.float64]
    share: float

    @property
    def stddev_m(self) -> float:
        """Standard deviation of the position along the worst axis, m."""
        return largest_stddev(self.covariance)


@dataclass(frozen=True, eq=False)
class Particles:
    """Weighted poses; the arrays are never modified.

    Attributes:
        poses: (N, 3) x, y, yaw.
        weights: (N,) with sum 1.
    """

    poses: NDArray[np.float64]
    weights: NDArray[np.float64]

    @classmethod
    def of(cls, poses: NDArray[np.float64]) -> "Particles":
        """Return poses (N, 3) with equal weights."""
        return cls(poses, np.full(len(poses), 1.0 / max(1, len(poses))))

    def __len__(self) -> int:
        return len(self.poses)

    @cached_property
    def estimate(self) -> ParticleEstimate:
        """The heaviest cluster."""
        return heaviest_cluster(self.poses, self.weights)

    @cached_property
    def whole(self) -> ParticleEstimate:
        """All particles as one cluster, however wide it is."""
        return _moments(self.poses, self.weights)

    def near(self, pose: Pose2) -> "Particles":
        """Return the particles of the cluster around a pose."""
        inside = _is_near(self.poses, np.array(pose))
        weights = self.weights[inside]
        return Particles(self.poses[inside], weights / weights.sum())


def heaviest_cluster(
    particles: NDArray[np.float64], weights: NDArray[np.float64]
) -> ParticleEstimate:
    """Return mean, covariance and weight of the particles around the heaviest bin.

    Args:
        particles: (N, 3) x, y, yaw.
        weights: (N,) with sum 1.
    """
    inside = in_heaviest_bin(particles, weights, _BIN_M, _BIN_HEADINGS)
    mean = _mean(particles[inside], weights[inside])
    for _ in range(_ROUNDS):
        inside = _is_near(particles, mean)
        mean = _mean(particles[inside], weights[inside])
    return _moments(particles[inside], weights[inside])


def _is_near(
    particles: NDArray[np.float64], mean: NDArray[np.float64]
) -> NDArray[np.bool_]:
    away = np.hypot(particles[:, 0] - mean[0], particles[:, 1] - mean[1])
    turn = np.abs(wrap_angles(particles[:, 2] - mean[2]))
    near: NDArray[np.bool_] = (away < _RADIUS_M) & (turn < _RADIUS_RAD)
    return near


def _moments(
    particles: NDArray[np.float64], weights: NDArray[np.float64]
) -> ParticleEstimate:
    """Return mean, covariance and total weight."""
    mean, mass = _mean(particles, weights), float(weights.sum())
    off = particles - mean
    off[:, 2] = wrap_angles(off[:, 2])
    covariance = (off * weights[:, None]).T @ off / mass
    return ParticleEstimate(Pose2(*mean.tolist()), covariance, mass)


def _mean(
    particles: NDArray[np.float64], weights: NDArray[np.float64]
) -> NDArray[np.float64]:
    x, y = (particles[:, :2] * weights[:, None]).sum(axis=0) / weights.sum()
    yaw = math.atan2(
        float((np.sin(particles[:, 2]) * weights).sum()),
        float((np.cos(particles[:, 2]) * weights).sum()),
    )
    return np.array([x, y, yaw])
