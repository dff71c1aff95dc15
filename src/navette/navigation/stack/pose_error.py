"""Error of the estimated pose of a simulated run."""

import math

from navette.errors import InvalidValueError
from navette.msgs import topics
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.navigation.grids import grid_from_message
from navette.navigation.stack.map_fit import fits_world
from navette.navigation.stack.summary import PoseError
from navette.runtime import (
    Context,
    DurabilityPolicy,
    LoggingSeverity,
    Node,
    QoSProfile,
)
from navette.runtime.stage.odometry import PoseTracker
from navette.sim.node import SimNode

_PERIOD_NS = 100_000_000
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LOCALIZED = "localized"


class PoseErrorNode(Node):
    """Compare the stack's pose in the map with the simulator's, ten times a second.

    Args:
        sim: the simulated robot; its topics are not used, so that they cost nothing.
        context: context of the node.
    """

    def __init__(self, sim: SimNode, *, context: Context) -> None:
        super().__init__("pose_error", context=context)
        # The stages report odometry that cannot be used.
        self.get_logger().set_level(LoggingSeverity.ERROR)
        self._sim = sim
        params = sim.params
        self._tracker = PoseTracker(self, params.base_frame, params.map_frame)
        self._newest: Odometry | None = None
        self._sampled_ns = -_PERIOD_NS
        self._worst: float | None = None
        # Without a node that corrects the odometry nothing reports a status.
        self._is_localized = not params.is_corrected
        self._goal_distance: float | None = None
        self._has_given_map = False
        self._map: OccupancyGrid | None = None
        self._fits: bool | None = None  # of the map; None: not compared yet
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

    def check_map(self, map_topic: str) -> None:
        """Compare the map of a topic with the world before an error is returned.

        The run estimates its pose on this map, which may be in any frame.
        """
        self._has_given_map = True
        self.create_subscription(
            OccupancyGrid, map_topic, self._on_map, _LATCHED, shared=True
        )

    def error(self) -> PoseError:
        """Return the errors up to now."""
        final = self._sample()
        if not self._has_given_map:
            return PoseError(self._worst, final)
        fits = self._map_fits_world()
        if not fits:
            return PoseError(None, None, fits)
        return PoseError(self._worst, final, fits)

    def note_reached(self, goal: tuple[float, float]) -> None:
        """Store the true distance from a goal (map, m) that counts as reached."""
        x, y, _ = self._sim.simulator.pose().translation
        self._goal_distance = max(math.dist(goal, (x, y)), self._goal_distance or 0.0)

    def goal_distance(self) -> float | None:
        """Return the largest true distance from a goal when it was reached, m.

        None without a reached goal, or if goals are not in the world's frame.
        """
        is_unknown = self._has_given_map and not self._map_fits_world()
        return None if is_unknown else self._goal_distance

    def _on_map(self, msg: OccupancyGrid) -> None:
        self._map, self._fits = msg, None

    def _map_fits_world(self) -> bool | None:
        """Return whether the given map is in the world's frame; None before it came."""
        if self._fits is None and self._map is not None:
            try:
                cells, spec = grid_from_message(self._map)
            except InvalidValueError:
                self._fits = False  # the node that locates the robot reports it
            else:
                self._fits = fits_world(cells, spec, self._sim.simulator.outlines())
        return self._fits

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
