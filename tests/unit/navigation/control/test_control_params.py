"""Conditions between the controller's parameters."""

import pytest

from navette.errors import InvalidValueError, ParameterError
from navette.navigation.control import ControlParams


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"cruise_speed_mps": 3.0}, "cruise_speed_mps"),
        ({"reverse_speed_mps": 3.0}, "reverse_speed_mps"),
        ({"lookahead_min_m": 2.0}, "lookahead_min_m"),
        ({"method": "stanley"}, "pure_pursuit"),
        ({"rate_hz": 5.0}, "rate_hz"),
    ],
)
def test_a_wrong_value_is_named(changes: dict[str, object], named: str) -> None:
    with pytest.raises(ParameterError, match=named):
        ControlParams(**changes)


@pytest.mark.parametrize("footprint", [(1.0, 2.0, 3.0), (1.0, 1.0, 2.0, 1.0, 2.0, 2.0)])
def test_a_wrong_footprint_is_refused(footprint: tuple[float, ...]) -> None:
    with pytest.raises(InvalidValueError, match="footprint"):
        ControlParams(footprint_m=footprint)
