"""Every robot passes a door 0.12 m wider than its body, in a thin and a deep wall."""

import math

import pytest
from bench_doors import ROBOTS, Door, body_size_m, drive

SLACK_M = 0.12


@pytest.mark.long
@pytest.mark.parametrize("thickness_m", [0.1, 2.0])
@pytest.mark.parametrize("robot", ROBOTS)
def test_a_robot_passes_a_tight_door(robot: str, thickness_m: float) -> None:
    # Turned and shifted, so that the walls lie across the cells of the maps.
    door = Door(
        robot,
        body_size_m(robot)[1] + SLACK_M,
        thickness_m,
        angle=math.radians(7),
        shift_m=0.023,
    )
    result, contacts, clearance_m = drive(door)
    assert result == "reached"
    assert contacts == 0
    assert clearance_m > 0.0
