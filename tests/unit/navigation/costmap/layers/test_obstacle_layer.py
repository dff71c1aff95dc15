"""The obstacle layer: height band, drops, ranges, contacts; messages to points."""

import math

import numpy as np
import pytest

from navette.errors import InvalidInputError
from navette.geometry import Footprint, Pose2, Transform3, quaternion_from_rpy
from navette.msgs.sensor_msgs.msg import LaserScan, PointCloud2, PointField, Range
from navette.navigation.costmap.layers.observation import (
    Cone,
    Observation,
    cloud_points,
    of_range,
    of_scan,
)
from navette.navigation.costmap.layers.obstacle_layer import (
    ObstacleLayer,
    floor_crossings,
)
from navette.navigation.costmap.layers.params import (
    ObstacleLayerParams,
    RangeLayerParams,
    SourceParams,
)

HERE = Pose2(0.0, 0.0, 0.0)
SOURCE = SourceParams(topic="/cloud", max_obstacle_height=1.0)
NOTHING = np.empty((0, 3))


def layer(footprint: Footprint | None = None, **values: object) -> ObstacleLayer:
    return ObstacleLayer(
        ObstacleLayerParams(**values), RangeLayerParams(), 10.0, footprint
    )


def seen(*points: tuple[float, float, float], height: float = 0.8) -> Observation:
    return Observation(np.array([0.0, 0.0, height]), np.array(points), NOTHING)


def places(made: ObstacleLayer, now_ns: int = 0) -> list[list[float]]:
    return sorted(np.round(made.obstacles(HERE, now_ns), 3).tolist())


def test_only_hits_within_the_height_band_and_the_range_mark() -> None:
    made = layer()
    made.observe(
        seen((1.0, 0.0, 0.02), (1.5, 0.0, 0.5), (2.0, 0.0, 1.4), (3.5, 0.0, 0.5)),
        SOURCE,
        HERE,
    )
    assert places(made) == [[1.525, 0.025]]


def test_a_ray_through_a_mark_clears_it_and_one_above_does_not() -> None:
    made = layer()
    made.observe(seen((1.5, 0.0, 0.5)), SOURCE, HERE)
    made.observe(seen((3.5, 0.0, 0.8)), SOURCE, HERE)  # passes at 0.8 m
    assert places(made) == [[1.525, 0.025]]
    made.observe(seen((3.2, 0.0, 0.24)), SOURCE, HERE)  # passes at 0.53 m
    assert not places(made)


def test_a_planar_lidar_does_not_clear_a_table_top() -> None:
    made = layer()
    made.observe(seen((1.5, 0.0, 0.72)), SOURCE, HERE)
    low = Observation(np.array([0.0, 0.0, 0.2]), NOTHING, np.array([[4.0, 0.0, 0.2]]))
    made.observe(low, SourceParams(topic="/scan", data_type="LaserScan"), HERE)
    assert len(places(made)) == 1


def test_a_drop_is_marked_where_the_floor_is_missing_until_floor_is_seen() -> None:
    made = layer()
    made.observe(seen((2.0, 0.0, -0.8)), SOURCE, HERE)
    assert places(made) == [[1.025, 0.025]]  # half way: sensor at 0.8, hit at -0.8
    made.observe(seen((1.01, 0.01, 0.03)), SOURCE, HERE)
    assert not places(made)
    off = SourceParams(topic="/cloud", max_drop_height=0.0)
    made.observe(seen((2.0, 0.0, -0.8)), off, HERE)
    assert not places(made)


@pytest.mark.parametrize("seed", range(5))
def test_crossings_of_the_floor_lie_on_the_rays(seed: int) -> None:
    rng = np.random.default_rng(seed)
    origin = rng.uniform((-1, -1, 0.1), (1, 1, 2))
    ends = rng.uniform((-5, -5, -3), (5, 5, -0.05), (50, 3))
    crossing, share = floor_crossings(origin, ends)
    points = origin + share[:, None] * (ends - origin)
    assert points[:, 2] == pytest.approx(0.0, abs=1e-12)
    assert points[:, :2] == pytest.approx(crossing)
    assert ((share > 0) & (share < 1)).all()


def test_a_contact_is_an_obstacle_for_its_time_whatever_sensors_see() -> None:
    made = layer(bump_persistence_s=10.0)
    made.bump(Pose2(0.3, 0.0, 0.0), 0)
    made.observe(seen((3.0, 0.0, 0.0)), SOURCE, HERE)
    found = np.array(places(made, 5 * 10**9))
    assert found[:, 0] == pytest.approx(0.35)
    assert np.ptp(found[:, 1]) == pytest.approx(0.2)
    assert not places(made, 11 * 10**9)


def test_range_readings_mark_and_clear() -> None:
    made = layer()
    for _ in range(8):
        made.measure(Cone(1.0, 0.13, is_free=False), HERE, HERE)
    assert places(made)
    for _ in range(30):
        made.measure(Cone(4.0, 0.13, is_free=True), HERE, HERE)
    assert not places(made)


def test_what_lies_under_the_robot_is_cleared() -> None:
    body = Footprint(((0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2)))
    made = layer(body)
    made.observe(seen((0.1, 0.0, 0.5), (1.0, 0.0, 0.5)), SOURCE, HERE)
    assert places(made) == [[1.025, 0.025]]
    kept = layer(body, footprint_clearing_enabled=False)
    kept.observe(seen((0.1, 0.0, 0.5)), SOURCE, HERE)
    assert len(places(kept)) == 1


def test_observations_are_placed_by_the_pose_of_the_sensor() -> None:
    turn = quaternion_from_rpy(0.0, math.pi / 2, 0.0)  # looks straight down
    placed = Observation(np.zeros(3), np.array([[0.8, 0.0, 0.0]]), NOTHING).placed(
        Transform3((1.0, 2.0, 0.8), turn)
    )
    assert placed.origin == pytest.approx((1.0, 2.0, 0.8))
    assert placed.hits[0] == pytest.approx((1.0, 2.0, 0.0), abs=1e-9)


# Messages


def test_beams_of_a_scan() -> None:
    msg = LaserScan(
        angle_min=0.0,
        angle_increment=math.pi / 2,
        range_min=0.1,
        range_max=5.0,
        ranges=np.array([2.0, np.inf, np.nan, 0.05], np.float32),
    )
    found = of_scan(msg, inf_is_valid=True)
    assert found.hits == pytest.approx(np.array([[2.0, 0.0, 0.0]]))
    assert found.misses == pytest.approx(np.array([[0.0, 5.0, 0.0]]), abs=1e-9)
    assert not len(of_scan(msg, inf_is_valid=False).misses)
    msg.range_min = 7.0
    with pytest.raises(InvalidInputError, match="range_min"):
        of_scan(msg, inf_is_valid=True)


@pytest.mark.parametrize(
    "changes",
    [
        {"angle_min": math.nan},
        {"angle_increment": math.nan},
        {"angle_increment": 1e30},
        {"range_max": 1e30},
        {"range_max": math.inf},
        {"range_min": -1.0},
    ],
)
def test_scans_without_usable_geometry_are_refused(changes: dict[str, float]) -> None:
    values = {
        "angle_min": 0.0,
        "angle_increment": 0.1,
        "range_min": 0.1,
        "range_max": 5.0,
    }
    msg = LaserScan(**{**values, **changes}, ranges=np.ones(3, np.float32))
    with pytest.raises(InvalidInputError) as caught:
        of_scan(msg, inf_is_valid=True)
    assert caught.value.reason == "out_of_range"


def test_a_signalling_nan_is_left_out() -> None:
    ranges = np.array([0x7F800001, 0x3F800000], np.uint32).view(np.float32)
    msg = LaserScan(angle_increment=0.1, range_max=5.0, ranges=ranges)
    assert len(of_scan(msg, inf_is_valid=True).hits) == 1


def cloud(kind: str, *, is_bigendian: bool = False) -> PointCloud2:
    """Points (1, 2, 3) and NaN with other fields between."""
    order = ">" if is_bigendian else "<"
    dtype = np.dtype(
        [("i", "u1"), ("z", order + kind), ("x", order + kind), ("y", order + kind)]
    )
    points = np.array([(7, 3.0, 1.0, 2.0), (7, np.nan, 0.0, 0.0)], dtype)
    datatype = PointField.FLOAT32 if kind == "f4" else PointField.FLOAT64
    assert dtype.fields is not None
    fields = [
        PointField(name=n, offset=dtype.fields[n][1], datatype=datatype, count=1)
        for n in "xyz"
    ]
    return PointCloud2(
        height=1,
        width=2,
        fields=fields,
        is_bigendian=is_bigendian,
        point_step=dtype.itemsize,
        row_step=2 * dtype.itemsize,
        data=points.view(np.uint8).reshape(-1),
    )


@pytest.mark.parametrize("kind", ["f4", "f8"])
@pytest.mark.parametrize("is_bigendian", [False, True])
def test_finite_points_of_any_layout(kind: str, is_bigendian: bool) -> None:
    points = cloud_points(cloud(kind, is_bigendian=is_bigendian))
    assert points.tolist() == [[1.0, 2.0, 3.0]]


@pytest.mark.parametrize(
    "changes",
    [
        {"width": 3},
        {"point_step": 1},
        {"fields": []},
        {"height": 2**31, "width": 2**31},
        {"row_step": 5},
    ],
)
def test_invalid_clouds_are_refused_by_name(changes: dict[str, object]) -> None:
    msg = cloud("f4")
    for name, value in changes.items():
        setattr(msg, name, value)
    with pytest.raises(InvalidInputError) as caught:
        cloud_points(msg)
    assert caught.value.reason == "invalid_cloud"


def test_an_empty_cloud_has_no_points() -> None:
    assert cloud_points(PointCloud2()).shape == (0, 3)


@pytest.mark.parametrize(
    ("reading", "expected"),
    [
        (1.0, (1.0, False)),
        (math.inf, (4.0, True)),
        (4.0, (4.0, True)),
        (-math.inf, (0.02, False)),
        (0.01, (0.02, False)),
        (math.nan, None),
    ],
)
def test_readings_of_a_range_finder(
    reading: float, expected: tuple[float, bool] | None
) -> None:
    msg = Range(min_range=0.02, max_range=4.0, field_of_view=0.26, range=reading)
    cone = of_range(msg)
    assert (cone and (cone.reading, cone.is_free)) == (
        expected and pytest.approx(expected)
    )
    msg.field_of_view = 0.0
    with pytest.raises(InvalidInputError, match="field_of_view"):
        of_range(msg)
