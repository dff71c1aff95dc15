"""The measured period of an input, and its timeout."""

import numpy as np
import pytest

from navette.runtime.stage.input_period import InputPeriod

MILLISECOND = 1_000_000


def arrivals(*intervals_ms: float) -> InputPeriod:
    period, now_ns = InputPeriod(), 0
    period.note(now_ns)
    for interval in intervals_ms:
        now_ns += round(interval * MILLISECOND)
        period.note(now_ns)
    return period


def test_the_period_is_zero_until_it_was_measured() -> None:
    assert arrivals(100, 100).seconds == 0.0
    assert arrivals(100, 100).timeout_s(0.19, 3.2) == 0.19
    assert arrivals(100, 100, 100).seconds == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("period_ms", "timeout_s"), [(20, 0.19), (100, 0.32), (200, 0.42), (2000, 0.42)]
)
def test_the_timeout_follows_the_period_between_limits(
    period_ms: float, timeout_s: float
) -> None:
    assert arrivals(*[period_ms] * 5).timeout_s(0.19, 3.2) == pytest.approx(timeout_s)


def test_a_larger_parameter_wins() -> None:
    assert arrivals(*[2000] * 5).timeout_s(4.0, 3.2) == 4.0


def test_lost_messages_and_a_new_rate() -> None:
    rng = np.random.default_rng(1)
    lossy = arrivals(*np.where(rng.random(50) < 0.2, 200, 100))
    assert lossy.seconds == pytest.approx(0.1)
    assert arrivals(*[100] * 20, *[50] * 8).seconds == pytest.approx(0.05)


def test_reset_forgets_the_arrivals() -> None:
    period = arrivals(*[100] * 5)
    period.reset()
    period.note(7 * MILLISECOND)
    assert period.seconds == 0.0
