import math

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.navigation.costmap import CostmapParams, PlanarScan, ScanCostmap

PARAMS = CostmapParams(size_m=10.0, inflation_radius_m=0.5)


def scan(ranges, *, angle_min=0.0, increment=0.01, range_max=8.0) -> PlanarScan:
    return PlanarScan(
        np.asarray(ranges, np.float32), angle_min, increment, 0.1, range_max
    )


def arc(distance: float) -> np.ndarray:
    """Readings of a round wall, 0.2 rad wide."""
    return np.full(21, distance)


def test_the_sensor_is_at_the_centre_of_the_middle_cell() -> None:
    for size, resolution in ((10.0, 0.1), (3.0, 0.05), (0.25, 0.1), (0.1, 0.1)):
        params = CostmapParams(
            size_m=size, resolution_m=resolution, inflation_radius_m=0.1
        )
        spec = ScanCostmap(params).spec
        assert spec.width == spec.height
        assert spec.width * resolution >= size - 1e-9
        middle = spec.width // 2
        assert spec.center_of(middle, middle) == pytest.approx((0.0, 0.0), abs=1e-9)


def test_free_up_to_the_hit_lethal_there_unknown_beyond() -> None:
    """Cells beyond the hit must not be marked free."""
    maker = ScanCostmap(PARAMS)
    cost = maker.build(scan(arc(3.0), angle_min=-0.1))
    middle = maker.spec.width // 2
    row = cost[middle, middle:]
    assert (row[:25] == 0).all()
    assert row[30] == 100
    assert (row[31:] == -1).all()
    assert (cost[:, : middle - 1] == -1).all()


def test_cost_falls_linearly_before_the_hit() -> None:
    maker = ScanCostmap(PARAMS)
    cost = maker.build(scan(arc(3.0), angle_min=-0.1))
    middle = maker.spec.width // 2
    assert cost[middle, middle + 25 : middle + 31].tolist() == [0, 20, 40, 60, 80, 100]


def test_exponential_inflation() -> None:
    params = CostmapParams(
        size_m=10.0,
        inflation_radius_m=0.5,
        inflation_method="exponential",
        inflation_decay_per_m=2.0,
        max_cost=80,
    )
    cost = ScanCostmap(params).build(scan(arc(3.0), angle_min=-0.1))
    expected = [round(80 * math.exp(-2.0 * d / 10)) for d in (4, 3, 2, 1)]
    assert cost[50, 76:81].tolist() == [*expected, 100]


def test_unmeasured_cells_beside_obstacles_stay_unknown() -> None:
    maker = ScanCostmap(PARAMS)
    cost = maker.build(scan(arc(2.0), angle_min=-0.1))
    shadow = cost[50, 72:76]
    assert (shadow == -1).all()


def test_no_return_is_free_to_the_border_at_most() -> None:
    maker = ScanCostmap(PARAMS)
    cost = maker.build(scan(np.full(629, np.inf)))
    assert (cost >= 0).mean() > 0.9
    assert not (cost > 0).any()
    near = maker.build(scan(np.full(629, np.inf), range_max=2.0))
    assert (near[50, 50:70] == 0).all()
    assert (near[50, 72:] == -1).all()


@pytest.mark.parametrize("reading", [math.nan, 0.0, 0.05, -1.0, -math.inf])
def test_invalid_readings_are_ignored(reading) -> None:
    assert (ScanCostmap(PARAMS).build(scan([reading] * 9)) == -1).all()


def test_an_empty_scan_is_all_unknown() -> None:
    assert (ScanCostmap(PARAMS).build(scan([])) == -1).all()


def test_hits_outside_the_grid_leave_no_mark() -> None:
    cost = ScanCostmap(PARAMS).build(scan(arc(7.0), angle_min=-0.1))
    assert (cost[50, 50:] == 0).all()


def test_an_unlimited_range_is_accepted() -> None:
    cost = ScanCostmap(PARAMS).build(scan([3.0, 3.0], range_max=math.inf))
    assert cost[50, 80] == 100


def test_a_beam_along_a_wall_does_not_free_its_cells() -> None:
    # A wall along y = 0.52, seen sideways: the cells in row 55 hold it.
    increment = math.tau / 256
    angles = 0.11 + increment * np.arange(20)
    wall = (0.52 / np.sin(angles)).astype(np.float32)
    beams = scan(wall, angle_min=0.11, increment=increment)
    keeping = ScanCostmap(CostmapParams(size_m=10.0, inflation_radius_m=0.0))
    erasing = ScanCostmap(
        CostmapParams(size_m=10.0, inflation_radius_m=0.0, grazing_margin_m=0.0)
    )
    assert (erasing.build(beams)[55] == 0).sum() >= 5
    assert (keeping.build(beams)[55] == 0).sum() == 0
    assert (keeping.build(beams)[55] == 100).sum() == (
        erasing.build(beams)[55] == 100
    ).sum()


def test_the_same_scan_gives_the_same_costmap() -> None:
    maker = ScanCostmap(PARAMS)
    first = maker.build(scan(arc(3.0)))
    maker.build(scan(np.full(300, 2.0), increment=0.02))
    np.testing.assert_array_equal(maker.build(scan(arc(3.0))), first)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ((math.nan, 0.1, 0.1, 8.0), "angle_min nan"),
        ((0.0, math.inf, 0.1, 8.0), "angle_increment inf"),
        ((0.0, 0.1, 8.0, 8.0), "range_min 8.0, range_max 8.0"),
        ((0.0, 0.1, -0.1, 8.0), "range_min -0.1"),
        ((0.0, 0.1, 0.1, math.nan), "range_max nan"),
    ],
)
def test_bad_scans_are_named(values, text) -> None:
    with pytest.raises(InvalidValueError, match=text):
        PlanarScan(np.ones(3, np.float32), *values)
