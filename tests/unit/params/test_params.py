import math
from dataclasses import dataclass

import pytest

from navette.errors import ParameterError
from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class DemoParams(Params):
    speed: float = param(0.5, "cruise speed", unit="m/s", above=0.0, at_most=2.0)
    count: int = param(3, "how many", at_least=0)
    method: str = param("fast", "which way", choices=("fast", "safe"))
    outline: tuple[float, ...] = param((0.0, 1.0), "corners", unit="m")
    enabled: bool = param(True, "whether at all")


def test_an_integer_is_converted_to_a_float() -> None:
    params = DemoParams(speed=1, outline=[1, 2])
    assert params.speed == 1.0
    assert isinstance(params.speed, float)
    assert params.outline == (1.0, 2.0)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"speed": 0.0}, ["speed", "0.0", "> 0", "m/s"]),
        ({"speed": 2.5}, ["speed", "2.5", "<= 2"]),
        ({"speed": math.nan}, ["speed", "nan"]),
        ({"speed": "fast"}, ["speed", "'fast'", "expected float"]),
        ({"count": True}, ["count", "True", "expected int"]),
        ({"count": 1.0}, ["count", "1.0", "expected int"]),
        ({"method": "slow"}, ["method", "slow", "fast, safe"]),
        ({"outline": "12"}, ["outline", "'12'"]),
        ({"enabled": 1}, ["enabled", "expected bool"]),
        ({"sped": 1.0}, ["unknown parameter 'sped'", "speed", "outline"]),
    ],
)
def test_errors_name_the_value_and_the_allowed_values(
    values: dict[str, object], words: list[str]
) -> None:
    with pytest.raises(ParameterError) as caught:
        DemoParams.from_dict(values)
    for word in words:
        assert word in str(caught.value)
