"""Parameters of the distance node."""

from dataclasses import dataclass

from navette.errors import ParameterError
from navette.msgs import topics
from navette.params import Params, param

GPS = "gnss_driver/msg/Gps"
FIX = "sensor_msgs/msg/NavSatFix"
TWIST = "geometry_msgs/msg/TwistStamped"
ODOMETRY = "nav_msgs/msg/Odometry"

_HAVE_POSITION = (GPS, FIX, ODOMETRY)
_HAVE_VELOCITY = (GPS, TWIST, ODOMETRY)


@dataclass(frozen=True, kw_only=True)
class DistanceParams(Params):
    """Source of the distance."""

    odom_type: str = param(
        "pos",
        "quantity to sum: changes of position (pos; gps is a synonym), or velocity "
        "times time (vel)",
        choices=("pos", "gps", "vel"),
    )
    topic: str = param(topics.GNSS.name, "topic of the input")
    topic_type: str = param(
        GPS,
        "type of the input; NavSatFix has no velocity and TwistStamped no position",
        choices=(GPS, FIX, TWIST, ODOMETRY),
    )
    queue_size: int = param(
        1,
        "queue size of the subscription; a full queue drops its oldest message, and "
        "bends of the track with it: use more if a bag is played fast",
        at_least=1,
        at_most=1_000_000,
    )
    max_gap_s: float = param(
        2.0,
        "longest time between two consecutive messages; after a longer gap (a bag was "
        "set forward) counting continues from the new message",
        above=0.0,
    )

    @property
    def by_velocity(self) -> bool:
        """Whether velocity is summed instead of position."""
        return self.odom_type == "vel"

    @property
    def max_gap_ns(self) -> int:
        return max(1, round(self.max_gap_s * 1e9))

    def check(self) -> None:
        able = _HAVE_VELOCITY if self.by_velocity else _HAVE_POSITION
        if self.topic_type not in able:
            raise ParameterError(
                f"parameter 'topic_type': {self.topic_type} has no "
                f"{'velocity' if self.by_velocity else 'position'}, which odom_type "
                f"{self.odom_type!r} sums; expected one of {', '.join(able)}"
            )
