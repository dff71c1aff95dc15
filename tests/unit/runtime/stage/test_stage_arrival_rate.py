"""Ages that an input may reach, from its measured rate."""

import math

import pytest

from navette.runtime.stage.arrival_rate import ArrivalRate

PERIOD_NS = 100_000_000


def test_before_it_is_measured_any_age_is_allowed() -> None:
    rate = ArrivalRate()
    for i in range(3):
        rate.note(i * PERIOD_NS)
    assert math.isinf(rate.allowed_age_s)


@pytest.mark.parametrize("lost", [(), (4,), (3, 7, 8), (2, 3, 4, 9)])
def test_lost_messages_do_not_change_the_measured_period(lost: tuple[int, ...]) -> None:
    rate = ArrivalRate()
    for i in range(14):
        if i not in lost:
            rate.note(i * PERIOD_NS)
    assert rate.allowed_age_s == pytest.approx(0.245)


def test_a_clock_set_back_starts_the_measurement_again() -> None:
    rate = ArrivalRate()
    for i in range(9):
        rate.note(i * PERIOD_NS)
    rate.note(0)
    assert math.isinf(rate.allowed_age_s)
