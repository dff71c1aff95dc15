"""A point cloud on the page, for different field layouts."""

import math
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from test_viewer_javascript import run_node

from navette.msgs.sensor_msgs.msg import PointCloud2, PointField
from navette.msgs.std_msgs.msg import Header
from navette.ros2.packages.sensor_msgs_py.point_cloud2 import read_points
from navette.runtime import Context, Node

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_harness import Program

pytestmark = pytest.mark.long

WIDTH, HEIGHT, STEP, PADDING = 900, 16, 23, 11


def street() -> np.ndarray:
    """Return (16, 900, 3) points of 16 beams, 1.8 m above a street 12 m wide."""
    turn = np.linspace(0.0, math.tau, WIDTH, endpoint=False)
    rise = np.radians(np.arange(-15, 17, 2))[:, None]
    along = np.stack(
        np.broadcast_arrays(
            np.cos(rise) * np.cos(turn), np.cos(rise) * np.sin(turn), np.sin(rise)
        ),
        axis=-1,
    )
    with np.errstate(divide="ignore"):
        floor = np.where(along[..., 2] < 0, -1.8 / along[..., 2], np.inf)
        wall = 6.0 / np.abs(along[..., 1])
    distance = np.minimum(floor, wall)
    distance[distance > 60.0] = np.nan
    return along * distance[..., None]


def cloud(points: np.ndarray) -> PointCloud2:
    """Big endian, at odd offsets, with padded points and rows."""
    names = {"x": 3, "y": 7, "z": 13}
    dtype = np.dtype(
        {
            "names": list(names),
            "formats": [">f4"] * 3,
            "offsets": list(names.values()),
            "itemsize": STEP,
        }
    )
    rows = np.zeros((HEIGHT, STEP * WIDTH + PADDING), np.uint8)
    for row, line in zip(rows, points, strict=True):
        filled = np.zeros(WIDTH, dtype)
        for index, name in enumerate(names):
            filled[name] = line[:, index]
        row[: STEP * WIDTH] = filled.view(np.uint8)
    fields = [
        PointField(name=name, offset=offset, datatype=PointField.FLOAT32, count=1)
        for name, offset in names.items()
    ]
    return PointCloud2(
        header=Header(frame_id="velodyne"),
        height=HEIGHT,
        width=WIDTH,
        fields=fields,
        is_bigendian=True,
        point_step=STEP,
        row_step=STEP * WIDTH + PADDING,
        data=rows.tobytes(),
    )


class Lidar(Node):
    """Publishes a cloud at 10 Hz."""

    def __init__(self, context: Context) -> None:
        super().__init__("velodyne", context=context)
        self.publisher = self.create_publisher(PointCloud2, "/velodyne_points", 10)
        message = cloud(street())
        self.create_timer(0.1, lambda: self.publisher.publish(message))


def test_the_cloud_is_read_as_a_structured_array() -> None:
    points = street()
    read = read_points(cloud(points), skip_nans=True)
    assert read.dtype.names == ("x", "y", "z")
    assert read.dtype.isnative
    sound = points[~np.isnan(points).any(axis=-1)]
    np.testing.assert_array_equal(read["y"], sound[:, 1].astype(np.float32))


@pytest.mark.slow
def test_the_page_shows_a_cloud_when_asked() -> None:
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if chromium is None:
        pytest.skip("Chromium is not installed")
    points = street().reshape(-1, 3)
    points = points[~np.isnan(points).any(axis=1)]
    with Program(Lidar) as program:
        seen = run_node("cloud.mjs", program.viewer.url, chromium)
    assert seen["problems"] == []
    assert seen["offered"] == "hidden"  # clouds are large
    assert (seen["topic"], seen["frame"]) == ("/velodyne_points", "velodyne")
    assert seen["points"] == len(points)
    assert seen["first"] == pytest.approx(points[0].tolist(), abs=1e-5)
