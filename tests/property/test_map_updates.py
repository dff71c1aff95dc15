"""A reader of map updates has the cells of the whole map, or is behind and reports it.

A map memory publishes; the test delivers its whole maps and updates in the order of
each topic, late, or not at all.
"""

from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.geometry import Pose2
from navette.geometry.messages import header, stamp_of
from navette.msgs import topics
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.navigation.grids import (
    GridSpec,
    MapReader,
    SquareRegion,
    grid_from_message,
    grid_to_message,
)
from navette.navigation.grids.spec import Cells
from navette.navigation.mapping.node import MapMemoryNode
from navette.runtime import Parameter
from navette.runtime.testing import GraphHarness

EDGE_M = 0.5
SEEN = GridSpec(EDGE_M, 3, 3, Pose2(-0.75, -0.75, 0.0))
FRAME = "map"
S = 1_000_000_000


class Version(NamedTuple):
    """A map that was published, whole or not."""

    cells: Cells
    spec: GridSpec


class Mapper:
    """A map memory; stores each map, and the messages that it published.

    Attributes:
        versions: by stamp.
        maps, updates: not delivered yet; updates with their numbers.
        latched: the newest map and updates, for late joiners.
    """

    def __init__(self, graph: GraphHarness, *, sends_whole: bool, seed: int) -> None:
        values = {
            "size_m": 20.0,
            "growth_m": 2.0,
            "max_size_m": 60.0,
            "resolution_m": EDGE_M,
            "update_distance_m": 0.0,
            "always_send_full_map": sends_whole,
        }
        self.graph, self._random = graph, np.random.default_rng(seed)
        self.versions: dict[int, Version] = {}
        self.maps, self.updates = deque[Any](), deque[tuple[Any, int]]()
        self.latched_maps = deque[Any](maxlen=1)
        self.latched_updates = deque[tuple[Any, int]](maxlen=topics.MAP_UPDATES.depth)
        self.stamp_ns, self._sent = 10 * S, 0
        self.node = MapMemoryNode(
            context=graph.context,
            parameter_overrides=[Parameter(k, value=v) for k, v in values.items()],
        )
        graph.add(self.node)
        publish = self.node.hand_over

        def hand_over(topic: str, msg: Any) -> None:
            publish(topic, msg)
            if topic == topics.MAP.name:
                self._keep(self.maps, self.latched_maps, msg)
            elif topic == topics.MAP_UPDATES.name:
                self._note_version(msg)

        self.node.hand_over = hand_over  # type: ignore[method-assign]
        self.clear_all()

    def _note_version(self, update: OccupancyGridUpdate) -> None:
        self._sent += 1
        self._keep(self.updates, self.latched_updates, (update, self._sent))
        cells, spec = grid_from_message(self.node.newest_grid())
        self.versions[stamp_of(update.header)] = Version(cells.copy(), spec)

    def _keep(self, queue: deque[Any], latched: deque[Any], item: Any) -> None:
        queue.append(item)
        latched.append(item)

    def see(self, away_m: float = 8.0) -> None:
        """Fuse a costmap of random cells around a random place."""
        self.stamp_ns += int(self._random.integers(1, S))
        self.graph.run_for(max(0.0, (self.stamp_ns - self.graph.now_ns) / 1e9))
        x, y = self._random.uniform(-away_m, away_m, 2)
        odometry = Odometry(child_frame_id="base_link")
        odometry.header = header(self.stamp_ns, FRAME)
        position = odometry.pose.pose.position
        position.x, position.y = float(x), float(y)
        odometry.pose.pose.orientation.w = 1.0
        self.graph.publish("/odom/filtered", odometry)
        cells = self._random.choice(np.array([-1, 0, 100], np.int8), SEEN.shape)
        cells[1, 1] = 0
        costmap = grid_to_message(cells, SEEN, "base_link", self.stamp_ns)
        self.graph.publish("/costmap", costmap)
        self.graph.run_for(0.01)

    def grow(self) -> None:
        self.see(away_m=20.0)

    def go_back(self) -> None:
        """Begin a new run, with earlier stamps."""
        self.stamp_ns -= 3 * S
        self.see()

    def clear(self) -> None:
        x, y = self._random.uniform(-3.0, 3.0, 2).tolist()
        self.node.clear_costmap(SquareRegion(x, y, 2.0, False))

    def clear_all(self) -> None:
        self.node.clear_costmap(None)

    def reset(self) -> None:
        self.graph.run_for(0.001)
        self.node.on_time_jump()

    def load(self) -> None:
        shape = tuple(self._random.integers(4, 20, 2).tolist())
        cells = self._random.choice(np.array([-1, 0, 100], np.int8), shape)
        spec = GridSpec(EDGE_M, shape[1], shape[0], Pose2(-2.0, -2.0, 0.0))
        self.node.load_map(cells, spec)


class Reader:
    """A reader, and the deliveries to it; a lazy one applies updates at the end."""

    def __init__(self, mapper: Mapper, *, is_lazy: bool = False) -> None:
        self.mapper, self.maps, self.is_lazy = mapper, MapReader(), is_lazy
        mapper.maps.clear()
        mapper.updates.clear()
        mapper.maps.extend(mapper.latched_maps)
        mapper.updates.extend(mapper.latched_updates)

    def take_map(self) -> None:
        if self.mapper.maps:
            self.receive_map(self.mapper.maps.popleft())

    def receive_map(self, msg: OccupancyGrid) -> None:
        self.maps.receive_map(msg, FRAME)
        self.check()
        self.apply()

    def take_update(self) -> None:
        if self.mapper.updates:
            msg, number = self.mapper.updates.popleft()
            self.maps.receive_update(msg, number, FRAME)
            if not self.is_lazy:
                self.apply()
            self.check()

    def apply(self) -> None:
        """Apply the updates that follow the map."""
        while (part := self.maps.next_part()) is not None:
            assert self.maps.map is not None
            assert self.maps.map.update(part) == part.window
            self.check()

    def take_all(self) -> None:
        while self.mapper.updates:
            self.take_update()
        while self.mapper.maps:
            self.take_map()
        self.apply()

    def request(self) -> None:
        """Do as the nodes do that are behind for a while."""
        if self.maps.is_behind:
            self.receive_map(self.mapper.node.newest_grid())

    def check(self) -> None:
        """Compare the map with that of its stamp."""
        known = self.maps.map
        if known is not None:
            version = self.mapper.versions[self.maps.stamp_ns]
            assert known.spec == version.spec
            np.testing.assert_array_equal(known.cells, version.cells)

    @property
    def has_newest(self) -> bool:
        newest = next(reversed(self.mapper.versions))
        return not self.maps.is_behind and self.maps.stamp_ns == newest


PUBLISHES = {
    "see": Mapper.see,
    "grow": Mapper.grow,
    "go back": Mapper.go_back,
    "clear": Mapper.clear,
    "clear all": Mapper.clear_all,
    "reset": Mapper.reset,
    "load": Mapper.load,
}
TAKES: dict[str, Callable[[Reader], None]] = {
    "map": Reader.take_map,
    "update": Reader.take_update,
    "all": Reader.take_all,
}
LOSES = ("lose map", "lose update")
OFTEN = ("see", "see", "update", "all")


@pytest.mark.parametrize("sends_whole", [False, True])
@settings(max_examples=100)
@given(
    steps=st.lists(
        st.sampled_from([*OFTEN, *PUBLISHES, *TAKES, *LOSES, "join"]), max_size=40
    ),
    seed=st.integers(0, 999),
)
def test_a_reader_never_has_a_wrong_map(
    steps: list[str], seed: int, sends_whole: bool
) -> None:
    with GraphHarness() as graph:
        mapper = Mapper(graph, sends_whole=sends_whole, seed=seed)
        reader = Reader(mapper)
        for step in steps:
            if step in PUBLISHES:
                PUBLISHES[step](mapper)
            elif step in TAKES:
                TAKES[step](reader)
            elif step == "join":
                reader = Reader(mapper, is_lazy=not reader.is_lazy)
            else:
                mapper.see()
                queue: Any = mapper.maps if step == "lose map" else mapper.updates
                if queue:
                    queue.pop()
        mapper.clear()  # after an update that was lost there is another one
        reader.take_all()
        reader.request()
        reader.take_all()
        assert reader.has_newest


@settings(max_examples=30)
@given(
    steps=st.lists(st.sampled_from([*PUBLISHES, "all"]), max_size=20),
    seed=st.integers(0, 999),
)
def test_a_reader_that_loses_nothing_requests_nothing(
    steps: list[str], seed: int
) -> None:
    with GraphHarness() as graph:
        mapper = Mapper(graph, sends_whole=False, seed=seed)
        reader = Reader(mapper)
        for step in [*steps, "all"]:
            PUBLISHES[step](mapper) if step in PUBLISHES else reader.take_all()
        assert reader.has_newest
