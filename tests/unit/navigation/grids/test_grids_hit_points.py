"""Clouds are found by their stamp, in every pass of a recording that repeats."""

from typing import Any

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.msgs.sensor_msgs.msg import PointCloud2, PointField
from navette.navigation.grids import HitPoints
from navette.navigation.grids.hit_points import points_from_message, points_to_message

KEPT = 16


def test_a_stamp_that_returns_is_the_newest() -> None:
    hits = HitPoints()
    for stamp_ns in (*range(KEPT), 0, 100):
        hits.receive(points_to_message(np.array([[stamp_ns, 1.0]]), "map", stamp_ns))
    assert hits.at(0) is not None
    assert hits.at(1) is None, "the oldest was dropped"
    newest = hits.at(100)
    assert newest is not None
    assert newest.tolist() == [[100.0, 1.0]]


@pytest.mark.parametrize(("x", "y", "step"), [(0, 4, 12), (8, 4, 16), (1, 7, 13)])
def test_finite_points_are_read_at_any_offset(x: int, y: int, step: int) -> None:
    expected = np.array([(1.5, -2.0), (np.nan, 0.0), (0.25, np.inf), (4.0, 3.0)])
    data = np.zeros((len(expected), step), np.uint8)
    for column, offset in enumerate((x, y)):
        values = expected[:, column : column + 1].astype("<f4")
        data[:, offset : offset + 4] = values.view(np.uint8)
    fields = [
        PointField(name=name, offset=offset, datatype=PointField.FLOAT32, count=1)
        for name, offset in (("x", x), ("y", y))
    ]
    cloud = PointCloud2(
        height=1, width=len(expected), fields=fields, point_step=step,
        row_step=step * len(expected), data=data.reshape(-1),
    )  # fmt: skip
    points = points_from_message(cloud)
    np.testing.assert_array_equal(points, expected[[0, 3]])


@pytest.mark.parametrize("far", [0.0, 4e3, 5.4e6, -5.4e6])
def test_points_are_exact_wherever_the_map_lies(far: float) -> None:
    points = np.array([(far + 0.013, 0.5), (far - 7.031, 0.25)])
    received = points_from_message(points_to_message(points, "map", 0))
    np.testing.assert_allclose(received, points, rtol=0, atol=3e-4)


@pytest.mark.parametrize(
    "change",
    [
        {"fields": []},
        {"fields": [PointField(name="x", datatype=PointField.INT32)]},
        {"fields": [PointField(name="x", datatype=PointField.FLOAT32)]},
        {"point_step": 4},
        {"point_step": 2**32 - 1},
        {"width": 3},
        {"is_bigendian": True},
    ],
)
def test_an_invalid_cloud_is_refused(change: dict[str, Any]) -> None:
    cloud = points_to_message(np.array([(1.0, 2.0)]), "map", 0)
    for name, value in change.items():
        setattr(cloud, name, value)
    with pytest.raises(InvalidValueError, match="expected x and y"):
        points_from_message(cloud)


def test_a_cloud_of_no_points_may_have_any_step() -> None:
    cloud = points_to_message(np.empty((0, 2)), "map", 0)
    cloud.point_step = 2**32 - 1
    assert points_from_message(cloud).shape == (0, 2)
