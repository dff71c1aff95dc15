"""Clouds are found by their stamp, in every pass of a recording that repeats."""

import numpy as np
import pytest

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
