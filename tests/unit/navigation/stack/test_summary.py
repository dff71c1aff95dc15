import json
import math
from dataclasses import replace

from navette.navigation.missions import GoalOutcome
from navette.navigation.stack.summary import PoseError, RunSummary


def summary(*results: str, contacts: int = 0) -> RunSummary:
    goals = tuple(GoalOutcome((1.0, 2.0), r, 3.0, 4.0, 0.05) for r in results)
    return RunSummary(goals, contacts, math.inf, 3.0, 0.1, 30.0, 7, PoseError(0.2, 0.1))


def test_success_means_all_goals_reached_without_contact() -> None:
    assert summary("reached", "reached").succeeded
    assert not summary("reached", "no_path").succeeded
    assert not summary("reached", contacts=1).succeeded


def test_json_has_the_documented_keys_and_only_finite_numbers() -> None:
    read = json.loads(summary("reached").to_json())
    assert set(read) == {
        "goals",
        "contacts",
        "min_clearance_m",
        "sim_time_s",
        "wall_time_s",
        "real_time_factor",
        "seed",
        "pose_error_m",
        "true_goal_distance_m",
        "goal_tolerance_m",
    }
    assert read["pose_error_m"] == {
        "worst": 0.2,
        "final": 0.1,
        "map_fits_world": None,
    }
    assert read["min_clearance_m"] is None
    assert read["goals"][0] == {
        "goal": [1.0, 2.0],
        "result": "reached",
        "time_s": 3.0,
        "path_length_m": 4.0,
        "distance_left_m": 0.05,
    }


def test_a_goal_is_missed_beyond_the_tolerance() -> None:
    near = replace(summary("reached"), true_goal_distance_m=0.4, goal_tolerance_m=0.5)
    assert near.missed_m is None
    far = replace(near, true_goal_distance_m=5.51)
    assert far.missed_m == 5.51
    assert far.succeeded, "goals are judged by the estimate"
    assert summary("reached").missed_m is None, "unknown"
