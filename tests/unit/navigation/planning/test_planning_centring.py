"""Lines are centred in tight places."""

import numpy as np
import pytest
from planning_worlds import empty_map, fill

from navette.navigation.planning import Planner, PlannerParams
from navette.navigation.planning.centring import centred

SQUARE = (0.3, 0.3, -0.3, 0.3, -0.3, -0.3, 0.3, -0.3)


@pytest.mark.parametrize("count", [2, 3, 4, 5, 30])
def test_lines_of_any_number_of_points_move_to_the_middle(count: int) -> None:
    occupancy, spec = empty_map(6, 4)
    fill(occupancy, spec, (1, 5), (0, 1.6))
    fill(occupancy, spec, (1, 5), (2.4, 4))
    planner = Planner(PlannerParams(footprint_m=SQUARE, clearance_margin_m=0.03))
    planner.set_map(occupancy, spec)
    line = np.column_stack([np.linspace(2, 4, count), np.full(count, 2.05)])
    line[[0, -1], 1] = 2.0
    moved = centred(line, planner.grid(), planner.body)
    assert moved[[0, -1]] == pytest.approx(line[[0, -1]])
    assert np.abs(moved[:, 1] - 2.0).max() <= np.abs(line[:, 1] - 2.0).max()
    if count == 30:
        assert np.abs(moved[5:-5, 1] - 2.0).max() < 0.04
