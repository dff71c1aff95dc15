# SPDX-License-Identifier: Apache-2.0
"""Convert the simulator's values to ROS messages."""

import struct
from collections.abc import Sequence

import numpy as np

from navette.geometry import Transform3
from navette.geometry.messages import header
from navette.geometry.se3 import rotate
from navette.msgs.diagnostic_msgs.msg import (
    DiagnosticArray,
    DiagnosticStatus,
    KeyValue,
)
from navette.msgs.geometry_msgs.msg import (
    Point,
    Pose,
    PoseWithCovariance,
    PoseWithCovarianceStamped,
    Quaternion,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from navette.msgs.nav_msgs.msg import Odometry
from navette.msgs.sensor_msgs.msg import CameraInfo, Image, Imu, JointState, LaserScan
from navette.msgs.std_msgs.msg import ColorRGBA
from navette.msgs.visualization_msgs.msg import Marker, MarkerArray
from navette.sim.camera import Image as Pixels
from navette.sim.camera import focal_length
from navette.sim.contacts import ContactEpisode
from navette.sim.imu import ImuReading
from navette.sim.lidar import Scan
from navette.sim.robot_state import JointReadings, Motion, cross
from navette.sim.scene import (
    Box,
    Capsule,
    Cylinder,
    Ellipsoid,
    Model,
    Shape,
    Sphere,
)
from navette.sim.sensor_specs import CameraSensor, ImuSensor
from navette.sim.wheel_odometry import Matrix, PlanarCovariances

_ACTOR_COLOUR = (0.85, 0.35, 0.30, 1.0)
_ESTIMATE_VARIANCE = 1e-4  # in m² and rad²
_IDENTITY = Transform3.identity()
_MOST_CONTACTS = 200  # in a message
_PLANAR = np.array([0, 1, 5, 6, 7, 11, 30, 31, 35])  # x, y, yaw of 6 × 6


def odometry_message(
    stamp_ns: int,
    frames: tuple[str, str],
    frame_T_base: Transform3,
    motion: Motion,
    base_T_child: Transform3,
    planar: PlanarCovariances | None = None,
) -> Odometry:
    """Odometry of a frame fixed to the base; the velocity is in that frame.

    ``frames``: frame of the pose and child frame. Missing covariances are 0, as are
    those of height, roll and pitch: the robot drives in the plane.
    """
    frame_T_child = frame_T_base
    if base_T_child != _IDENTITY:
        frame_T_child = frame_T_base @ base_T_child
        motion = _motion_of(base_T_child, motion)
    (x, y, z), (qx, qy, qz, qw) = frame_T_child
    (vx, vy, vz), (wx, wy, wz) = motion
    message = Odometry(
        header=header(stamp_ns, frames[0]),
        child_frame_id=frames[1],
        pose=PoseWithCovariance(
            pose=Pose(
                position=Point(x=x, y=y, z=z),
                orientation=Quaternion(x=qx, y=qy, z=qz, w=qw),
            )
        ),
        twist=TwistWithCovariance(
            twist=Twist(
                linear=Vector3(x=vx, y=vy, z=vz), angular=Vector3(x=wx, y=wy, z=wz)
            )
        ),
    )
    if planar is not None:
        child = planar.of_child(frame_T_base.to_pose2(), base_T_child.to_pose2())
        message.pose.covariance = _spatial(child.pose)
        message.twist.covariance = _spatial(child.twist)
    return message


def estimate_of(truth: Odometry) -> PoseWithCovarianceStamped:
    """Return the true pose as an estimate for localization."""
    estimate = PoseWithCovarianceStamped(header=truth.header, pose=truth.pose)
    for index in (0, 7, 35):  # x, y, yaw on the diagonal of 6 × 6
        estimate.pose.covariance[index] = _ESTIMATE_VARIANCE
    return estimate


def _motion_of(base_T_child: Transform3, motion: Motion) -> Motion:
    """Return the velocity of a frame fixed to the base, in that frame."""
    (vx, vy, vz), omega = motion
    lx, ly, lz = cross(omega, base_T_child.translation)
    x, y, z, w = base_T_child.rotation
    child_R_base = (-x, -y, -z, w)
    return Motion(
        rotate(child_R_base, (vx + lx, vy + ly, vz + lz)), rotate(child_R_base, omega)
    )


def joint_message(joints: JointReadings, stamp_ns: int) -> JointState:
    return JointState(
        header=header(stamp_ns, ""),
        name=list(joints.names),
        position=joints.angles,
        velocity=joints.speeds,
    )


def _spatial(planar: Matrix) -> Matrix:
    """(3, 3) of x, y, yaw → (36,) of x, y, z, roll, pitch, yaw."""
    spatial = np.zeros(36)
    spatial[_PLANAR] = planar.reshape(9)
    return spatial


def scan_message(scan: Scan, stamp_ns: int, frame: str, period_s: float) -> LaserScan:
    """Round to the precision of the message (32 bits).

    Subscribers in this process then receive the same numbers as readers of a bag or
    subscribers in another process.
    """
    first, step, count = scan.angle_min, scan.angle_increment, len(scan.ranges)
    angle_min, angle_max, angle_increment, scan_time, range_min, range_max = _rounded(
        first, first + step * (count - 1), step, period_s,
        scan.range_min, scan.range_max,
    )  # fmt: skip
    return LaserScan(
        header=header(stamp_ns, frame),
        angle_min=angle_min,
        angle_max=angle_max,
        angle_increment=angle_increment,
        scan_time=scan_time,
        range_min=range_min,
        range_max=range_max,
        ranges=scan.ranges,
    )


def _rounded(*values: float) -> tuple[float, ...]:
    """Return the nearest numbers of 32 bits."""
    layout = f"{len(values)}f"
    return struct.unpack(layout, struct.pack(layout, *values))


def imu_message(
    reading: ImuReading, sensor: ImuSensor, stamp_ns: int, frame: str
) -> Imu:
    qx, qy, qz, qw = reading.orientation
    wx, wy, wz = reading.angular_velocity.tolist()
    ax, ay, az = reading.linear_acceleration.tolist()
    return Imu(
        header=header(stamp_ns, frame),
        orientation=Quaternion(x=qx, y=qy, z=qz, w=qw),
        angular_velocity=Vector3(x=wx, y=wy, z=wz),
        angular_velocity_covariance=_diagonal(sensor.angular_velocity_stddev),
        linear_acceleration=Vector3(x=ax, y=ay, z=az),
        linear_acceleration_covariance=_diagonal(sensor.acceleration_stddev),
    )


def _diagonal(stddev: float) -> "np.ndarray[tuple[int], np.dtype[np.float64]]":
    covariance = np.zeros(9)
    covariance[::4] = stddev**2
    return covariance


def image_message(pixels: Pixels, stamp_ns: int, frame: str) -> Image:
    height, width, _ = pixels.shape
    return Image(
        header=header(stamp_ns, frame),
        height=height,
        width=width,
        encoding="rgb8",
        step=3 * width,
        data=pixels.reshape(-1),
    )


def camera_info_message(sensor: CameraSensor, stamp_ns: int, frame: str) -> CameraInfo:
    """CameraInfo of a pinhole without distortion."""
    f = focal_length(sensor)
    cx, cy = sensor.width / 2, sensor.height / 2
    return CameraInfo(
        header=header(stamp_ns, frame),
        height=sensor.height,
        width=sensor.width,
        distortion_model="plumb_bob",
        d=np.zeros(5),
        k=np.array([f, 0, cx, 0, f, cy, 0, 0, 1.0]),
        r=np.eye(3).ravel(),
        p=np.array([f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1.0, 0]),
    )


def contacts_message(
    episodes: Sequence[ContactEpisode], stamp_ns: int, frame: str
) -> DiagnosticArray:
    """Diagnostics of the contacts of a run, the newest last, at most 200."""
    first = max(0, len(episodes) - _MOST_CONTACTS)
    contacts = [
        _contact_status(episode, number, frame)
        for number, episode in enumerate(episodes[first:], first + 1)
    ]
    return DiagnosticArray(header=header(stamp_ns, frame), status=contacts)


def _contact_status(
    episode: ContactEpisode, number: int, frame: str
) -> DiagnosticStatus:
    """Link, obstacle, place, time and number of a contact."""
    x, y, z = episode.place
    values = {
        "part": episode.part,
        "obstacle": episode.obstacle,
        "frame": frame,
        "x_m": f"{x:.3f}",
        "y_m": f"{y:.3f}",
        "z_m": f"{z:.3f}",
        "time_s": f"{episode.start_ns / 1e9:.3f}",
        "count": str(number),
    }
    return DiagnosticStatus(
        level=DiagnosticStatus.ERROR,
        name="sim: contact",
        message=f"{episode.part} touched {episode.obstacle}",
        values=[KeyValue(key=key, value=value) for key, value in values.items()],
    )


def actors_message(
    actors: Sequence[tuple[Model, Transform3]], stamp_ns: int, frame: str
) -> MarkerArray:
    """Return the visible shapes of models at their poses in the world."""
    markers: list[Marker] = []
    for model, world_T_model in actors:
        for link in model.links:
            for geometry in link.geometries:
                kind = _marker_kind(geometry.shape)
                if kind is None or not geometry.visible:
                    continue
                pose = world_T_model @ link.model_T_link @ geometry.link_T_shape
                (x, y, z), (qx, qy, qz, qw) = pose
                marker = Marker(
                    header=header(stamp_ns, frame),
                    ns=model.name,
                    id=len(markers),
                    type=kind[0],
                    action=Marker.ADD,
                    pose=Pose(
                        position=Point(x=x, y=y, z=z),
                        orientation=Quaternion(x=qx, y=qy, z=qz, w=qw),
                    ),
                )
                marker.scale = Vector3(x=kind[1][0], y=kind[1][1], z=kind[1][2])
                r, g, b, a = geometry.colour or _ACTOR_COLOUR
                marker.color = ColorRGBA(r=r, g=g, b=b, a=a)
                markers.append(marker)
    return MarkerArray(markers=markers)


def _marker_kind(shape: Shape) -> tuple[int, tuple[float, float, float]] | None:
    """Return the type of marker and its size; None for a plane."""
    if isinstance(shape, Box):
        return Marker.CUBE, shape.size
    if isinstance(shape, Sphere):
        return Marker.SPHERE, (2 * shape.radius,) * 3
    if isinstance(shape, Ellipsoid):
        a, b, c = shape.radii
        return Marker.SPHERE, (2 * a, 2 * b, 2 * c)
    if isinstance(shape, Cylinder):
        return Marker.CYLINDER, (2 * shape.radius, 2 * shape.radius, shape.length)
    if isinstance(shape, Capsule):
        height = shape.length + 2 * shape.radius
        return Marker.CYLINDER, (2 * shape.radius, 2 * shape.radius, height)
    return None
