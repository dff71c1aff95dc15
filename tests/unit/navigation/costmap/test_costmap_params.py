import pytest

from navette.errors import ParameterError
from navette.navigation.costmap import CostmapParams


def test_defaults_are_those_documented() -> None:
    params = CostmapParams()
    assert (params.resolution_m, params.inflation_radius_m, params.max_cost) == (
        0.1,
        1,
        100,
    )
    assert params.inflation_method == "linear"


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"resolution_m": 0.0}, "'resolution_m': 0.0 is not allowed; must be > 0"),
        ({"inflation_method": "cubic"}, "must be one of linear, exponential"),
        ({"max_cost": 101}, "'max_cost': 101"),
        ({"size_m": 100.0, "resolution_m": 0.01}, "'size_m': 100.0 m .* 10000 cells"),
        ({"size_m": 0.01, "inflation_radius_m": 0.0}, "'size_m': 0.01 m"),
        ({"inflation_radius_m": 31.0}, "'inflation_radius_m': 31.0 m"),
    ],
)
def test_bad_values_are_named(values, text) -> None:
    with pytest.raises(ParameterError, match=text):
        CostmapParams(**values)
