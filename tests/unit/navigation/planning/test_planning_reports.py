"""Retries in the navigator's reports and in the planner's log."""

from dataclasses import replace

from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.reports import NavigatorReport, Phase
from navette.navigation.planning.servers.navigator_status import goal_text


def ended(report: NavigatorReport, how: Outcome | Phase) -> NavigatorReport:
    return replace(report, message=how.value)


def test_the_same_goal_after_a_failure_is_a_retry() -> None:
    first = NavigatorReport().followed_by(5.0, -5.0)
    assert goal_text(first) == "goal 1 (5, -5)"
    again = ended(first, Outcome.STUCK).followed_by(5.0, -5.0)
    again = ended(again, Outcome.START_BLOCKED).followed_by(5.0, -5.0)
    assert (again.goal_id, again.retry) == (3, 2)
    assert goal_text(again) == "goal 1 (5, -5), retry 2"
    other = ended(again, Outcome.STUCK).followed_by(5.0, 0.0)
    assert goal_text(other) == "goal 4 (5, 0)"


def test_a_goal_after_its_end_or_cancellation_is_a_new_one() -> None:
    first = NavigatorReport().followed_by(5.0, -5.0)
    for how in (Phase.REACHED, Phase.FOLLOWING, Outcome.CANCELED):
        assert ended(first, how).followed_by(5.0, -5.0).retry == 0
