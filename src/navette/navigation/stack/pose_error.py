"""Error of the estimated pose of a simulated run."""

import math
from dataclasses import dataclass

from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.nav_msgs.msg import Odometry
from navette.runtime import Context, DurabilityPolicy, Node, QoSProfile
from navette.runtime.stage.odometry import PoseTracker
from navette.sim.node import SimNode

_PERIOD_NS = 100_000_000
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LOCALIZED = "localized"


@dataclass(frozen=True)
class PoseError:
    """Distance of the estimated from the true position, m.

    Attributes:
        worst: largest so far, while the robot counted as localized; None: it never did.
        final: at the end; None without an estimate.
    """

    worst: float | None
    final: float | None


class PoseErrorNode(Node):
    """Compare the stack's pose in the map with the simulator's, ten times a second.

    Args:
        sim: the simulated robot; its topics are not used, so that they cost nothing.
        context: context of the node.
    """

    def __init__(self, sim: SimNode, *, context: Context) -> None:
        super().__init__("pose_error", context=context)
        self._sim = sim
        params = sim.params
        self._tracker = PoseTracker(self, params.base_frame, params.map_frame)
        self._newest: Odometry | None = None
        self._sampled_ns = -_PERIOD_NS
        self._worst: float | None = None
        # Without a node that corrects the odometry nothing reports a status.
        self._is_localized = not params.is_corrected
        self.create_subscription(
            Odometry, topics.ODOMETRY.name, self._on_odometry, 10, shared=True
        )
        self.create_subscription(
            DiagnosticStatus,
            topics.LOCALIZATION_STATUS.name,
            self._on_status,
            _LATCHED,
            shared=True,
        )

    def error(self) -> PoseError:
        """Return the errors up to now."""
        final = self._sample()
        return PoseError(self._worst, final)

    def _on_status(self, msg: DiagnosticStatus) -> None:
        self._is_localized = msg.message == LOCALIZED

    def _on_odometry(self, msg: Odometry) -> None:
        self._newest = msg
        now_ns = self.get_clock().now_ns
        if now_ns - self._sampled_ns >= _PERIOD_NS:
            self._sampled_ns = now_ns
            self._sample()

    def _sample(self) -> float | None:
        if self._newest is not None:
            self._tracker.update(self._newest)
            self._newest = None
        estimate = self._tracker.predicted_at(self._sim.stamp_ns)
        if estimate is None:
            return None
        x, y, _ = self._sim.simulator.pose().translation
        error = math.dist((estimate.x, estimate.y), (x, y))
        if self._is_localized:
            self._worst = max(error, self._worst or 0.0)
        return error
