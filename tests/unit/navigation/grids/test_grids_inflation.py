import math

import numpy as np
import pytest
from scipy.ndimage import distance_transform_edt

from navette.errors import InvalidValueError
from navette.navigation.grids import LETHAL, UNKNOWN, cost_table, inflate


def some_grid(
    rng: np.random.Generator, shape=(80, 130), share: float = 0.01
) -> np.ndarray:
    cost = rng.choice([-1, 0, 30], shape).astype(np.int8)
    cost[rng.random(shape) < share] = LETHAL
    return cost


def test_linear_table_follows_the_formula() -> None:
    table = cost_table("linear", inflation_radius_m=1.0, resolution=0.1)
    assert table.size == 11**2 + 1
    for d2, expected in ((0, 100), (1, 90), (4, 80), (2, 86), (81, 10), (99, 1)):
        assert table[d2] == expected
    assert (table[100:] == UNKNOWN).all()


def test_exponential_table_follows_the_formula() -> None:
    table = cost_table(
        "exponential",
        inflation_radius_m=1.0,
        resolution=0.1,
        max_cost=80,
        decay_per_m=2.0,
    )
    assert table[9] == round(80 * math.exp(-2.0 * 0.3))
    assert (table[100:] == UNKNOWN).all()
    assert table[99] > 0


def test_a_cell_beside_an_obstacle_is_never_lethal() -> None:
    table = cost_table("linear", inflation_radius_m=1.0, resolution=0.001)
    assert table[0] == LETHAL
    assert table[1:].max() == LETHAL - 1


@pytest.mark.parametrize("raise_unknown", [True, False])
@pytest.mark.parametrize("method", ["linear", "exponential"])
@pytest.mark.parametrize("share", [0.0005, 0.01, 0.3])
@pytest.mark.parametrize("radius_m", [0.05, 0.8, 3.1, 3.3, 9.0])
def test_inflation_equals_the_formula_on_exact_distances(
    method, raise_unknown, share, radius_m
) -> None:
    cost = some_grid(np.random.default_rng(3), share=share)
    cost[0, 0] = cost[-1, -1] = LETHAL
    table = cost_table(method, inflation_radius_m=radius_m, resolution=0.1)
    metres = 0.1 * distance_transform_edt(cost < LETHAL)
    fall = 1 - metres / radius_m if method == "linear" else np.exp(-3.0 * metres)
    raised = np.rint(100 * fall)
    raised[(metres > radius_m - 1e-9) | (raised <= 0)] = UNKNOWN
    raised[(cost < LETHAL) & (raised > 99)] = 99
    expected = np.maximum(cost, raised)
    if not raise_unknown:
        expected[cost == UNKNOWN] = UNKNOWN
    found = inflate(cost, table, raise_unknown=raise_unknown)
    np.testing.assert_array_equal(found, expected)


def test_inflation_only_raises_and_keeps_its_input() -> None:
    cost = some_grid(np.random.default_rng(4))
    before = cost.copy()
    found = inflate(cost, cost_table("linear", inflation_radius_m=1, resolution=0.1))
    assert (found >= cost).all()
    np.testing.assert_array_equal(cost, before)


def test_a_grid_without_lethal_cells_is_unchanged() -> None:
    cost = np.array([[-1, 0, 99]], np.int8)
    table = cost_table("linear", inflation_radius_m=1.0, resolution=0.1)
    np.testing.assert_array_equal(inflate(cost, table), cost)


def test_radius_zero_inflates_nothing() -> None:
    cost = np.array([[0, 100, 0]], np.int8)
    table = cost_table("linear", inflation_radius_m=0.0, resolution=0.1)
    np.testing.assert_array_equal(inflate(cost, table), cost)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"method": "cubic"}, "inflation method 'cubic'; allowed: linear, exponential"),
        ({"max_cost": 101}, "max_cost: 101, must be 0 to 100"),
        ({"inflation_radius_m": -1.0}, "inflation_radius_m: -1.0"),
        ({"resolution": 0.0}, "resolution: 0.0"),
        ({"decay_per_m": float("nan")}, "decay_per_m: nan"),
    ],
)
def test_bad_table_values_are_named(change, text) -> None:
    good = {"method": "linear", "inflation_radius_m": 1.0, "resolution": 0.1}
    with pytest.raises(InvalidValueError, match=text):
        cost_table(**(good | change))


def test_bad_grids_are_named() -> None:
    table = cost_table("linear", inflation_radius_m=1.0, resolution=0.1)
    with pytest.raises(InvalidValueError, match="cost: dtype uint8, expected int8"):
        inflate(np.zeros((3, 3), np.uint8), table)
    with pytest.raises(InvalidValueError, match="table: 7 entries"):
        inflate(np.zeros((3, 3), np.int8), table[:7])
