"""Whole maps as messages that are used again once no reader has them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.geometry import Pose2
from navette.navigation.grids import CellWindow, GridSpec, grid_to_message
from navette.navigation.mapping.whole_maps import WholeMaps

SPEC = GridSpec(0.05, 7, 5, Pose2(-1.0, 2.0, 0.0))
WIDER = GridSpec(0.05, 9, 5, Pose2(-1.1, 2.0, 0.0))
NARROWER = GridSpec(0.1, 4, 3, Pose2(-1.0, 2.0, 0.0))


def unknown(spec: GridSpec) -> np.ndarray:
    return np.full(spec.shape, -1, np.int8)


def test_a_message_without_a_reader_becomes_the_next_one() -> None:
    maps, cells = WholeMaps(), unknown(SPEC)
    first = id(maps.message(cells, SPEC, "map", 1))
    cells[1:3, 2] = 100
    maps.note_change(CellWindow(1, 3, 2, 3))
    message = maps.message(cells, SPEC, "map", 2)
    assert id(message) == first
    assert message == grid_to_message(cells, SPEC, "map", 2)


@pytest.mark.parametrize("later", [WIDER, NARROWER])
def test_a_message_is_used_again_when_the_map_has_another_size(later: GridSpec) -> None:
    maps = WholeMaps()
    first = id(maps.message(unknown(SPEC), SPEC, "map", 1))
    maps.note_change(None)
    cells = np.arange(later.width * later.height, dtype=np.int8).reshape(later.shape)
    message = maps.message(cells, later, "map", 2)
    assert id(message) == first
    assert message == grid_to_message(cells, later, "map", 2)


def test_what_a_reader_keeps_of_a_message_does_not_change() -> None:
    maps, cells = WholeMaps(), unknown(SPEC)
    message = maps.message(cells, SPEC, "map", 1)
    view, header, info = np.asarray(message.data), message.header, message.info
    del message
    cells[:] = 0
    maps.note_change(CellWindow.whole(SPEC.shape))
    newer = maps.message(cells, SPEC, "map", 2)
    assert (view == -1).all()
    assert (np.asarray(newer.data) == 0).all()
    del newer, view  # the first message is free again, but for its header
    maps.message(cells, SPEC, "map", 3)
    maps.message(cells, SPEC, "map", 4)
    assert header.stamp.nanosec == info.map_load_time.nanosec == 1


steps = st.tuples(
    st.sampled_from(["change", "reset", "grow"]),
    st.tuples(st.integers(0, 4), st.integers(0, 6)),
    st.integers(-1, 100),
    st.booleans(),
    st.booleans(),
)


@settings(max_examples=300, deadline=None)
@given(st.lists(steps, max_size=30))
def test_messages_are_those_of_full_copies(
    changes: list[tuple[str, tuple[int, int], int, bool, bool]],
) -> None:
    maps, spec, cells = WholeMaps(), SPEC, unknown(SPEC)
    held = []
    for stamp_ns, (kind, (row, column), value, asked, kept) in enumerate(changes):
        if kind == "change":
            cells[row:, column] = value
            maps.note_change(CellWindow(row, spec.height, column, column + 1))
        else:
            spec = SPEC if kind == "reset" else WIDER
            cells = unknown(spec)
            maps.note_change(None)
        if not asked:
            continue  # no whole map is published
        message = maps.message(cells, spec, "map", stamp_ns)
        expected = grid_to_message(cells, spec, "map", stamp_ns)
        assert message == expected
        if kept:
            held.append((message, expected))
        else:
            del message
        held = held[-5:]
        assert all(each == before for each, before in held)
