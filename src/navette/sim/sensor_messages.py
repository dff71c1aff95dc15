# SPDX-License-Identifier: Apache-2.0
"""Convert the readings of depth cameras, lidars, sonars, bumpers, GNSS to messages."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from navette.geometry.messages import header
from navette.msgs.irobot_create_msgs.msg import HazardDetection, HazardDetectionVector
from navette.msgs.sensor_msgs.msg import (
    Image,
    NavSatFix,
    NavSatStatus,
    PointCloud2,
    PointField,
    Range,
)
from navette.sim.bumper import BumperState
from navette.sim.depth_camera import DepthImage, points_of_depths
from navette.sim.gnss import Fix
from navette.sim.ring_lidar import RingScan
from navette.sim.sensor_specs import (
    DepthCameraSensor,
    GnssSensor,
    RingLidarSensor,
    SonarSensor,
)
from navette.sim.sonar import Echo

# The layout of Velodyne's driver, without the time of each point.
_RING_POINT = np.dtype(
    {
        "names": ["x", "y", "z", "intensity", "ring"],
        "formats": ["<f4", "<f4", "<f4", "<f4", "<u2"],
        "offsets": [0, 4, 8, 12, 16],
        "itemsize": 18,
    }
)
_POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4")])
_DATATYPES = {"<f4": PointField.FLOAT32, "<u2": PointField.UINT16}


def depth_message(
    reading: DepthImage, sensor: DepthCameraSensor, stamp_ns: int, frame: str
) -> Image:
    """Image of type 32FC1 in metres (REP 118)."""
    height, width = reading.depths.shape
    return Image(
        header=header(stamp_ns, frame),
        height=height,
        width=width,
        encoding="32FC1",
        step=4 * width,
        data=reading.depths.astype("<f4").reshape(-1).view(np.uint8),
    )


def depth_points_message(
    reading: DepthImage, sensor: DepthCameraSensor, stamp_ns: int, frame: str
) -> PointCloud2:
    """Organized cloud in the optical frame: one point for each pixel."""
    points = points_of_depths(reading.depths, sensor)
    return _cloud(points.view(_POINT)[..., 0], stamp_ns, frame)


def ring_points_message(
    reading: RingScan, sensor: RingLidarSensor, stamp_ns: int, frame: str
) -> PointCloud2:
    """Cloud of x, y, z, intensity and ring."""
    points = np.zeros(reading.ranges.shape, _RING_POINT)
    for k, axis in enumerate("xyz"):
        points[axis] = reading.points[..., k]
    points["intensity"] = reading.intensities
    points["ring"] = np.arange(sensor.rings, dtype=np.uint16)[:, None]
    if not sensor.is_organized:
        # Column by column, in the order of the measurement.
        points = points.T[np.isfinite(reading.ranges).T][None]
    return _cloud(points, stamp_ns, frame)


def range_message(
    reading: Echo, sensor: SonarSensor, stamp_ns: int, frame: str
) -> Range:
    """Range with the cone's full angle; +inf without an echo (REP 117)."""
    return Range(
        header=header(stamp_ns, frame),
        radiation_type=Range.ULTRASOUND,
        field_of_view=float(np.float32(2 * sensor.half_angle)),
        min_range=float(np.float32(sensor.range_min)),
        max_range=float(np.float32(sensor.range_max)),
        range=float(np.float32(reading.range)),
    )


def fix_message(
    reading: Fix, sensor: GnssSensor, stamp_ns: int, frame: str
) -> NavSatFix:
    """Position with its covariance: east, north, up."""
    variances = [sensor.horizontal_stddev] * 2 + [sensor.vertical_stddev]
    return NavSatFix(
        header=header(stamp_ns, frame),
        status=NavSatStatus(
            status=NavSatStatus.STATUS_FIX, service=NavSatStatus.SERVICE_GPS
        ),
        latitude=reading.point.latitude_deg,
        longitude=reading.point.longitude_deg,
        altitude=reading.point.altitude_m,
        position_covariance=np.diag(np.square(variances)).ravel(),
        position_covariance_type=NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN,
    )


def hazards_message(
    states: Iterable[tuple[str, BumperState]], stamp_ns: int, frame: str
) -> HazardDetectionVector:
    """The bumpers that are pressed, each by its frame; ``frame`` is the robot's."""
    return HazardDetectionVector(
        header=header(stamp_ns, frame),
        detections=[
            HazardDetection(header=header(stamp_ns, own), type=HazardDetection.BUMP)
            for own, state in states
            if state.is_pressed
        ],
    )


def _cloud(points: NDArray[np.void], stamp_ns: int, frame: str) -> PointCloud2:
    """Cloud of a structured array (H, W)."""
    height, width = points.shape
    dtype = points.dtype
    assert dtype.fields is not None, "points of a cloud have fields"
    return PointCloud2(
        header=header(stamp_ns, frame),
        height=height,
        width=width,
        fields=[
            PointField(
                name=name, offset=entry[1], datatype=_DATATYPES[entry[0].str], count=1
            )
            for name, entry in dtype.fields.items()
        ],
        is_bigendian=False,
        point_step=dtype.itemsize,
        row_step=dtype.itemsize * width,
        data=np.ascontiguousarray(points).reshape(-1).view(np.uint8),
        is_dense=bool(np.isfinite(points["x"]).all()),
    )
