"""The node that measures a trial: true motion and the controller's state."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.bench.trial import Point
from navette.runtime import Context, DurabilityPolicy, Node, QoSProfile, stamp_to_ns

_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
OTHER = "other_slow_driving"
"""Cause while the path is followed, and nothing limits the speed that has a name."""
# Clearance below which a controller that names no reason drives slower because of it.
_NEAR_M = 0.3
# Distance from the start at which the time of a trial begins.
_MOVED_M = 0.1


OnTrialEnd = Callable[[], None]
"""Called once, near the goal or at a contact."""


class TrialObserver(Node):
    """Record the true motion; end the trial near the goal, or at a contact.

    Args:
        goal: last goal (m, map).
        reach_m: distance to it that ends the trial; 0 = never.
        ends_at_contact: whether the first contact is an end too.
    """

    def __init__(
        self,
        goal: Point,
        reach_m: float,
        *,
        on_end: OnTrialEnd,
        ends_at_contact: bool = False,
        context: Context,
    ) -> None:
        super().__init__("trial_observer", context=context)
        self._goal, self._reach_m, self._on_end = goal, reach_m, on_end
        self._samples: list[tuple[float, float, float, float, float]] = []
        self._states: list[str] = []
        self._state = "idle"
        self._limit = ""
        self.arrived = False
        self.began_ns: int | None = None
        self.create_subscription(
            Odometry, topics.GROUND_TRUTH.name, self._on_truth, 10, shared=True
        )
        self.create_subscription(
            DiagnosticStatus,
            topics.CONTROL_STATUS.name,
            self._on_control,
            _LATCHED,
            shared=True,
        )

        if ends_at_contact:
            self.create_subscription(
                DiagnosticArray,
                topics.CONTACTS.name,
                lambda msg: on_end() if msg.status else None,
                10,
            )

    @property
    def samples(self) -> NDArray[np.float64]:
        """(N, 5) time (s), x, y (m, map), speed (m/s), turn rate (rad/s)."""
        return np.array(self._samples, np.float64).reshape(-1, 5)

    @property
    def states(self) -> list[str]:
        """Cause of the speed at each sample: the controller's state or its limit."""
        return list(self._states)

    def _on_control(self, msg: DiagnosticStatus) -> None:
        values = {pair.key: pair.value for pair in msg.values}
        self._state = msg.message
        self._limit = values.get("limited_by", "")
        near = float(values.get("clearance_m") or math.inf) < _NEAR_M
        if not self._limit and near:
            self._limit = "clearance"

    def _on_truth(self, msg: Odometry) -> None:
        at, twist = msg.pose.pose.position, msg.twist.twist
        now_ns = stamp_to_ns(msg.header.stamp)
        self._samples.append(
            (now_ns / 1e9, at.x, at.y, twist.linear.x, twist.angular.z)
        )
        self._states.append(
            self._limit or OTHER if self._state == "following" else self._state
        )
        if self.began_ns is None:
            moved = math.dist((at.x, at.y), self._samples[0][1:3])
            if moved >= _MOVED_M:
                self.began_ns = now_ns
        if not self.arrived and math.dist((at.x, at.y), self._goal) <= self._reach_m:
            self.arrived = True
            self._on_end()
