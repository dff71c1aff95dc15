import math

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, beam_directions, trace_beams

SPEC = GridSpec(0.1, 60, 50, Pose2(-3.0, -2.5, 0.0))


def unknown(spec: GridSpec = SPEC) -> np.ndarray:
    return np.full(spec.shape, -1, np.int8)


def bresenham(r0: int, c0: int, r1: int, c1: int) -> list[tuple[int, int]]:
    """Cells of a line, both ends included: the textbook's error form."""
    rows, columns = abs(r1 - r0), abs(c1 - c0)
    dr, dc = (1 if r1 > r0 else -1), (1 if c1 > c0 else -1)
    cells, r, c = [(r0, c0)], r0, c0
    error = max(rows, columns) // 2
    for _ in range(max(rows, columns)):
        error += min(rows, columns)
        step = error >= max(rows, columns)
        error -= max(rows, columns) * step
        if rows > columns:
            r, c = r + dr, c + dc * step
        else:
            r, c = r + dr * step, c + dc
        cells.append((r, c))
    assert cells[-1] == (r1, c1)
    return cells


def oracle(spec, sensor, directions, ranges, range_min, range_max) -> np.ndarray:
    """The definition in plain Python, for scans that stay inside the grid."""
    cost, hits = unknown(spec), []
    start = spec.cell_of(*sensor)
    for (dx, dy), reading in zip(directions, ranges.astype(float), strict=True):
        if not reading > range_min:
            continue
        reach = min(reading, range_max)
        end = spec.cell_of(sensor[0] + reach * dx, sensor[1] + reach * dy)
        for cell in bresenham(*start, *end):
            cost[cell] = 0
        if reading < range_max:
            hits.append(end)
    for cell in hits:
        cost[cell] = 100
    return cost


def trace(ranges, *, spec=SPEC, sensor=(0.0, 0.0), angle=0.0, **limits) -> np.ndarray:
    cost = unknown(spec)
    ranges = np.asarray(ranges, np.float32)
    directions = beam_directions(angle, 0.3, len(ranges))
    limits = {"range_min": 0.2, "range_max": 2.0} | limits
    trace_beams(cost, spec, sensor, directions, ranges, **limits)
    return cost


@pytest.mark.parametrize("yaw", [0.0, 0.8, -2.5])
def test_cells_equal_the_plain_definition(yaw) -> None:
    rng = np.random.default_rng(5)
    directions = beam_directions(-math.pi, math.tau / 180, 180)
    for _ in range(20):
        spec = GridSpec(0.1, 80, 90, Pose2(*rng.uniform(-1, 1, 2), yaw))
        sensor = spec.center_of(45, 40)
        ranges = rng.uniform(0.0, 3.5, 180).astype(np.float32)
        ranges[rng.random(180) < 0.1] = np.inf
        ranges[rng.random(180) < 0.1] = np.nan
        cost = unknown(spec)
        trace_beams(
            cost, spec, sensor, directions, ranges, range_min=0.3, range_max=3.0
        )
        expected = oracle(spec, sensor, directions, ranges, 0.3, 3.0)
        np.testing.assert_array_equal(cost, expected)


def test_long_lines_equal_the_plain_definition() -> None:
    rng = np.random.default_rng(6)
    spec = GridSpec(1.0, 20_000, 300, Pose2(0.0, 0.0, 0.0))
    sensor = spec.center_of(7, 3)
    ends = np.column_stack([rng.uniform(9e3, 2e4, 12), rng.uniform(8.0, 299.0, 12)])
    away = ends - sensor
    ranges = np.hypot(*away.T).astype(np.float32)
    directions = away / ranges[:, None]
    cost = unknown(spec)
    trace_beams(cost, spec, sensor, directions, ranges, range_min=0.1, range_max=1e5)
    expected = oracle(spec, sensor, directions, ranges, 0.1, 1e5)
    np.testing.assert_array_equal(cost, expected)


def test_free_up_to_the_hit_and_unknown_beyond() -> None:
    row = trace([1.05])[25]
    assert row.tolist() == [-1] * 30 + [0] * 10 + [100] + [-1] * 19


def test_no_return_is_free_up_to_range_max_only() -> None:
    for reading in (math.inf, 2.0, 65.0):
        row = trace([reading], range_max=2.05)[25]
        assert (row == 100).sum() == (1 if reading == 2.0 else 0)
    row = trace([math.inf], range_max=2.05)[25]
    assert row.tolist() == [-1] * 30 + [0] * 21 + [-1] * 9


@pytest.mark.parametrize("reading", [math.nan, -math.inf, -1.0, 0.0, 0.15])
def test_invalid_readings_write_nothing(reading) -> None:
    assert (trace([reading]) == -1).all()


def test_a_hit_survives_the_other_beams() -> None:
    near = unknown()
    directions = np.array([[1.0, 0.0], [1.0, 0.0]])
    for ranges in ([1.05, 1.85], [1.85, 1.05]):
        trace_beams(
            near,
            SPEC,
            (0.0, 0.0),
            directions,
            np.array(ranges, np.float32),
            range_min=0.2,
            range_max=2.0,
        )
        assert near[25, 40] == 100
        assert near[25, 48] == 100


def test_beams_end_at_the_border() -> None:
    cost = trace([math.inf] * 21, range_max=50.0)
    assert set(np.unique(cost)) == {-1, 0}
    assert cost[25, 30:].tolist() == [0] * 30
    assert (trace([40.0], range_max=50.0) != 100).all()


def test_margin_stops_freeing_before_the_hit() -> None:
    cost = unknown()
    hits = trace_beams(
        cost,
        SPEC,
        (0.0, 0.0),
        np.array([[1.0, 0.0]]),
        np.array([1.05], np.float32),
        range_min=0.1,
        range_max=2.0,
        margins=np.array([0.3], np.float32),
    )
    assert hits == 1
    assert cost[25, 30:42].tolist() == [0] * 7 + [-1] * 3 + [100, -1]


def test_count_of_hits() -> None:
    cost = unknown()
    ranges = np.array([1.0, math.inf, math.nan, 1.0, 9.0], np.float32)
    directions = beam_directions(0.0, 0.5, 5)
    limits = {"range_min": 0.1, "range_max": 5.0}
    assert trace_beams(cost, SPEC, (0, 0), directions, ranges, **limits) == 2


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"cost": np.zeros((3, 3), np.int8)}, "cost: shape"),
        ({"cost": unknown().astype(np.int16)}, "cost: dtype int16"),
        ({"cost": unknown()[:, ::-1]}, "writable C-ordered"),
        ({"ranges": np.ones(4)}, "ranges: dtype float64"),
        ({"ranges": np.ones(5, np.float32)}, r"5 ranges, directions \(4, 2\)"),
        ({"sensor": (50.0, 0.0)}, r"sensor at \(50.0, 0.0\): outside"),
        ({"range_min": 3.0}, "range_min 3.0, range_max 2.0"),
        ({"range_max": math.inf}, "range_max inf"),
    ],
)
def test_bad_input_is_named(change, text) -> None:
    good = {
        "cost": unknown(),
        "spec": SPEC,
        "sensor": (0.0, 0.0),
        "directions": beam_directions(0.0, 0.1, 4),
        "ranges": np.ones(4, np.float32),
        "range_min": 0.1,
        "range_max": 2.0,
    }
    with pytest.raises(InvalidValueError, match=text):
        trace_beams(**(good | change))


def fan(ranges: np.ndarray) -> np.ndarray:
    """Return the cells of beams 0.05 rad apart about the x axis, 12 m at 0.05 m."""
    spec = GridSpec(0.05, 240, 240, Pose2(-6.0, -6.0, 0.0))
    cost = np.full(spec.shape, -1, np.int8)
    directions = beam_directions(-0.05 * (len(ranges) - 1) / 2, 0.05, len(ranges))
    trace_beams(
        cost,
        spec,
        (0.0, 0.0),
        directions,
        ranges.astype(np.float32),
        range_min=0.1,
        range_max=5.5,
        fills=True,
    )
    return cost


def test_the_space_before_a_wall_is_free_without_rays() -> None:
    angles = 0.05 * (np.arange(13) - 6)
    cost = fan(4.0 / np.cos(angles))
    # Column 190 is 3.5 m ahead, rows 110 to 129 within half a metre of the axis.
    assert (cost[110:130, 150:190] == 0).mean() > 0.97
    assert (cost[:, 205:] == -1).all()


def test_nothing_is_freed_between_two_objects() -> None:
    ranges = np.array([2.0, 2.0, 4.0, 4.0])
    cost = fan(ranges)
    assert (fan(np.full(4, 4.0))[119:121, 180:195] == 0).all()
    assert (cost[119:121, 180:195] == -1).all()


def test_beams_without_echo_free_the_space_between_them() -> None:
    cost = fan(np.full(4, np.inf))
    assert (cost[119:121, 180:215] == 0).all()
