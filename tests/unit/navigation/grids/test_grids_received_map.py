"""Whole maps and updates as they may arrive: late, twice, in another order, or not."""

import numpy as np
import pytest

from navette.errors import InvalidInputError
from navette.geometry import Pose2
from navette.navigation.grids import (
    NO_CELLS,
    NO_PART,
    CellWindow,
    GridSpec,
    MapPart,
    MapReader,
    ReceivedMap,
    grid_to_message,
    window_to_message,
)

SPEC = GridSpec(0.5, 6, 4, Pose2(-1.0, 0.0, 0.0))
FRAME = "map"


class Maps:
    """Maps 1, 2, 3, …: each changes one cell, of row 0, to its number.

    The number is also the stamp (s) and that of the update.
    """

    def __init__(self, reader: MapReader) -> None:
        self.reader = reader

    def whole(self, number: int, *, spec: GridSpec = SPEC) -> bool:
        cells = np.zeros(spec.shape, np.int8)
        cells[0, :number] = np.arange(1, number + 1)
        msg = grid_to_message(cells, spec, FRAME, number * 10**9)
        is_new = self.reader.receive_map(msg, FRAME)
        self.apply()
        return is_new

    def update(
        self,
        number: int,
        *,
        empty: bool = False,
        sequence: int | None = 0,
        stamp_s: int | None = None,
        column: int | None = None,
    ) -> MapPart | None:
        at = number - 1 if column is None else column
        window = NO_CELLS if empty else CellWindow(0, 1, at, at + 1)
        cells = np.full((1, at + 1), number, np.int8)
        stamp_ns = (number if stamp_s is None else stamp_s) * 10**9
        msg = window_to_message(cells, window, FRAME, stamp_ns)
        place = number if sequence == 0 else sequence
        self.reader.receive_update(msg, place, FRAME)
        return self.apply()

    def apply(self) -> MapPart | None:
        """Apply the parts that follow the map; return the last one."""
        last = None
        while (part := self.reader.next_part()) is not None:
            assert self.reader.map is not None
            self.reader.map.update(part)
            last = part
        return last

    @property
    def newest(self) -> int:
        """Number of the map that the reader has, as its cells and its stamp say."""
        assert self.reader.map is not None
        row = self.reader.map.cells[0]
        count = int(np.count_nonzero(row))
        assert row[:count].tolist() == list(range(1, count + 1))
        assert self.reader.stamp_ns == count * 10**9
        return count


@pytest.fixture
def maps() -> Maps:
    """Map 1, whole, and its update."""
    made = Maps(MapReader())
    assert made.whole(1)
    assert made.update(1) is None
    return made


def test_updates_follow_the_map_of_their_stamp(maps: Maps) -> None:
    for number in (2, 3, 4):
        assert maps.update(number) is not None
        assert maps.newest == number
        assert not maps.whole(number), "the updates have led to it"
    assert not maps.reader.is_behind


def test_the_array_of_a_message_is_not_changed() -> None:
    cells = np.zeros(SPEC.shape, np.int8)
    received = ReceivedMap(cells, SPEC)
    part = MapPart(np.ones((1, 2), np.int8), CellWindow(1, 2, 0, 2))
    assert received.update(part) == part.window
    own = received.cells
    assert not cells.any()
    received.update(part)
    assert received.cells is own
    received.share()
    received.update(part)
    assert received.cells is not own


def test_a_whole_map_is_used_instead_of_the_updates_to_it(maps: Maps) -> None:
    """Updates that are not taken at once: what changed is known, and nothing copied."""
    reader = maps.reader
    assert reader.map is not None
    for number in (2, 3):
        window = CellWindow(0, 1, number - 1, number)
        cells = np.full((1, number), number, np.int8)
        update = window_to_message(cells, window, FRAME, number * 10**9)
        reader.receive_update(update, number, FRAME)
    cells = np.zeros(SPEC.shape, np.int8)
    cells[0, :3] = 1, 2, 3
    whole = grid_to_message(cells, SPEC, FRAME, 3 * 10**9)
    assert not reader.receive_map(whole, FRAME), "parts lead to it"
    part = reader.next_part()
    assert part is not None
    assert reader.map.update(part) == CellWindow(0, 1, 1, 3)
    np.testing.assert_array_equal(part.cells, [[2, 3]])
    assert np.shares_memory(reader.map.cells, np.asarray(whole.data))
    assert reader.next_part() is None
    assert maps.newest == 3
    assert maps.update(4) is not None
    assert maps.newest == 4
    assert np.asarray(whole.data)[:4].tolist() == [1, 2, 3, 0]


@pytest.mark.parametrize("kind", ["outside", "empty", "larger"])
def test_a_whole_map_replaces_one_to_which_no_parts_lead(maps: Maps, kind: str) -> None:
    at = 6 if kind == "outside" else 1
    window = NO_CELLS if kind == "empty" else CellWindow(0, 1, at, at + 1)
    update = window_to_message(np.zeros((1, 7), np.int8), window, FRAME, 2 * 10**9)
    maps.reader.receive_update(update, 2, FRAME)
    spec = GridSpec(0.5, 8, 4, SPEC.origin) if kind == "larger" else SPEC
    assert maps.whole(2, spec=spec)
    assert maps.reader.map is not None
    assert maps.reader.map.spec == spec
    assert maps.newest == 2


def test_no_part_changes_nothing() -> None:
    cells = np.zeros(SPEC.shape, np.int8)
    received = ReceivedMap(cells, SPEC)
    assert received.update(NO_PART) == NO_CELLS
    assert received.cells is cells


def test_a_missing_update_is_noticed(maps: Maps) -> None:
    assert maps.update(3) is None
    assert maps.reader.is_behind
    assert maps.newest == 1
    assert maps.update(4) is None
    assert maps.whole(4)
    assert maps.update(5) is not None
    assert (maps.newest, maps.reader.is_behind) == (5, False)


def test_later_updates_are_applied_to_a_whole_map_that_is_late(maps: Maps) -> None:
    for number in (3, 4, 5):
        maps.update(number)
    assert maps.whole(3)
    assert (maps.newest, maps.reader.is_behind) == (5, False)


def test_a_whole_map_from_before_a_missing_update_does_not_suffice(maps: Maps) -> None:
    maps.update(4)
    assert maps.whole(2)
    assert (maps.newest, maps.reader.is_behind) == (2, True)
    assert maps.whole(5), "its update is on its way"
    assert maps.update(5) is None
    assert maps.update(6) is not None
    assert maps.newest == 6


def test_an_update_without_cells_announces_a_whole_map(maps: Maps) -> None:
    maps.update(2, empty=True)
    assert maps.reader.is_behind
    maps.update(3)
    larger = GridSpec(0.5, 8, 5, Pose2(-1.0, 0.0, 0.0))
    assert maps.whole(2, spec=larger)
    assert (maps.newest, maps.reader.is_behind) == (3, False)
    assert maps.reader.map is not None
    assert maps.reader.map.spec == larger


def test_updates_are_not_applied_across_a_replaced_map(maps: Maps) -> None:
    for number in (3, 4):
        maps.update(number, empty=number == 4)
    assert maps.whole(3)
    assert (maps.newest, maps.reader.is_behind) == (3, True)


@pytest.mark.parametrize("late", ["updates", "map"])
def test_a_late_reader_has_the_newest_map(late: str) -> None:
    maps = Maps(MapReader())
    for step in ("map", "updates") if late == "updates" else ("updates", "map"):
        if step == "map":
            maps.whole(2)
        else:
            for number in (1, 2, 3):
                maps.update(number)
    assert (maps.newest, maps.reader.is_behind) == (3, False)


def test_a_late_reader_is_behind_if_updates_in_between_are_missing() -> None:
    maps = Maps(MapReader())
    maps.whole(1)
    for number in (3, 4):
        maps.update(number)
    assert (maps.newest, maps.reader.is_behind) == (1, True)


@pytest.mark.parametrize("sequence", [None, 1, 7])
def test_numbers_that_do_not_follow_are_not_trusted(
    maps: Maps, sequence: int | None
) -> None:
    """None: not known. 1: of a publisher that restarted."""
    assert maps.update(2, sequence=sequence) is None
    assert (maps.newest, maps.reader.is_behind) == (1, True)


def test_the_same_stamp_in_another_run_is_another_map(maps: Maps) -> None:
    maps.update(2)
    assert maps.update(3, stamp_s=2) is None, "time went back"
    assert maps.reader.is_behind
    assert maps.whole(2), "the map of this run"
    assert not maps.reader.is_behind


def test_a_map_from_before_a_gap_is_not_that_of_a_later_update(maps: Maps) -> None:
    maps.update(5, stamp_s=1)
    assert maps.reader.is_behind


def test_without_updates_every_whole_map_is_used() -> None:
    maps = Maps(MapReader())
    for number in (1, 3, 2, 2):
        assert maps.whole(number)
        assert maps.newest == number
    assert not maps.reader.is_behind


def test_an_update_outside_the_map_leaves_it_behind(maps: Maps) -> None:
    with pytest.raises(InvalidInputError, match="grid update"):
        maps.update(2, column=6)
    assert (maps.newest, maps.reader.is_behind) == (1, True)


def test_messages_of_another_frame_are_refused(maps: Maps) -> None:
    cells = np.zeros(SPEC.shape, np.int8)
    grid = grid_to_message(cells, SPEC, "odom", 0)
    with pytest.raises(InvalidInputError, match="map in frame 'odom'"):
        maps.reader.receive_map(grid, FRAME)
    update = window_to_message(cells, NO_CELLS, "odom", 0)
    with pytest.raises(InvalidInputError, match="map update in frame 'odom'"):
        maps.reader.receive_update(update, 2, FRAME)


def test_a_reader_that_forgets_needs_a_whole_map(maps: Maps) -> None:
    maps.reader.forget()
    assert maps.update(2) is None
    assert maps.reader.map is None
    assert maps.reader.is_behind
    assert maps.whole(2)
    assert not maps.reader.is_behind
