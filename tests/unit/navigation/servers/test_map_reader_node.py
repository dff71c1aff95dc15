"""A node that reads the map requests the whole one if updates are missing."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.msgs import topics
from navette.msgs.nav_msgs.srv import GetMap
from navette.navigation.grids import (
    NO_CELLS,
    CellWindow,
    GridSpec,
    MapPart,
    SquareRegion,
    grid_to_message,
    window_to_message,
)
from navette.navigation.mapping.node import MapMemoryNode
from navette.navigation.servers.map_reader_node import (
    MAP_UPDATES_INPUT,
    MapReaderNode,
)
from navette.navigation.shared_params import MotionParams
from navette.runtime import Input, Parameter
from navette.runtime.testing import GraphHarness

SPEC = GridSpec(0.5, 6, 4, Pose2(-1.0, 0.0, 0.0))
PART = CellWindow(1, 2, 0, 3)


class Reader(MapReaderNode):
    """Stores the cells of each map."""

    PARAMS = MotionParams
    INPUTS = (Input.of(topics.MAP, "map", callback="on_map"), MAP_UPDATES_INPUT)

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("reader", **kwargs)
        self.seen: list[np.ndarray] = []

    def on_new_map(self, part: MapPart | None) -> None:
        assert self._maps.map is not None
        self._maps.map.update(part)
        self.seen.append(self._maps.map.cells.copy())


class Rig:
    """A reader, and a publisher of maps that can lose updates."""

    def __init__(self, graph: GraphHarness) -> None:
        self.graph, self.requests = graph, 0
        self.cells = np.zeros(SPEC.shape, np.int8)
        self.frame = "map"
        self.reader = graph.add(Reader(context=graph.context))
        self.change(NO_CELLS)
        self.send_map()
        graph.run_for(0.01)

    def change(self, window: CellWindow = PART) -> None:
        """Publish an update of cells that have changed."""
        self.graph.run_for(0.01)
        self.cells[window.slices] += 1
        self.stamp_ns = self.graph.now_ns
        msg = window_to_message(self.cells, window, "map", self.stamp_ns)
        self.graph.publish("/map_updates", msg, latched=True)
        self.graph.run_for(0.01)

    def lose_update(self) -> None:
        """Change the map; the reader drops the update, whose number is missing."""
        self.cells[0, 0] += 1
        msg = window_to_message(self.cells, PART, "odom", self.graph.now_ns)
        self.graph.publish("/map_updates", msg, latched=True)
        self.graph.run_for(0.01)

    def send_map(self) -> None:
        self.graph.publish("/map", self._message(), latched=True)
        self.graph.run_for(0.01)

    def serve(self) -> None:
        def get(_: Any, response: Any) -> Any:
            self.requests += 1
            response.map = self._message()
            return response

        self.graph.node.create_service(GetMap, "/map_server/map", get)

    def _message(self) -> Any:
        return grid_to_message(self.cells, SPEC, self.frame, self.stamp_ns)

    @property
    def is_right(self) -> bool:
        return bool(np.array_equal(self.reader.seen[-1], self.cells))


@pytest.fixture
def rig() -> Iterator[Rig]:
    with GraphHarness() as graph:
        yield Rig(graph)


def test_updates_need_no_request(rig: Rig) -> None:
    rig.serve()
    for _ in range(3):
        rig.change()
        assert rig.is_right
    rig.graph.run_for(5.0)
    assert rig.requests == 0
    assert len(rig.reader.seen) == 4


def test_after_a_lost_update_the_whole_map_is_requested(rig: Rig) -> None:
    rig.serve()
    rig.lose_update()
    rig.change()
    assert not rig.is_right
    assert len(rig.reader.seen) == 1, "the old map is kept"
    rig.graph.run_for(2.0)
    assert (rig.is_right, rig.requests) == (True, 1)
    rig.change()
    assert rig.is_right
    rig.graph.run_for(5.0)
    assert rig.requests == 1


def test_a_whole_map_that_follows_needs_no_request(rig: Rig) -> None:
    rig.serve()
    rig.lose_update()
    rig.change()
    rig.graph.run_for(0.5)
    rig.send_map()
    assert rig.is_right
    rig.graph.run_for(5.0)
    assert rig.requests == 0


def test_the_request_waits_for_a_server(rig: Rig) -> None:
    rig.lose_update()
    rig.change()
    rig.graph.run_for(5.0)
    assert not rig.is_right
    rig.serve()
    rig.graph.run_for(2.0)
    assert (rig.is_right, rig.requests) == (True, 1)


def test_a_response_that_cannot_be_used_is_dropped(rig: Rig) -> None:
    rig.serve()
    rig.frame = "odom"
    rig.lose_update()
    rig.change()
    rig.graph.run_for(2.0)
    assert rig.requests == 1
    assert rig.reader.dropped_inputs["/map", "unknown_frame"] == 1
    rig.frame = "map"
    rig.graph.run_for(2.0)
    assert (rig.is_right, rig.requests) == (True, 2)


def test_a_late_reader_of_a_map_memory_gets_its_map() -> None:
    """The latched one is from before more updates than are latched."""
    with GraphHarness() as graph:
        values = {"size_m": 5.0, "always_send_full_map": False}
        memory = graph.add(
            MapMemoryNode(
                context=graph.context,
                parameter_overrides=[Parameter(k, value=v) for k, v in values.items()],
            )
        )
        memory.load_map(np.full(SPEC.shape, 100, np.int8), SPEC)
        for column in range(topics.MAP_UPDATES.depth + 2):
            graph.run_for(0.01)
            x = SPEC.origin.x + column % SPEC.width * SPEC.resolution
            memory.clear_costmap(SquareRegion(x, 1.0, 0.6))
        wholes = graph.collect("/map", "nav_msgs/msg/OccupancyGrid", latched=True)
        reader = graph.add(Reader(context=graph.context))
        graph.run_for(0.01)
        newest = memory.newest_grid()
        assert wholes.last.header != newest.header
        graph.run_for(3.0)
        cells = reader.seen[-1]
        np.testing.assert_array_equal(cells.reshape(-1), np.asarray(newest.data))
        assert wholes.count == 2
