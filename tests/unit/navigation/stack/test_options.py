import math

import pytest

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.navigation.stack.options import RunOptions


def test_a_headless_run_ends_with_its_goals() -> None:
    assert RunOptions(headless=True, goals=((1, 2),)).ends_with_goals
    assert not RunOptions(headless=True).ends_with_goals
    assert not RunOptions(goals=((1, 2),)).ends_with_goals


@pytest.mark.parametrize(
    ("wrong", "name"),
    [
        ({"speed": 0.0}, "speed"),
        ({"speed": math.nan}, "speed"),
        ({"seed": -1}, "seed"),
        ({"max_time_s": 0.0}, "max time"),
        ({"max_time_s": math.inf}, "max time"),
        ({"start": Pose2(math.nan, 0, 0)}, "start"),
    ],
)
def test_a_wrong_option_is_named(wrong: dict[str, object], name: str) -> None:
    with pytest.raises(InvalidValueError, match=name):
        RunOptions(**wrong)
