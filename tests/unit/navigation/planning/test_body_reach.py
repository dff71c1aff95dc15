"""Where the body can be, and how long a search without a path takes."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.planning.body_reach import BodyReach
from navette.navigation.planning.margin_planner import MarginPlanner
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.own_methods import Goal
from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.planner import Plan, Planner
from navette.navigation.planning.received_map import NewMap

# 2 m long and 0.5 m wide, with the base near its rear.
LONG = PlannerParams(
    footprint_m=(1.5, 0.25, -0.5, 0.25, -0.5, -0.25, 1.5, -0.25), tight_margin_m=0.03
)
SPEC = GridSpec(0.025, 400, 400, Pose2(-5.0, -5.0, 0.0))


def corridor(yaw: float, width_m: float) -> np.ndarray:
    """A wall 2 m thick through the middle, with a passage of this heading."""
    xy = SPEC.centers_of(np.argwhere(np.ones(SPEC.shape, np.bool_)))
    along = math.cos(yaw) * xy[:, 0] + math.sin(yaw) * xy[:, 1]
    across = math.cos(yaw) * xy[:, 1] - math.sin(yaw) * xy[:, 0]
    solid = (abs(along) < 1.0) & (abs(across) > width_m / 2)
    return (solid.reshape(SPEC.shape) * 100).astype(np.int8)


def reach(occupancy: np.ndarray, yaw: float, params: PlannerParams) -> BodyReach:
    """From one side of the wall to the other."""
    planner = Planner(params)
    planner.set_map(NewMap(occupancy, SPEC))
    x, y = 3.5 * math.cos(yaw), 3.5 * math.sin(yaw)
    return BodyReach(params, planner.map, Pose2(-x, -y, 0.0), Goal(x, y))


@pytest.mark.parametrize("yaw", np.linspace(0.0, math.tau / 64, 7).tolist())
def test_a_long_body_certainly_fits_with_6_cm_at_any_heading(yaw: float) -> None:
    assert reach(corridor(yaw, 0.5 + 0.12 + 0.05), yaw, LONG).certain(0.03).has_goal
    assert not reach(corridor(yaw, 0.5 - 0.05), yaw, LONG).possible(0.03).has_goal


class Searches:
    """Records the searches of planners."""

    def __init__(self, patch: pytest.MonkeyPatch) -> None:
        self.outcomes: list[Outcome] = []
        original = MarginPlanner.plan

        def plan(self_: MarginPlanner, *args: object, **kwargs: object) -> Plan:
            found = original(self_, *args, **kwargs)  # type: ignore[arg-type]
            self.outcomes.append(found.outcome)
            return found

        patch.setattr(MarginPlanner, "plan", plan)


@pytest.fixture
def searches(monkeypatch: pytest.MonkeyPatch) -> Searches:
    return Searches(monkeypatch)


def blocked() -> tuple[Planner, np.ndarray]:
    """A planner whose body is 5 cm too wide for the only passage."""
    occupancy = corridor(0.0, 0.45)
    planner = Planner(LONG)
    planner.set_map(NewMap(occupancy.copy(), SPEC))
    return planner, occupancy


def test_a_goal_behind_a_narrow_gap_is_not_searched_for(searches: Searches) -> None:
    planner, _ = blocked()
    plan = planner.plan(Pose2(-3.5, 0.0, 0.0), Goal(3.5, 0.0))
    assert plan.outcome is Outcome.NO_PATH
    assert plan.expansions <= 2_000


def test_a_plan_without_a_path_is_not_repeated_until_something_opens(
    searches: Searches,
) -> None:
    planner, occupancy = blocked()
    start, goal = Pose2(-3.5, 0.0, 0.0), Goal(3.5, 0.0)
    assert planner.plan(start, goal).outcome is Outcome.NO_PATH
    count = len(searches.outcomes)
    occupancy[150:153, 50:53] = 100  # an obstacle more
    planner.set_map(NewMap(occupancy.copy(), SPEC))
    assert planner.plan(Pose2(-3.4, 0.0, 0.1), goal).outcome is Outcome.NO_PATH
    assert len(searches.outcomes) == count
    occupancy[:] = corridor(0.0, 0.8)
    planner.set_map(NewMap(occupancy.copy(), SPEC))
    assert planner.plan(start, goal).outcome.has_path


def test_another_goal_and_another_start_are_planned_again(searches: Searches) -> None:
    planner, _ = blocked()
    start = Pose2(-3.5, 0.0, 0.0)
    assert planner.plan(start, Goal(3.5, 0.0)).outcome is Outcome.NO_PATH
    assert planner.plan(start, Goal(-3.5, 1.0)).outcome.has_path
    assert planner.plan(start, Goal(3.5, 0.0)).outcome is Outcome.NO_PATH
    there = Pose2(3.5, 1.0, 0.0)
    assert planner.plan(there, Goal(3.5, 0.0)).outcome.has_path
