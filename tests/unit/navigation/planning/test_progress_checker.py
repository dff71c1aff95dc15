"""Attempts of one goal: what counts as progress."""

from navette.navigation.planning.params import PlannerParams
from navette.navigation.planning.progress_checker import ProgressChecker

SECOND_NS = 1_000_000_000


def checker() -> ProgressChecker:
    """Four attempts, 0.2 m of progress, a robot that stands at the origin."""
    made = ProgressChecker(PlannerParams())
    made.note(0.0, (0.0, 0.0), 0)
    return made


def test_a_robot_that_hovers_around_a_place_uses_up_its_attempts() -> None:
    checks = checker()
    for attempt in range(5):
        assert not checks.exhausted
        checks.spend()
        checks.new_path(0.0)
        checks.note(0.4, (0.3, 0.0), attempt * SECOND_NS)
    assert checks.exhausted


def test_a_robot_that_leaves_the_place_has_all_its_attempts_again() -> None:
    checks = checker()
    for attempt in range(4):
        checks.spend()
        checks.new_path(0.0)
        checks.note(0.4, (0.3, 0.0), attempt * SECOND_NS)
    checks.note(0.7, (0.6, 0.0), 5 * SECOND_NS)
    assert checks.spent == 0


def test_a_robot_that_is_carried_away_makes_no_progress() -> None:
    checks = checker()
    checks.spend()
    checks.note(0.1, (2.0, 0.0), SECOND_NS)
    assert checks.spent == 1
    assert checks.no_progress(6 * SECOND_NS)


def test_progress_at_the_place_restarts_the_timeout() -> None:
    checks = checker()
    checks.spend()
    checks.note(0.3, (0.3, 0.0), 5 * SECOND_NS)
    assert not checks.no_progress(6 * SECOND_NS)
