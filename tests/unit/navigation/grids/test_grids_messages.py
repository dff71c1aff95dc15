import math

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.msgs import deserialize, serialize
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.navigation.grids import (
    CellWindow,
    GridSpec,
    grid_from_message,
    grid_to_message,
    window_from_message,
    window_to_message,
)

SPEC = GridSpec(0.1, 4, 3, Pose2(-1.5, 2.0, 0.5))
CELLS = np.arange(-1, 11, dtype=np.int8).reshape(3, 4)


def test_round_trip_with_and_without_serialisation() -> None:
    msg = grid_to_message(CELLS, SPEC, "map", 3_000_000_007)
    assert msg.header.frame_id == "map"
    assert (msg.header.stamp.sec, msg.header.stamp.nanosec) == (3, 7)
    for each in (msg, deserialize(serialize(msg), OccupancyGrid)):
        cells, spec = grid_from_message(each)
        np.testing.assert_array_equal(cells, CELLS)
        assert (spec.resolution, spec.shape) == (0.1, (3, 4))
        assert spec.origin == pytest.approx(SPEC.origin)


def test_grid_from_message_is_a_view() -> None:
    msg = grid_to_message(CELLS, SPEC, "map", 0)
    cells, _ = grid_from_message(msg)
    assert np.shares_memory(cells, np.asarray(msg.data))
    assert not np.shares_memory(cells, CELLS)


def test_invalid_messages_are_refused() -> None:
    msg = grid_to_message(CELLS, SPEC, "map", 0)
    msg.info.width = 5
    with pytest.raises(InvalidValueError, match="12 cells, expected 5 x 3 = 15"):
        grid_from_message(msg)
    with pytest.raises(InvalidValueError, match="grid resolution"):
        grid_from_message(OccupancyGrid())
    with pytest.raises(InvalidValueError, match="cells: shape"):
        grid_to_message(CELLS[:2], SPEC, "map", 0)


@pytest.mark.parametrize("resolution", [0.0, -0.1, math.nan, math.inf, 1e-30, 1e30])
def test_resolutions_out_of_range_are_refused(
    resolution: float,
) -> None:
    with pytest.raises(InvalidValueError, match=r"allowed are 0\.001 to 100 m"):
        GridSpec(resolution, 4, 3)


@pytest.mark.parametrize("x", [math.nan, 1e10, -1e300])
def test_origins_out_of_range_are_refused(x: float) -> None:
    with pytest.raises(InvalidValueError, match="grid origin"):
        GridSpec(0.1, 4, 3, Pose2(x, 0.0, 0.0))


def test_a_window_round_trip() -> None:
    window = CellWindow(1, 3, 1, 4)
    msg = window_to_message(CELLS, window, "map", 5)
    assert (msg.x, msg.y, msg.width, msg.height) == (1, 1, 3, 2)
    for each in (msg, deserialize(serialize(msg), OccupancyGridUpdate)):
        cells, there = window_from_message(each, SPEC)
        assert there == window
        np.testing.assert_array_equal(cells, CELLS[1:3, 1:4])


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("x", -1, "columns -1 to 2"),
        ("x", 2, "columns 2 to 5"),
        ("y", 2, "rows 2 to 4; the grid has 4 x 3"),
        ("width", 2, "6 cells, expected 2 x 2"),
    ],
)
def test_windows_that_do_not_fit_are_refused(name: str, value: int, text: str) -> None:
    msg = window_to_message(CELLS, CellWindow(1, 3, 1, 4), "map", 5)
    setattr(msg, name, value)
    with pytest.raises(InvalidValueError, match=text):
        window_from_message(msg, SPEC)
