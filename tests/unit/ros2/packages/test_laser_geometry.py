"""laser_geometry: conversion of hits to points."""

import math
from typing import Any

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.ros2.packages.laser_geometry import LaserProjection
from navette.ros2.packages.sensor_msgs_py.point_cloud2 import read_points

Option = LaserProjection.ChannelOption


def scan(**changes: Any) -> LaserScan:
    """Beams to the right, forward and to the left, and two without a hit."""
    message = LaserScan(
        angle_min=-math.pi / 2,
        angle_max=math.pi,
        angle_increment=math.pi / 2,
        time_increment=0.01,
        range_min=0.5,
        range_max=10.0,
        ranges=[1.0, 2.0, 3.0, 0.1],
        **changes,
    )
    message.header.frame_id = "laser"
    return message


def points(cloud: Any) -> Any:
    return read_points(cloud)


def test_hits_are_points() -> None:
    cloud = LaserProjection().projectLaser(scan())
    assert cloud.header.frame_id == "laser"
    found = points(cloud)
    assert found.dtype.names == ("x", "y", "z", "index")
    np.testing.assert_allclose(found["x"], [0, 2, 0], atol=1e-6)
    np.testing.assert_allclose(found["y"], [-1, 0, 3], atol=1e-6)
    assert found["z"].tolist() == [0, 0, 0]
    assert found["index"].tolist() == [0, 1, 2]


def test_channels() -> None:
    every = Option.DEFAULT | Option.DISTANCE | Option.TIMESTAMP | Option.VIEWPOINT
    cloud = LaserProjection().projectLaser(
        scan(intensities=[5.0, 6.0, 7.0, 8.0]), channel_options=every
    )
    found = points(cloud)
    assert found.dtype.names == (
        *("x", "y", "z", "intensity", "index", "distances", "stamps"),
        *("vp_x", "vp_y", "vp_z"),
    )
    assert cloud.point_step == 40
    assert found["intensity"].tolist() == [5, 6, 7]
    assert found["distances"].tolist() == [1, 2, 3]
    np.testing.assert_allclose(found["stamps"], [0, 0.01, 0.02])
    plain = LaserProjection().projectLaser(scan(), channel_options=Option.NONE)
    assert [field.name for field in plain.fields] == ["x", "y", "z"]


@pytest.mark.parametrize(
    ("cutoff", "count"), [(-1.0, 3), (0.0, 0), (2.0, 1), (2.5, 2), (99.0, 3)]
)
def test_the_cutoff(cutoff: float, count: int) -> None:
    assert LaserProjection().projectLaser(scan(), cutoff).width == count


def test_invalid_ranges_have_no_point() -> None:
    message = scan()
    message.ranges = [math.nan, math.inf, 10.0, -math.inf]
    assert LaserProjection().projectLaser(message).width == 0


def test_another_scan_has_other_directions() -> None:
    projector, message = LaserProjection(), scan()
    projector.projectLaser(message)
    message.angle_min = 0.0
    np.testing.assert_allclose(
        points(projector.projectLaser(message))["x"], [1, 0, -3], atol=1e-6
    )
    message.angle_increment = 0.0
    assert points(projector.projectLaser(message))["x"].tolist() == [1, 2, 3]


def test_a_wrong_number_of_intensities() -> None:
    with pytest.raises(InvalidValueError, match="4 ranges and 2 intensities"):
        LaserProjection().projectLaser(scan(intensities=[1.0, 2.0]))
