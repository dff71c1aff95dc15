"""Point clouds: layouts, byte orders, padding, NaN, organised clouds, transforms."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.errors import InvalidValueError
from navette.msgs import deserialize, serialize
from navette.msgs.geometry_msgs.msg import Quaternion, TransformStamped
from navette.msgs.sensor_msgs.msg import PointCloud2, PointField
from navette.msgs.std_msgs.msg import Header
from navette.ros2.packages.sensor_msgs_py import point_cloud2
from navette.ros2.packages.sensor_msgs_py.point_cloud2 import PointCloudError
from navette.ros2.packages.tf2_ros import Buffer
from navette.ros2.packages.tf2_sensor_msgs import do_transform_cloud

NAN = float("nan")
XYZ = [(0.0, 0.5, 1.0), (2.0, NAN, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0)]
HEADER = Header(frame_id="lidar")


def field(name: str, offset: int, datatype: int, count: int = 1) -> PointField:
    return PointField(name=name, offset=offset, datatype=datatype, count=count)


VELODYNE = [
    field("x", 0, PointField.FLOAT32),
    field("y", 4, PointField.FLOAT32),
    field("z", 8, PointField.FLOAT32),
    field("intensity", 12, PointField.FLOAT32),
    field("ring", 16, PointField.UINT16),
    field("time", 18, PointField.FLOAT32),
]


def velodyne_points(count: int) -> np.ndarray[Any, Any]:
    points = np.zeros(count, point_cloud2.dtype_from_fields(VELODYNE, 22))
    points["x"] = np.arange(count)
    points["ring"] = np.arange(count) % 16
    points["time"] = 0.25
    return points


def test_a_list_and_its_cloud_are_equal() -> None:
    cloud = point_cloud2.create_cloud_xyz32(HEADER, XYZ)
    assert (cloud.width, cloud.height, cloud.point_step, cloud.row_step) == (
        4,
        1,
        12,
        48,
    )
    assert [f.name for f in cloud.fields] == ["x", "y", "z"]
    assert np.array_equal(point_cloud2.read_points_numpy(cloud), XYZ, equal_nan=True)
    arrived = deserialize(serialize(cloud), PointCloud2)
    points = point_cloud2.read_points(arrived, field_names=("z", "x"))
    assert points.dtype.names == ("z", "x")
    assert points["z"].tolist() == [1.0, 3.0, 6.0, 9.0]


def test_named_tuples() -> None:
    cloud = point_cloud2.create_cloud_xyz32(HEADER, XYZ)
    points = point_cloud2.read_points_list(cloud, skip_nans=True, uvs=[2, 0])
    assert [(p.x, p.y, p.z) for p in points] == [XYZ[3], XYZ[0]]
    assert isinstance(points[0].x, float)


def test_nans_are_skipped_in_the_read_fields_only() -> None:
    cloud = point_cloud2.create_cloud_xyz32(HEADER, XYZ)
    assert len(point_cloud2.read_points(cloud, skip_nans=True)) == 3
    assert len(point_cloud2.read_points(cloud, ["x", "z"], skip_nans=True)) == 4
    cloud.is_dense = True  # the publisher states that there are none
    assert len(point_cloud2.read_points(cloud, skip_nans=True)) == 4


def test_the_layout_of_a_velodyne() -> None:
    points = velodyne_points(50)
    cloud = point_cloud2.create_cloud(HEADER, VELODYNE, points, 22)
    assert cloud.point_step == 22
    read = point_cloud2.read_points(cloud)
    assert read.dtype == points.dtype
    assert np.array_equal(read, points)
    assert np.shares_memory(read, np.asarray(cloud.data))  # nothing was copied
    points["x"] = -1.0  # nor shares the cloud with what it was made from
    assert point_cloud2.read_points(cloud)["x"][3] == 3.0
    with pytest.raises(AssertionError, match="ring uint16"):
        point_cloud2.read_points_numpy(cloud)
    xyz = point_cloud2.read_points_numpy(cloud, field_names=["x", "y", "z"])
    assert xyz.shape == (50, 3)
    assert xyz.dtype == np.float32


def test_big_endian_data_is_not_changed() -> None:
    cloud = point_cloud2.create_cloud(HEADER, VELODYNE, velodyne_points(5), 22)
    swapped = velodyne_points(5).astype(
        point_cloud2.dtype_from_fields(VELODYNE, 22).newbyteorder(">")
    )
    cloud.is_bigendian = True
    cloud.data = np.frombuffer(swapped.tobytes(), np.uint8)
    before = bytes(cloud.data)
    for _ in range(2):
        points = point_cloud2.read_points(cloud)
        assert points["x"].tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
        assert points.dtype["x"] == np.float32  # in the machine's order
    assert bytes(cloud.data) == before


def test_padding_of_points_and_of_rows() -> None:
    """2 rows of 3 points of 12 + 4 bytes, rows padded to 64."""
    data = np.zeros(128, np.uint8)
    for row in range(2):
        for column in range(3):
            start = row * 64 + column * 16
            data[start : start + 12] = np.frombuffer(
                np.float32([row, column, 7]).tobytes(), np.uint8
            )
    cloud = point_cloud2.create_cloud_xyz32(HEADER, np.zeros((3, 2, 3)))
    cloud.point_step, cloud.row_step, cloud.data = 16, 64, data
    points = point_cloud2.read_points_numpy(cloud)
    assert points.tolist() == [[r, c, 7] for r in range(2) for c in range(3)]
    cloud.data = data[: 64 + 48]  # the last row's padding need not be there
    assert np.array_equal(point_cloud2.read_points_numpy(cloud), points)
    cloud.data = data[: 64 + 47]
    with pytest.raises(PointCloudError, match="expected 112 bytes of data, got 111"):
        point_cloud2.read_points(cloud)


def test_organised_clouds_have_the_shape_of_ros_2() -> None:
    points = np.arange(18, dtype=np.float32).reshape(2, 3, 3)
    cloud = point_cloud2.create_cloud_xyz32(HEADER, points)
    assert (cloud.width, cloud.height) == (2, 3)
    back = point_cloud2.read_points_numpy(cloud, reshape_organized_cloud=True)
    assert np.array_equal(back, points)
    assert point_cloud2.read_points(cloud).shape == (6,)


def test_counts_and_missing_names() -> None:
    fields = [
        field("xyz", 0, PointField.FLOAT32, count=3),
        field("", 12, PointField.UINT8),
    ]
    dtype = point_cloud2.dtype_from_fields(fields)
    assert dtype.names == ("xyz_0", "xyz_1", "xyz_2", "unnamed_field_1")
    assert dtype.itemsize == 13
    cloud = point_cloud2.create_cloud(HEADER, fields, [(1, 2, 3, 4), (5, 6, 7, 8)])
    assert point_cloud2.read_points(cloud)["unnamed_field_1"].tolist() == [4, 8]
    assert point_cloud2.read_points_list(cloud)[1].xyz_2 == 7


def test_an_empty_cloud() -> None:
    cloud = point_cloud2.create_cloud_xyz32(HEADER, np.zeros((0, 3)))
    assert point_cloud2.read_points_numpy(cloud).shape == (0, 3)
    assert point_cloud2.read_points(PointCloud2()).shape == (0,)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda c: point_cloud2.read_points(c, ["w"]), "no field 'w'.*x, y, z"),
        (lambda c: point_cloud2.read_points("cloud"), "PointCloud2, got str"),
        (
            lambda c: point_cloud2.dtype_from_fields([field("x", 0, 9)]),
            "unknown datatype 9",
        ),
        (
            lambda c: point_cloud2.dtype_from_fields([field("x", 0, 7, 0)]),
            "count 0",
        ),
        (
            lambda c: point_cloud2.dtype_from_fields([*c.fields, c.fields[0]]),
            "fields x, y, z, x",
        ),
        (lambda c: point_cloud2.dtype_from_fields(c.fields, 8), "point_step 8"),
        (
            lambda c: point_cloud2.create_cloud_xyz32(HEADER, np.zeros((5, 2))),
            r"shape \(5, 2\): expected \(…, 3\)",
        ),
        (
            lambda c: point_cloud2.create_cloud(HEADER, VELODYNE, np.zeros((5, 6))),
            "same datatype",
        ),
        (
            lambda c: point_cloud2.create_cloud(HEADER, c.fields, velodyne_points(3)),
            "do not match the fields",
        ),
        (
            lambda c: point_cloud2.create_cloud_xyz32(HEADER, np.zeros((2, 2, 2, 3))),
            "one or two dimensions",
        ),
    ],
)
def test_wrong_arguments(make: Any, message: str) -> None:
    cloud = point_cloud2.create_cloud_xyz32(HEADER, XYZ)
    with pytest.raises(AssertionError, match=message) as caught:  # as in ROS 2
        make(cloud)
    assert isinstance(caught.value, InvalidValueError)


_COLUMNS = st.lists(
    st.tuples(st.sampled_from(range(1, 9)), st.integers(0, 5)), min_size=1, max_size=6
)


@given(
    _COLUMNS, st.integers(0, 7), st.integers(0, 5), st.randoms(use_true_random=False)
)
def test_any_layout_is_read_as_it_was_written(
    columns: list[tuple[int, int]], padding: int, count: int, random: Any
) -> None:
    """Fields of any type at any offset, with padding between and behind."""
    fields, offset = [], 0
    for number, (datatype, gap) in enumerate(columns):
        offset += gap
        fields.append(field(f"f{number}", offset, datatype))
        offset += point_cloud2.dtype_from_fields([field("f", 0, datatype)]).itemsize
    step = offset + padding
    rows = [[random.randrange(100) for _ in fields] for _ in range(count)]
    cloud = point_cloud2.create_cloud(HEADER, fields, rows, step)
    assert cloud.point_step == step
    assert len(cloud.data) == step * count
    assert [list(p) for p in point_cloud2.read_points_list(cloud)] == rows


def lidar_in_map() -> TransformStamped:
    transform = TransformStamped(child_frame_id="lidar")
    transform.header.frame_id = "map"
    transform.transform.translation.x = 10.0
    half = 0.5**0.5
    transform.transform.rotation = Quaternion(z=half, w=half)  # x becomes y
    return transform


def test_a_cloud_in_another_frame() -> None:
    points = velodyne_points(4)
    cloud = point_cloud2.create_cloud(HEADER, VELODYNE, points, 22)
    cloud.header.stamp.sec = 7
    cloud.height, cloud.width, cloud.row_step = 2, 2, 44
    buffer = Buffer()
    buffer.set_transform_static(lidar_in_map())
    moved = buffer.transform(cloud, "map")
    assert (moved.header.frame_id, moved.header.stamp.sec) == ("map", 7)
    assert (moved.height, moved.width) == (2, 2)
    read = point_cloud2.read_points(moved)
    assert np.allclose(read["x"], 10)
    assert np.allclose(read["y"], [0, 1, 2, 3])
    assert np.array_equal(read["ring"], points["ring"])
    assert np.array_equal(point_cloud2.read_points(cloud), points)


def test_a_cloud_without_coordinates_cannot_be_transformed() -> None:
    fields = [field("x", 0, PointField.FLOAT32)]
    cloud = point_cloud2.create_cloud(HEADER, fields, [(1.0,)])
    with pytest.raises(PointCloudError, match=r"x, y and z; the cloud has x"):
        do_transform_cloud(cloud, lidar_in_map().transform)
