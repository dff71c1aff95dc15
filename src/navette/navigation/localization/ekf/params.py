"""Parameters of the extended Kalman filter, named as in robot_localization."""

from dataclasses import dataclass
from typing import Any

from navette.errors import InvalidValueError, ParameterError
from navette.geometry.geodesy import GeoPoint
from navette.navigation.localization.ekf.state import NAMES, SPATIAL, planar_covariance
from navette.params import Params, param

_NOTHING = (False,) * len(SPATIAL)
_NO_LIMIT = 1e9

#: The entries that each kind of input provides.
_POSE = ("x", "y", "yaw")
_TWIST = ("vx", "vy", "vyaw")
GIVEN = {
    "odom0": _POSE + _TWIST,
    "odom1": _POSE + _TWIST,
    "pose0": _POSE,
    "twist0": _TWIST,
    "imu0": ("roll", "pitch", "yaw", "vyaw", "ax", "ay"),
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
    return param(_NOTHING, f"which of {' '.join(SPATIAL)} to use")


def _threshold(part: str) -> Any:
    return param(
        _NO_LIMIT,
        f"largest Mahalanobis distance of its {part} from the estimate; farther "
        "measurements are rejected",
        above=0.0,
    )


def _queue() -> Any:
    return param(10, "queue size of the subscription", at_least=1, at_most=1_000_000)


_DIFFERENTIAL = "use changes of its pose as velocity instead of its poses"
_RELATIVE = "use its poses relative to the first one"


@dataclass(frozen=True, kw_only=True)
class EkfParams(Params):
    """Inputs of the filter, their use, and the noise of the motion model."""

    frequency_hz: float = param(
        30.0, "rate of published estimates", at_least=0.1, at_most=1000.0
    )
    sensor_timeout_s: float = param(
        0.5,
        "how long the filter predicts without a measurement; then it publishes nothing",
        above=0.0,
    )
    publish_status: bool = param(
        True,
        "also publish localized or lost on /localization/status; false beside a node "
        "that corrects the estimate, such as amcl",
    )
    lost_time_s: float = param(
        3.0,
        "the filter is lost when the measurements of a sensor contradict the estimate "
        "for this time: all of them, beyond 99.9 % of what the variances explain, or "
        "the median of its positions; 0: never",
        at_least=0.0,
        at_most=1000.0,
    )
    lost_stddev_m: float = param(
        5.0,
        "standard deviation of the position of a filter that is lost, if a sensor "
        "measures the position (gps0, pose0)",
        above=0.0,
    )
    two_d_mode: bool = param(True, "always true: the filter is planar")
    publish_tf: bool = param(True, "also publish the estimate on /tf")
    map_frame: str = param("map", "frame of estimates that may jump")
    odom_frame: str = param("odom", "frame of continuous estimates")
    base_link_frame: str = param("base_link", "frame of the robot's base")
    world_frame: str = param(
        "odom",
        "frame of the estimate: odom_frame (publishes odom → base on /tf), or "
        "map_frame (publishes map → odom; another node publishes odom → base)",
    )
    process_noise_covariance: tuple[float, ...] = param(
        _PROCESS_NOISE,
        "covariance added per second: 15 variances or 15 × 15, for "
        + " ".join(SPATIAL),
    )
    dynamic_process_noise_covariance: bool = param(
        False,
        "whether the process noise of x, y and yaw is multiplied by the squared norm "
        "of the velocity: a robot at rest does not become less certain",
    )
    initial_estimate_covariance: tuple[float, ...] = param(
        (1e-9,) * len(SPATIAL),
        "covariance before the first measurement: 15 variances or 15 × 15",
    )
    initial_state: tuple[float, ...] = param(
        (0.0,) * len(SPATIAL),
        "state before the first measurement: " + " ".join(SPATIAL) + ", m and rad",
    )
    initial_pose_is_known: bool = param(
        False,
        "whether x, y and yaw of initial_state count as measured; otherwise the first "
        "measurement of an entry, such as a fix, replaces its initial value",
    )
    history_length_s: float = param(
        1.0,
        "largest age of a late measurement relative to the newest; an older one is "
        "dropped",
        at_least=0.0,
        at_most=60.0,
    )
    max_gap_s: float = param(
        10.0,
        "a longer gap in the stamps (a bag was set forward) resets the filter",
        above=0.0,
    )
    gravitational_acceleration_mps2: float = param(
        9.80665, "reading of an accelerometer at rest"
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
    imu0_relative: bool = param(False, "use its heading relative to the first one")
    imu0_queue_size: int = _queue()
    imu0_pose_rejection_threshold: float = _threshold("heading")
    imu0_twist_rejection_threshold: float = _threshold("turn rate")
    imu0_linear_acceleration_rejection_threshold: float = _threshold("acceleration")
    imu0_remove_gravitational_acceleration: bool = param(
        False, "subtract gravity from its acceleration, using its orientation"
    )

    gps0: str = _topic("sensor_msgs/msg/NavSatFix")
    gps0_queue_size: int = _queue()
    gps0_rejection_threshold: float = _threshold("position")
    gps0_datum_deg: tuple[float, ...] = param(
        (),
        "latitude and longitude of the world frame's origin, whose x axis points "
        "east; empty = the first fix",
    )

    @property
    def used(self) -> tuple[str, ...]:
        """The inputs with a topic."""
        return tuple(source for source in SOURCES if getattr(self, source))

    def config_of(self, source: str) -> tuple[bool, ...]:
        """Return (15,) as in the parameter; GNSS provides x and y."""
        if source == "gps0":
            return tuple(name in ("x", "y") for name in SPATIAL)
        config: tuple[bool, ...] = getattr(self, f"{source}_config")
        return config

    @property
    def measures_position(self) -> bool:
        """Whether a sensor measures the position itself, not only motion."""
        of_pose = self.config_of("pose0")[:2] if self.pose0 else ()
        return bool(self.gps0) or (any(of_pose) and not self.pose0_differential)

    @property
    def measures_heading(self) -> bool:
        """Whether an IMU measures the heading itself, such as by a compass."""
        return bool(self.imu0) and self.imu0_config[SPATIAL.index("yaw")]

    @property
    def datum(self) -> GeoPoint | None:
        return GeoPoint(*self.gps0_datum_deg) if self.gps0_datum_deg else None

    def check(self) -> None:
        if not self.two_d_mode:
            raise ParameterError(
                "parameter 'two_d_mode': expected true, the filter is planar"
            )
        if self.world_frame not in (self.odom_frame, self.map_frame):
            raise ParameterError(
                f"parameter 'world_frame': {self.world_frame!r}; expected the "
                f"odom_frame {self.odom_frame!r} or the map_frame {self.map_frame!r}"
            )
        for name in ("process_noise_covariance", "initial_estimate_covariance"):
            try:
                planar_covariance(getattr(self, name), f"parameter {name!r}")
            except InvalidValueError as error:
                raise ParameterError(str(error)) from None
        if len(self.initial_state) != len(SPATIAL):
            raise ParameterError(
                f"parameter 'initial_state': {len(self.initial_state)} numbers; "
                f"expected {len(SPATIAL)}, for {' '.join(SPATIAL)}"
            )
        for source in self.used:
            self._check_config(source)
        datum = self.gps0_datum_deg
        if datum and not (len(datum) == 2 and GeoPoint(*datum).is_valid):
            raise ParameterError(
                f"parameter 'gps0_datum_deg': {list(datum)}; expected latitude "
                "(±90) and longitude in degrees"
            )

    def _check_config(self, source: str) -> None:
        config = self.config_of(source)
        if len(config) != len(SPATIAL):
            raise ParameterError(
                f"parameter '{source}_config': {len(config)} booleans; expected "
                f"{len(SPATIAL)}, for {' '.join(SPATIAL)}"
            )
        given = GIVEN.get(source, _POSE)
        chosen = [name for name, on in zip(SPATIAL, config, strict=True) if on]
        for name in chosen:
            if name not in given:
                why = "does not provide it" if name in NAMES else "is planar"
                raise ParameterError(
                    f"parameter '{source}_config': {name} is chosen; the input {why}; "
                    f"expected some of {' '.join(given)}"
                )
        if not chosen:
            raise ParameterError(
                f"parameter '{source}_config': no entry is used of "
                f"{getattr(self, source)}; expected some of {' '.join(given)}"
            )
