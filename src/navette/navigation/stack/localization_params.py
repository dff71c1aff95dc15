"""Parameters of the nodes that locate the robot: frames and start of a run.

Frames are those of REP 105: ``map → odom → base``. The simulator publishes ``odom →
base`` (a filter, if it filters the odometry) and, without correction, ``map → odom``.
"""

from typing import Any

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.msgs import topics
from navette.sim.params import SimParams
from navette.sim.scene import GeoOrigin

# Variances per second. Of the pose, at 1 m/s: slip of the wheels, which no sensor
# measures; its other errors are those of the velocities.
_PROCESS_NOISE = (
    *(5e-5, 5e-5, 0.0, 0.0, 0.0, 1e-6),
    *(0.2, 0.01, 0.0, 0.0, 0.0, 0.05),
    *(1.0, 1.0, 0.0),
)
# The same of the heading without a gyroscope: robots with a GNSS receiver turn by
# skidding, up to 25 % more or less than their wheels.
_SKID_NOISE_RAD2 = 2e-3
# Mahalanobis distance that one fix of a consistent filter in a thousand exceeds.
_GNSS_GATE = 3.72
_ORIGIN = GeoOrigin()
_ORDER = "x y z roll pitch yaw vx vy vz vroll vpitch vyaw ax ay az".split()


def localization_parameters(
    sim: SimParams, start: Pose2, origin: GeoOrigin = _ORIGIN
) -> dict[str, dict[str, Any]]:
    """Return node → parameters: the frames of the run and the start pose.

    Args:
        sim: parameters of the simulated robot.
        start: map_T_base at the start.
        origin: of the world on the Earth, for GNSS.

    Raises:
        InvalidValueError: GNSS in a world whose x axis does not point east.
    """
    x, y, yaw = start
    values: dict[str, dict[str, Any]] = {
        "ekf": {
            "map_frame": sim.map_frame,
            "odom_frame": sim.odometry_frame,
            "world_frame": sim.odometry_frame,
            "base_link_frame": sim.base_frame,
            "publish_status": not sim.is_corrected,
            "frequency_hz": sim.odometry_rate_hz,
            "odom0": topics.WHEEL_ODOMETRY.name,
            "odom0_config": [name in ("vx", "vy", "vyaw") for name in _ORDER],
            **_fused(sim, origin),
            "process_noise_covariance": _process_noise(sim),
            "dynamic_process_noise_covariance": True,
            "initial_state": [x, y, 0.0, 0.0, 0.0, yaw, *[0.0] * 9],
            "initial_pose_is_known": True,
        },
        "amcl": {
            "global_frame_id": sim.map_frame,
            "odom_frame_id": sim.odometry_frame,
            "base_frame_id": sim.base_frame,
            "seed": sim.seed,
            "set_initial_pose": True,
            "initial_pose.x": x,
            "initial_pose.y": y,
            "initial_pose.yaw": yaw,
        },
        "slam": {
            "map_frame": sim.map_frame,
            "odom_frame": sim.odometry_frame,
            "base_frame": sim.base_frame,
            "start_x_m": x,
            "start_y_m": y,
            "start_yaw_rad": yaw,
        },
    }
    return values


def _process_noise(sim: SimParams) -> list[float]:
    noise = list(_PROCESS_NOISE)
    if "imu" not in sim.fused_sensors:
        noise[_ORDER.index("yaw")] = _SKID_NOISE_RAD2
    return noise


def _fused(sim: SimParams, origin: GeoOrigin) -> dict[str, Any]:
    """Return the filter's parameters of the sensors beside the wheels."""
    values: dict[str, Any] = {}
    if "imu" in sim.fused_sensors:
        values["imu0"] = topics.IMU.name
        values["imu0_config"] = [name in ("roll", "pitch", "vyaw") for name in _ORDER]
    if "gnss" in sim.fused_sensors:
        if origin.heading_deg:
            raise InvalidValueError(
                f"localization {sim.localization!r}: the world's x axis points "
                f"{origin.heading_deg:g} degrees from east; the filter needs 0 "
                "(<heading_deg> of its <spherical_coordinates>)"
            )
        values["gps0"] = topics.FIX.name
        values["gps0_rejection_threshold"] = _GNSS_GATE
        values["gps0_datum_deg"] = [origin.latitude_deg, origin.longitude_deg]
    return values
