"""Selection of scans: the newest that a reader at the end of each period gets."""

import pytest

from navette.runtime.stamp_selection import StampSelection

MS = 1_000_000


def taken(rate_hz: float, stamps_ms: list[int]) -> list[int]:
    selection = StampSelection(rate_hz)
    return [stamp for stamp in stamps_ms if selection.takes(stamp * MS)]


def test_selects_the_last_scan_of_each_period() -> None:
    stamps = list(range(0, 400, 20))
    # 20 Hz of 50 Hz: a reader at 50, 100, 150 ms gets scans 10 to 20 ms old.
    assert taken(20.0, stamps) == [0, 40, 80, 140, 180, 240, 280, 340, 380]


@pytest.mark.parametrize("period_ms", [50, 100, 200])
def test_selects_every_scan_of_a_sensor_that_is_not_faster(period_ms: int) -> None:
    stamps = list(range(7, 2000, period_ms))
    assert taken(20.0, stamps) == stamps


def test_a_rate_of_zero_selects_every_scan() -> None:
    assert taken(0.0, [0, 1, 2, 3]) == [0, 1, 2, 3]


def test_selects_a_scan_after_the_clock_went_back_or_repeated() -> None:
    assert taken(20.0, [1000, 1010, 200, 200]) == [1000, 200, 200]
