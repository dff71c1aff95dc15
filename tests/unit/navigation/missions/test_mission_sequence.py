"""The order of goals and their outcomes."""

import math

import pytest

from navette.errors import InvalidValueError
from navette.navigation.missions import GoalSequence, PlannerReport

S = 10**9


def following(goal_id: str) -> PlannerReport:
    return PlannerReport(goal_id, "following")


def reached(goal_id: str) -> PlannerReport:
    return PlannerReport(goal_id, "reached")


def test_goals_are_driven_in_order_with_time_and_length() -> None:
    sequence = GoalSequence([(3.0, 0.0), (3.0, 4.0)])
    sequence.move(0.0, 0.0)
    assert sequence.start_next(1 * S) == (3.0, 0.0)
    assert sequence.start_next(1 * S) is None
    sequence.on_report(following("1"), 2 * S)
    sequence.move(1.0, 1.0)
    sequence.move(2.5, 1.0)
    sequence.on_report(reached("1"), 5 * S)
    [first] = sequence.outcomes
    assert (first.goal, first.result, first.time_s) == ((3.0, 0.0), "reached", 4.0)
    assert first.path_length_m == pytest.approx(math.sqrt(2) + 1.5)
    assert first.distance_left_m == pytest.approx(math.hypot(0.5, 1.0))
    assert not sequence.done
    assert sequence.start_next(5 * S) == (3.0, 4.0)
    sequence.on_report(reached("2"), 6 * S)
    assert sequence.done
    assert sequence.outcomes[1].path_length_m == 0.0


def test_a_repeated_report_on_the_last_goal_does_not_end_the_next() -> None:
    sequence = GoalSequence([(1.0, 0.0), (2.0, 0.0)])
    sequence.start_next(0)
    sequence.on_report(reached("1"), S)
    sequence.start_next(S)
    sequence.on_report(reached("1"), 2 * S)
    assert len(sequence.outcomes) == 1
    sequence.on_report(reached("2"), 3 * S)
    assert len(sequence.outcomes) == 2


def test_without_goal_ids_changes_of_the_report_count() -> None:
    sequence = GoalSequence([(1.0, 0.0), (2.0, 0.0)])
    sequence.start_next(0)
    sequence.on_report(reached(""), S)
    sequence.start_next(S)
    sequence.on_report(reached(""), 2 * S)
    assert len(sequence.outcomes) == 1
    sequence.on_report(following(""), 3 * S)
    sequence.on_report(reached(""), 4 * S)
    assert sequence.done


@pytest.mark.parametrize("failure", ["no_path", "goal_blocked", "stuck", "timed_out"])
def test_a_failure_is_recorded_and_the_next_goal_follows(failure: str) -> None:
    sequence = GoalSequence([(1.0, 0.0), (2.0, 0.0)])
    sequence.start_next(0)
    sequence.on_report(PlannerReport("1", failure), S)
    assert sequence.outcomes[0].result == failure
    assert sequence.start_next(S) == (2.0, 0.0)


def test_stop_on_failure_skips_the_rest() -> None:
    goals = [(1.0, 0.0), (2.0, 0.0), (3.0, 0.0)]
    sequence = GoalSequence(goals, stop_on_failure=True)
    sequence.start_next(0)
    sequence.on_report(PlannerReport("1", "no_path"), S)
    assert [o.result for o in sequence.outcomes] == ["no_path", "skipped", "skipped"]
    assert [o.goal for o in sequence.outcomes] == goals
    assert sequence.done


def test_reports_of_an_active_goal_do_not_end_it() -> None:
    sequence = GoalSequence([(1.0, 0.0)])
    sequence.start_next(0)
    for message in ("planning", "following", "goal_snapped", "stale_odometry"):
        sequence.on_report(PlannerReport("1", message), S)
    assert sequence.active == (1.0, 0.0)


def test_a_planner_that_retries_has_not_failed() -> None:
    sequence = GoalSequence([(1.0, 0.0)])
    sequence.start_next(0)
    sequence.on_report(PlannerReport("1", "no_path", ""), S)
    assert not sequence.done
    sequence.on_report(PlannerReport("1", "no_path", "no_path"), 2 * S)
    assert sequence.outcomes[0].result == "no_path"


def test_a_goal_times_out() -> None:
    sequence = GoalSequence([(1.0, 0.0)], timeout_ns=10 * S)
    sequence.start_next(5 * S)
    sequence.check(14 * S)
    assert not sequence.done
    sequence.check(15 * S)
    assert sequence.outcomes[0].result == "timed_out"
    assert sequence.outcomes[0].distance_left_m == math.inf


def test_a_pause_does_not_count_towards_the_timeout() -> None:
    sequence = GoalSequence([(1.0, 0.0)], timeout_ns=10 * S)
    sequence.start_next(0)
    for second in range(100):
        sequence.check(second * S, paused=5 < second <= 50)
        if sequence.done:
            break
    assert sequence.outcomes[0].time_s == 55.0


def test_goals_may_be_added_during_and_after_the_mission() -> None:
    sequence = GoalSequence()
    assert sequence.done
    assert sequence.start_next(0) is None
    sequence.add(1, 2)
    assert not sequence.done
    assert sequence.total == 1
    assert sequence.start_next(0) == (1.0, 2.0)


@pytest.mark.parametrize("x", [math.nan, math.inf])
def test_a_goal_that_is_not_finite_is_refused(x: float) -> None:
    with pytest.raises(InvalidValueError, match="finite"):
        GoalSequence().add(x, 0.0)


def test_goals_that_have_not_ended_are_unfinished() -> None:
    sequence = GoalSequence([(3.0, 0.0), (3.0, 4.0)])
    sequence.move(0.0, 0.0)
    sequence.start_next(1 * S)
    sequence.move(1.0, 0.0)
    under_way, pending = sequence.unfinished(4 * S)
    assert (under_way.goal, under_way.result) == ((3.0, 0.0), "unfinished")
    assert (under_way.time_s, under_way.path_length_m) == (3.0, 1.0)
    assert under_way.distance_left_m == 2.0
    assert (pending.result, pending.time_s) == ("unfinished", 0.0)
    assert pending.distance_left_m == pytest.approx(math.hypot(2, 4))
    assert not sequence.outcomes
