"""A client that applies updates has the grid that was published last, however slow."""

import itertools
import json
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.msgs import deserialize, serialize
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav_msgs.msg import MapMetaData, OccupancyGrid
from navette.msgs.std_msgs.msg import Header
from navette.viewer.hub import Hub
from navette.viewer.large_grid import LargeGrid
from navette.viewer.outbox import Outbox
from navette.viewer.session import Topic, Watch

sys.path.append(str(Path(__file__).parents[1] / "unit" / "viewer"))

from viewer_fakes import DirectCommands, RecordingProgram

MAP = Topic("/map", "nav_msgs/msg/OccupancyGrid", "", latched=True)
UPDATES = Topic("/map_updates", "map_msgs/msg/OccupancyGridUpdate", "")
EDGE = 4


class Publisher:
    """A map of random cells, which changes in places or grows."""

    def __init__(self, seed: int) -> None:
        self._random = np.random.default_rng(seed)
        self.stamp_s = 10
        self.cells = np.zeros((EDGE, EDGE), np.int8)

    def change(self) -> OccupancyGridUpdate:
        self.stamp_s += 1
        height, width = self.cells.shape
        y, x = int(self._random.integers(height)), int(self._random.integers(width))
        part = self._random.integers(-1, 101, (height - y, width - x), np.int8)
        self.cells[y:, x:] = part
        rows, columns = part.shape
        return OccupancyGridUpdate(
            header=self._header(),
            x=x,
            y=y,
            width=columns,
            height=rows,
            data=part.ravel(),
        )

    def replace(self, height: int) -> OccupancyGridUpdate:
        self.stamp_s += 1
        self.cells = self._random.integers(-1, 101, (height, EDGE), np.int8)
        return OccupancyGridUpdate(header=self._header())

    def grid(self) -> OccupancyGrid:
        info = MapMetaData(width=EDGE, height=len(self.cells), resolution=0.5)
        cells = self.cells.ravel().copy()
        return OccupancyGrid(header=self._header(), info=info, data=cells)

    def _header(self) -> Header:
        return Header(stamp=Time(sec=self.stamp_s), frame_id="map")


class Page:
    """A client that applies updates as the page does."""

    def __init__(self, depth: int) -> None:
        self.hub = Hub(
            RecordingProgram(), DirectCommands(), name="test", session_id="1"
        )
        self.hub.subscriptions.set_topics([MAP, UPDATES])
        self.session = self.hub.join(Outbox(depth=depth))
        self._ask(op="applyGridUpdates")
        channels = {each.topic: each for each in self.hub.subscriptions.channels}
        self.map = Watch(channels["/map"], self.session.id)
        self.updates = Watch(channels["/map_updates"], None)
        self._ids = itertools.count(1)
        self._open: dict[int, int] = {}
        for watch in (self.map, self.updates):
            self._subscribe(watch)
        self.stamp_s = 0
        self.cells: np.ndarray | None = None

    def subscribe_again(self, watch: Watch) -> None:
        channel_id = watch.channel.id
        self._ask(op="unsubscribe", subscriptionIds=[self._open[channel_id]])
        self._subscribe(watch)

    def go_back(self) -> None:
        """Time goes back: the page drops what it displays."""
        self.read()
        self.hub.set_now(20)
        self.hub.set_now(10)
        self.read()
        self.cells = None

    def read(self) -> None:
        """Receive all that is queued."""
        channels = {each: channel for channel, each in self._open.items()}
        while self.session.outbox:
            frame = self.session.outbox.pop()
            data = b"".join(frame) if isinstance(frame, list) else frame
            if not isinstance(data, bytes) or data[0] != 1:
                continue
            channel_id = channels[int.from_bytes(data[1:5], "little")]
            if channel_id == self.map.channel.id:
                grid = deserialize(data[13:], OccupancyGrid)
                self.stamp_s = grid.header.stamp.sec
                shape = grid.info.height, grid.info.width
                self.cells = np.array(grid.data, np.int8).reshape(shape)
            else:
                self._apply(deserialize(data[13:], OccupancyGridUpdate))

    def _apply(self, update: OccupancyGridUpdate) -> None:
        if self.cells is None or update.header.stamp.sec <= self.stamp_s:
            return
        rows = slice(update.y, update.y + update.height)
        columns = slice(update.x, update.x + update.width)
        part = np.array(update.data, np.int8).reshape(update.height, update.width)
        if self.cells[rows, columns].shape == part.shape:
            self.cells[rows, columns] = part

    def _subscribe(self, watch: Watch) -> None:
        subscription_id, channel_id = next(self._ids), watch.channel.id
        self._open[channel_id] = subscription_id
        pair = {"id": subscription_id, "channelId": channel_id}
        self._ask(op="subscribe", subscriptions=[pair])

    def _ask(self, **document: object) -> None:
        self.hub.receive(self.session, json.dumps(document))


STEPS = ("change", "lose update", "grow", "replace", "read", "back", "map", "updates")


@pytest.mark.parametrize("depth", [1, 2])
@given(steps=st.lists(st.sampled_from(STEPS), max_size=25), seed=st.integers(0, 99))
def test_a_client_has_the_last_grid(depth: int, steps: list[str], seed: int) -> None:
    publisher, page = Publisher(seed), Page(depth)

    def publish(update: OccupancyGridUpdate | None) -> None:
        if update is not None:
            page.hub.subscriptions.message(page.updates, 0, serialize(update))
        page.hub.subscriptions.message(page.map, 0, LargeGrid(publisher.grid()))

    for step in [*steps, "change", "read"]:
        if step == "read":
            page.read()
        elif step == "back":
            page.go_back()
        elif step == "map":  # the graph delivers the latched grid again
            page.subscribe_again(page.map)
            page.hub.subscriptions.message(page.map, 0, LargeGrid(publisher.grid()))
        elif step == "updates":
            page.subscribe_again(page.updates)
        elif step == "change":
            publish(publisher.change())
        elif step == "lose update":
            publisher.change()
            publish(None)
        else:
            publish(publisher.replace(len(publisher.cells) + (step == "grow")))
    assert page.cells is not None
    np.testing.assert_array_equal(page.cells, publisher.cells)
