"""Samples put in order: arbitrary drops, repetitions, answers and gaps given up."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.transports.zenoh.recovery import lane as lane_module
from navette.transports.zenoh.recovery.lane import Lane, Room


def filled(*numbers: int) -> tuple[Lane[int], list[int]]:
    lane: Lane[int] = Lane()
    given_out: list[int] = []
    for number in numbers:
        given_out += take(lane, number)
    return lane, given_out


def take(lane: Lane[int], number: int) -> list[int]:
    return [number] if lane.passes(number) else lane.take(number, number, 1)


def test_what_is_in_order_passes() -> None:
    lane, out = filled(7, 8, 9)
    assert (out, lane.missing(), lane.passes(10)) == ([7, 8, 9], None, True)


def test_what_comes_too_early_waits_for_what_is_missing() -> None:
    lane, out = filled(1, 4, 3)
    assert (out, lane.missing(), lane.passes(5)) == ([1], (2, 2), False)
    assert take(lane, 2) == [2, 3, 4]
    assert (lane.missing(), lane.passes(5)) == (None, True)


def test_what_is_given_up_is_counted_and_does_not_come_any_more() -> None:
    lane, _ = filled(1, 4, 7)
    assert lane.give_up(3) == (2, [4])
    assert take(lane, 3) == []
    assert lane.give_up_all() == (2, [7])
    assert lane.give_up_all() == (0, [])
    assert take(lane, 8) == [8]


def test_the_tail_is_missing_where_the_publisher_has_come_further() -> None:
    lane, _ = filled(1, 2)
    lane.reach(5)
    assert lane.missing() == (3, 5)
    assert take(lane, 3) == [3]
    assert lane.missing() == (4, 5)
    assert take(lane, 5) == []
    assert lane.missing() == (4, 4)


def test_what_was_before_its_time_is_not_missing() -> None:
    lane: Lane[int] = Lane()
    lane.reach(9)
    assert lane.missing() is None
    lane.start_after(9)
    assert lane.missing() is None
    assert take(lane, 11) == []
    assert lane.missing() == (10, 10)


def test_one_that_was_under_way_when_it_began_is_taken() -> None:
    lane: Lane[int] = Lane()
    lane.start_after(9)
    assert take(lane, 9) == [9]
    assert take(lane, 8) == []
    assert take(lane, 10) == [10]


def test_what_comes_before_it_is_said_what_is_owed_waits() -> None:
    lane: Lane[int] = Lane(is_expected=True)
    assert [take(lane, 8), take(lane, 7), take(lane, 7), take(lane, 11)] == [[]] * 4
    assert (lane.is_held_up, lane.missing()) == (True, None)
    assert lane.start_after(5) == []
    assert (lane.is_held_up, lane.missing()) == (False, (6, 6))
    assert take(lane, 6) == [6, 7, 8]
    assert lane.missing() == (9, 10)
    assert lane.start_after(20) == []


def test_what_was_on_its_way_when_it_was_said_is_delivered() -> None:
    lane: Lane[int] = Lane(is_expected=True)
    assert [take(lane, 2**62), take(lane, 7), take(lane, 9)] == [[], [], []]
    assert lane.start_after(8) == [7, 2**62]
    assert lane.missing() == (8, 8)


def test_the_very_first_and_those_of_nobody_known_wait_for_nothing() -> None:
    lane: Lane[int] = Lane(is_expected=True)
    assert [take(lane, 3), take(lane, 1), take(lane, 2)] == [[], [1], [2, 3]]
    other: Lane[int] = Lane(is_expected=True)
    assert [take(other, 5), take(other, 7)] == [[], []]
    assert other.start() == [5]
    assert other.missing() == (6, 6)


def test_lanes_share_a_room() -> None:
    room = Room(3)
    one: Lane[int] = Lane(room)
    two: Lane[int] = Lane(room)
    for number in (1, 3, 4):
        take(one, number)
        take(two, number)
    assert take(one, 2) == [2, 3, 4]
    assert take(two, 2) == [2, 3]
    assert take(two, 5) == []
    assert take(two, 4) == [4, 5]
    one.drop()
    assert room.take(3)


def test_a_jump_beyond_all_measure_costs_nothing() -> None:
    lane, out = filled(1, 2**62, 2**62, 0, 2, 2**62 - 1, 3)
    assert out == [1, 2**62, 2, 2**62 - 1, 3]
    assert (lane.missing(), lane.passes(4)) == (None, True)


def test_two_in_a_row_are_of_a_publisher_that_counts_anew() -> None:
    lane, out = filled(2**62, 1, 2, 3, 2**62 + 1, 4)
    assert out == [2**62, 1, 2, 3, 2**62 + 1, 4]
    assert (lane.missing(), lane.passes(5)) == (None, True)


def test_what_cannot_be_held_counts_as_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lane_module, "MOST_HELD", 2)
    lane, _ = filled(1, 3, 4, 5)
    assert take(lane, 2) == [2, 3, 4]
    assert lane.missing() == (5, 5)


events = st.lists(st.tuples(st.sampled_from("trg"), st.integers(1, 30)))


@given(
    first=st.integers(1, 5), events=events, bound=st.integers(0, 6), kept=st.integers(1)
)
def test_every_sample_once_in_order_or_counted_as_lost(
    first: int, events: list[tuple[str, int]], bound: int, kept: int
) -> None:
    """Samples come, are said to exist, are given up; at last all is asked for, of which
    the publisher has those from ``kept`` on."""
    lane: Lane[int] = Lane()
    lane.start_after(first - 1)
    out: list[int] = []
    newest, abandoned, lost = first - 1, first - 1, 0
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lane_module, "MOST_HELD", bound)
        for what, number in events:
            if what == "t" and number >= first:
                newest = max(newest, number)
                out += take(lane, number)
            elif what == "r":
                newest = max(newest, number)
                lane.reach(number)
            elif what == "g" and number <= newest:
                abandoned = max(abandoned, number)
                more, due = lane.give_up(number)
                lost, out = lost + more, out + due
        while (gap := lane.missing()) is not None:
            for number in range(max(gap[0], kept), gap[1] + 1):
                more, due = lane.give_up(number - 1)
                lost, out = lost + more, out + due + take(lane, number)
            more, due = lane.give_up(gap[1])
            lost, out = lost + more, out + due
    assert all(b > a for a, b in pairwise(out))
    assert len(out) + lost == newest - first + 1
    assert {*range(max(kept, abandoned + 1), newest + 1)} <= {*out}


numbers = st.lists(st.integers(2, 30))


@given(first=st.integers(2, 5), before=numbers, after=numbers)
def test_what_came_before_the_letter_is_in_its_place(
    first: int, before: list[int], after: list[int]
) -> None:
    """The publisher has them all; what it owes from ``first`` on comes, once."""
    lane: Lane[int] = Lane(is_expected=True)
    owed_before, owed_after = (
        [n for n in each if n >= first] for each in (before, after)
    )
    out = [due for number in owed_before for due in take(lane, number)]
    assert out == []
    out += lane.start_after(first - 1)
    out += [due for number in owed_after for due in take(lane, number)]
    while (gap := lane.missing()) is not None:
        out += take(lane, gap[0])
    newest = max([first - 1, *owed_before, *owed_after])
    assert out == list(range(first, newest + 1))
