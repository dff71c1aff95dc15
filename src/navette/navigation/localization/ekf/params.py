"""Parameters of the extended Kalman filter, in robot_localization's words."""

from dataclasses import dataclass
from typing import Any

from navette.errors import InvalidValueError, ParameterError
from navette.geometry.geodesy import GeoPoint
from navette.navigation.localization.ekf.state import NAMES, SPATIAL, planar_covariance
from navette.params import Params, param

_NOTHING = (False,) * len(SPATIAL)
_ANY_DISTANCE = 1e9

#: The entries that each kind of input can give.
_POSE = ("x", "y", "yaw")
_TWIST = ("vx", "vy", "vyaw")
GIVEN = {
    "odom0": _POSE + _TWIST,
    "odom1": _POSE + _TWIST,
    "pose0": _POSE,
    "twist0": _TWIST,
    "imu0": ("yaw", "vyaw", "ax", "ay"),
}
SOURCES = (*GIVEN, "gps0")

FIXED_AT_START = frozenset(
    {*SOURCES, *(f"{source}_queue_size" for source in SOURCES), "world_frame"}
)

# robot_localization's: x y z roll pitch yaw, their rates, ax ay az.
_PROCESS_NOISE = (
    *(0.05, 0.05, 0.06, 0.03, 0.03, 0.06),
    *(0.025, 0.025, 0.04, 0.01, 0.01, 0.02),
    *(0.01, 0.01, 0.015),
)


def _topic(kind: str) -> Any:
    return param("", f"topic of {kind}; empty = none")


def _config() -> Any:
    return param(_NOTHING, f"which of {' '.join(SPATIAL)} are taken from it")


def _threshold(part: str) -> Any:
    return param(
        _ANY_DISTANCE,
        f"largest Mahalanobis distance of its {part} from the estimate; what is "
        "farther is left out",
        above=0.0,
    )


def _queue() -> Any:
    return param(10, "how many of its messages may wait", at_least=1)


_DIFFERENTIAL = "take its changes of pose as velocity, not its poses"
_RELATIVE = "take its poses as seen from its first"


@dataclass(frozen=True, kw_only=True)
class EkfParams(Params):
    """Which sensors there are, what they tell, and how much the model is trusted."""

    frequency_hz: float = param(30.0, "estimates published", unit="Hz", above=0.0)
    sensor_timeout_s: float = param(
        0.5,
        "so long it goes on by prediction when no sensor says anything; then it "
        "publishes nothing",
        unit="s",
        above=0.0,
    )
    two_d_mode: bool = param(True, "always: the filter is planar")
    publish_tf: bool = param(True, "whether the estimate goes to /tf, too")
    map_frame: str = param("map", "frame of estimates that may jump")
    odom_frame: str = param("odom", "frame of estimates that go on smoothly")
    base_link_frame: str = param("base_link", "frame of the robot's base")
    world_frame: str = param(
        "odom",
        "frame of the estimate: odom_frame (to /tf goes odom → base), or map_frame (to "
        "/tf goes map → odom, while something else gives odom → base)",
    )
    process_noise_covariance: tuple[float, ...] = param(
        _PROCESS_NOISE,
        "added per second: 15 variances or 15 × 15, for " + " ".join(SPATIAL),
    )
    initial_estimate_covariance: tuple[float, ...] = param(
        (1e-9,) * len(SPATIAL),
        "before the first measurement: 15 variances or 15 × 15",
    )
    initial_state: tuple[float, ...] = param(
        (0.0,) * len(SPATIAL),
        "before the first measurement: " + " ".join(SPATIAL) + ", m and rad",
    )
    history_length_s: float = param(
        1.0,
        "a measurement so much older than the newest is put in its place in time; an "
        "older one is left out",
        unit="s",
        at_least=0.0,
        at_most=60.0,
    )
    max_gap_s: float = param(
        10.0,
        "when nothing came for longer by the stamps (a bag was set forward), the "
        "filter begins anew",
        unit="s",
        above=0.0,
    )
    gravitational_acceleration_mps2: float = param(
        9.80665, "what an accelerometer at rest shows", unit="m/s²"
    )

    odom0: str = _topic("nav_msgs/msg/Odometry")
    odom0_config: tuple[bool, ...] = _config()
    odom0_differential: bool = param(False, _DIFFERENTIAL)
    odom0_relative: bool = param(False, _RELATIVE)
    odom0_queue_size: int = _queue()
    odom0_pose_rejection_threshold: float = _threshold("pose")
    odom0_twist_rejection_threshold: float = _threshold("velocity")

    odom1: str = _topic("another nav_msgs/msg/Odometry")
    odom1_config: tuple[bool, ...] = _config()
    odom1_differential: bool = param(False, _DIFFERENTIAL)
    odom1_relative: bool = param(False, _RELATIVE)
    odom1_queue_size: int = _queue()
    odom1_pose_rejection_threshold: float = _threshold("pose")
    odom1_twist_rejection_threshold: float = _threshold("velocity")

    pose0: str = _topic("geometry_msgs/msg/PoseWithCovarianceStamped")
    pose0_config: tuple[bool, ...] = _config()
    pose0_differential: bool = param(False, _DIFFERENTIAL)
    pose0_relative: bool = param(False, _RELATIVE)
    pose0_queue_size: int = _queue()
    pose0_rejection_threshold: float = _threshold("pose")

    twist0: str = _topic("geometry_msgs/msg/TwistWithCovarianceStamped")
    twist0_config: tuple[bool, ...] = _config()
    twist0_queue_size: int = _queue()
    twist0_rejection_threshold: float = _threshold("velocity")

    imu0: str = _topic("sensor_msgs/msg/Imu")
    imu0_config: tuple[bool, ...] = _config()
    imu0_relative: bool = param(False, "take its heading as seen from its first")
    imu0_queue_size: int = _queue()
    imu0_pose_rejection_threshold: float = _threshold("heading")
    imu0_twist_rejection_threshold: float = _threshold("turn rate")
    imu0_linear_acceleration_rejection_threshold: float = _threshold("acceleration")
    imu0_remove_gravitational_acceleration: bool = param(
        False, "take gravity off its acceleration, by its own orientation"
    )

    gps0: str = _topic("sensor_msgs/msg/NavSatFix")
    gps0_queue_size: int = _queue()
    gps0_rejection_threshold: float = _threshold("position")
    gps0_datum_deg: tuple[float, ...] = param(
        (),
        "latitude and longitude of the world frame's origin, whose x axis points "
        "east; empty = the first fix",
        unit="deg",
    )

    @property
    def used(self) -> tuple[str, ...]:
        """The inputs that have a topic."""
        return tuple(source for source in SOURCES if getattr(self, source))

    def config_of(self, source: str) -> tuple[bool, ...]:
        """(15,) as in the parameter; a GNSS gives x and y."""
        if source == "gps0":
            return tuple(name in ("x", "y") for name in SPATIAL)
        config: tuple[bool, ...] = getattr(self, f"{source}_config")
        return config

    @property
    def datum(self) -> GeoPoint | None:
        return GeoPoint(*self.gps0_datum_deg) if self.gps0_datum_deg else None

    def check(self) -> None:
        if not self.two_d_mode:
            raise ParameterError("parameter 'two_d_mode': wanted true, it is planar")
        if self.world_frame not in (self.odom_frame, self.map_frame):
            raise ParameterError(
                f"parameter 'world_frame': {self.world_frame!r}; wanted the odom_frame "
                f"{self.odom_frame!r} or the map_frame {self.map_frame!r}"
            )
        for name in ("process_noise_covariance", "initial_estimate_covariance"):
            try:
                planar_covariance(getattr(self, name), f"parameter {name!r}")
            except InvalidValueError as error:
                raise ParameterError(str(error)) from None
        if len(self.initial_state) != len(SPATIAL):
            raise ParameterError(
                f"parameter 'initial_state': {len(self.initial_state)} numbers; wanted "
                f"{len(SPATIAL)}, for {' '.join(SPATIAL)}"
            )
        for source in self.used:
            self._check_config(source)
        datum = self.gps0_datum_deg
        if datum and not (len(datum) == 2 and GeoPoint(*datum).is_valid):
            raise ParameterError(
                f"parameter 'gps0_datum_deg': {list(datum)}; wanted latitude (±90) and "
                "longitude in degrees"
            )

    def _check_config(self, source: str) -> None:
        config = self.config_of(source)
        if len(config) != len(SPATIAL):
            raise ParameterError(
                f"parameter '{source}_config': {len(config)} booleans; wanted "
                f"{len(SPATIAL)}, for {' '.join(SPATIAL)}"
            )
        given = GIVEN.get(source, _POSE)
        chosen = [name for name, on in zip(SPATIAL, config, strict=True) if on]
        for name in chosen:
            if name not in given:
                why = "does not give it" if name in NAMES else "is planar"
                raise ParameterError(
                    f"parameter '{source}_config': {name} is chosen; the input {why}; "
                    f"wanted some of {' '.join(given)}"
                )
        if not chosen:
            raise ParameterError(
                f"parameter '{source}_config': nothing is taken from "
                f"{getattr(self, source)}; wanted some of {' '.join(given)}"
            )
