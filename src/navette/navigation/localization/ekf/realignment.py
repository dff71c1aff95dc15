"""Find the pose again from positions and the estimated path between them.

A filter whose position sensor contradicts it does not use that sensor; its estimates
are then dead reckoning from a wrong pose, whose shape is right. The rigid motion that
moves the estimated positions onto the measured ones gives position and heading (Umeyama
1991), and by its normal equations their covariance.

A position measured in the past is one of a point of the robot that now lies where the
sensor was then: a measurement with a lever arm. All together are solved for the pose
now, by Gauss-Newton.
"""

import math
from collections import deque

import numpy as np

from navette.geometry import Pose2
from navette.navigation.localization.ekf.measurement import (
    Measurement,
    expected_jacobian,
    innovation,
)
from navette.navigation.localization.ekf.state import SIZE, YAW, Array, X, Y

_MOST = 64  # positions: 13 s at 5 Hz
_LEAST = 10
_HEADING_STDDEV_RAD = 0.15
_STEPS = 10
_LARGEST_CONDITION = 1e12
_POSE = [X, Y, YAW]


class Realignment:
    """Pose of the robot by measured positions along an estimated path."""

    def __init__(self) -> None:
        self._seen: deque[tuple[Pose2, Measurement]] = deque(maxlen=_MOST)

    def clear(self) -> None:
        """Forget all positions."""
        self._seen.clear()

    def add(self, state: Array, measurement: Measurement) -> None:
        """Add a position, and the filter's estimate (8,) at its stamp."""
        self._seen.append((Pose2(*state[_POSE].tolist()), measurement))

    def solve(
        self, state: Array, yaw_variance: float = math.inf
    ) -> tuple[Pose2, Array] | None:
        """Return the pose now and its covariance (3, 3).

        None with fewer than ten positions, and while the heading is not known to 0.15
        rad: that needs a path several times longer than the noise of the positions.

        Args:
            state: (8,) estimate of the filter now.
            yaw_variance: of its heading, if a sensor such as a compass measures it.
        """
        if len(self._seen) < _LEAST:
            return None
        given = self._as_of(Pose2(*state[_POSE].tolist()))
        if math.isfinite(yaw_variance):
            given.append(_heading(given[-1].stamp_ns, state[YAW], yaw_variance))
        x = _closed_form(given[: len(self._seen)])
        for _ in range(_STEPS):
            information, right, squared = _normal_equations(given, x)
            if np.linalg.cond(information) > _LARGEST_CONDITION:
                return None
            x[_POSE] += np.linalg.solve(information, right)
        rows = sum(len(each.indices) for each in given)
        factor = max(1.0, squared / (rows - len(_POSE)))
        covariance = factor * np.linalg.inv(information).astype(np.float64)
        if covariance[2, 2] > _HEADING_STDDEV_RAD**2:
            return None
        return Pose2(*x[_POSE].tolist()), covariance

    def _as_of(self, now: Pose2) -> list[Measurement]:
        """Return the positions as those of points of the robot at its pose now."""
        given = []
        for then, each in self._seen:
            lever = (now.inverse() @ then).apply(np.array([each.lever]))[0]
            values, covariance = each.values[:2], each.covariance[:2, :2]
            given.append(
                Measurement(
                    each.source,
                    each.stamp_ns,
                    (X, Y),
                    values,
                    covariance,
                    lever=(float(lever[0]), float(lever[1])),
                )
            )
        return given


def _heading(stamp_ns: int, yaw: float, variance: float) -> Measurement:
    return Measurement(
        "heading", stamp_ns, (YAW,), np.array([yaw]), np.array([[variance]])
    )


def _closed_form(given: list[Measurement]) -> Array:
    """Return the state (8,) that moves the levers onto the positions (Umeyama 1991)."""
    points = np.array([each.lever for each in given])
    places = np.array([each.values for each in given])
    a, b = points - points.mean(axis=0), places - places.mean(axis=0)
    yaw = math.atan2(
        float(np.sum(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])), float(np.sum(a * b))
    )
    moved = Pose2(0.0, 0.0, yaw).apply(points.mean(axis=0)[None])[0]
    state = np.zeros(SIZE)
    state[_POSE] = *(places.mean(axis=0) - moved), yaw
    return state


def _normal_equations(
    given: list[Measurement], state: Array
) -> tuple[Array, Array, float]:
    """Return information (3, 3), right side (3,) and the squared error."""
    information, right, squared = np.zeros((3, 3)), np.zeros(3), 0.0
    for each in given:
        H = expected_jacobian(each, state)[:, _POSE]
        difference = innovation(each, state)
        weighted = np.linalg.solve(each.covariance, np.column_stack([H, difference]))
        information += H.T @ weighted[:, :-1]
        right += H.T @ weighted[:, -1]
        squared += float(difference @ weighted[:, -1])
    return information, right, squared
