"""The explorer while its worker searches for frontiers, with a paced clock."""

import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.msgs.nav_msgs.msg import Odometry
from navette.navigation.grids import (
    NO_CELLS,
    CellWindow,
    GridSpec,
    MapPart,
    grid_to_message,
    window_to_message,
)
from navette.navigation.missions.explore.frontiers import Exploration, FrontierSearch
from navette.navigation.missions.explore.node import ExplorerNode
from navette.runtime.clock import PacedClock
from navette.runtime.testing import GraphHarness
from navette.runtime.time import ns_to_stamp

WAIT_S = 30.0
SPEC = GridSpec(0.5, 20, 20, Pose2(0.0, 0.0, 0.0))


@pytest.fixture
def graph() -> Iterator[GraphHarness]:
    with GraphHarness(clock=PacedClock(factor=50.0)) as harness:
        yield harness


def room() -> np.ndarray:
    """Free cells in unknown ones."""
    cells = np.full(SPEC.shape, -1, np.int8)
    cells[2:12, 2:12] = 0
    return cells


def test_a_map_that_arrives_during_a_search_does_not_change_it(
    graph: GraphHarness, monkeypatch: pytest.MonkeyPatch
) -> None:
    explorer = graph.add(ExplorerNode(context=graph.context))
    free: list[int] = []
    arrived = threading.Event()
    first_ns = graph.now_ns

    def send_update(number: int) -> None:
        """Publish that two more columns are free."""
        cells = room()
        cells[2:12, 12 : 12 + 2 * number] = 0
        window = CellWindow(2, 12, 10 + 2 * number, 12 + 2 * number)
        update = window_to_message(cells, window, "map", first_ns + number)
        graph.publish("/map_updates", update, latched=True)

    explore = FrontierSearch.explore

    def search(self: FrontierSearch, *args: Any, **options: Any) -> Exploration:
        if len(free) == 1:
            graph.context.loop.call_soon_threadsafe(lambda: send_update(2))
            assert arrived.wait(WAIT_S), "the loop continues"
        found = explore(self, *args, **options)
        free.append(round(found.free_m2 / SPEC.resolution**2))
        return found

    monkeypatch.setattr(FrontierSearch, "explore", search)
    usual = explorer.on_new_map

    def on_new_map(part: MapPart | None) -> None:
        usual(part)
        if explorer._maps.stamp_ns == first_ns + 2:
            arrived.set()

    monkeypatch.setattr(explorer, "on_new_map", on_new_map)
    graph.publish("/odom/filtered", odometry(first_ns))
    graph.run_for(0.1)
    none = window_to_message(room(), NO_CELLS, "map", first_ns)
    graph.publish("/map_updates", none, latched=True)
    whole = grid_to_message(room(), SPEC, "map", first_ns)
    graph.publish("/map", whole, latched=True)
    graph.run_for(0.01)
    send_update(1)
    graph.run_for(1.0)
    assert arrived.is_set()
    assert free[:3] == [100, 120, 140], "each search uses the newest map"


def odometry(stamp_ns: int) -> Odometry:
    msg = Odometry(child_frame_id="base_link")
    msg.header.frame_id, msg.header.stamp = "map", ns_to_stamp(stamp_ns)
    msg.pose.pose.position.x = msg.pose.pose.position.y = 3.0
    msg.pose.pose.orientation.w = 1.0
    return msg
