"""Large grids: sent in parts, and to a client that applies updates only if needed."""

import json
from collections.abc import Callable

import numpy as np
import pytest
from viewer_fakes import DirectCommands, RecordingProgram, sent
from viewer_harness import Client, Program

from navette.msgs import deserialize, serialize
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.map_msgs.msg import OccupancyGridUpdate
from navette.msgs.nav_msgs.msg import MapMetaData, OccupancyGrid
from navette.msgs.std_msgs.msg import Header
from navette.runtime import Context, Node
from navette.runtime.qos import DurabilityPolicy, QoSProfile
from navette.viewer.hub import Hub
from navette.viewer.large_grid import LargeGrid, payload_of
from navette.viewer.outbox import MessageFrame, Outbox
from navette.viewer.playback import PlaybackState, PlaybackStatus
from navette.viewer.replies import message_head
from navette.viewer.session import Session, Topic, Watch

MAP = Topic("/map", "nav_msgs/msg/OccupancyGrid", "", latched=True)
UPDATES = Topic("/map_updates", "map_msgs/msg/OccupancyGridUpdate", "")
EDGE = 512
MAP_ID, UPDATES_ID = 1, 2


def grid(stamp_s: int, *, height: int = EDGE, seed: int = 0) -> OccupancyGrid:
    """A grid of that height and the width ``EDGE``, of random cells."""
    time = Time(sec=stamp_s)
    cells = np.random.default_rng(seed).integers(-1, 101, height * EDGE, np.int8)
    return OccupancyGrid(
        header=Header(stamp=time, frame_id="map"),
        info=MapMetaData(
            map_load_time=time, resolution=0.05, width=EDGE, height=height
        ),
        data=cells,
    )


def update(stamp_s: int) -> bytes:
    header = Header(stamp=Time(sec=stamp_s), frame_id="map")
    return serialize(OccupancyGridUpdate(header=header, width=1, height=1, data=[7]))


@pytest.mark.parametrize("frame_id", ["", "map", "odom2"])
def test_a_large_grid_is_sent_as_it_is_serialised(frame_id: str) -> None:
    message = grid(3, height=4 * EDGE)
    message.header.frame_id = frame_id
    payload = payload_of(message)
    assert isinstance(payload, LargeGrid)
    assert len(payload) == len(serialize(message))
    parts = MessageFrame(7, 9, payload).encode()
    assert isinstance(parts, list)
    assert b"".join(parts) == message_head(7, 9) + serialize(message)
    assert max(map(len, parts)) < len(payload) / 3


def test_a_small_grid_is_serialised_at_once() -> None:
    message = grid(3, height=EDGE - 1)
    assert payload_of(message) == serialize(message)


class Page:
    """A client of a hub that subscribes to a map and its updates."""

    def __init__(self, *, applies_updates: bool = True) -> None:
        program = RecordingProgram()
        self.hub = Hub(program, DirectCommands(), name="test", session_id="1")
        self.hub.subscriptions.set_topics([MAP, UPDATES])
        self.session: Session = self.hub.join(Outbox(depth=2, data_bytes=300_000))
        if applies_updates:
            self.ask(op="applyGridUpdates")
        channels = {each.topic: each for each in self.hub.subscriptions.channels}
        self.map = Watch(channels["/map"], self.session.id)
        self.updates = Watch(channels["/map_updates"], None)
        self.subscribe(MAP_ID, self.map.channel.id)
        self.subscribe(UPDATES_ID, self.updates.channel.id)
        sent(self.session.outbox)

    def ask(self, **document: object) -> None:
        self.hub.receive(self.session, json.dumps(document))

    def subscribe(self, subscription_id: int, channel_id: int) -> None:
        pair = {"id": subscription_id, "channelId": channel_id}
        self.ask(op="subscribe", subscriptions=[pair])

    def unsubscribe(self, subscription_id: int) -> None:
        self.ask(op="unsubscribe", subscriptionIds=[subscription_id])

    def publish(self, stamp_s: int, *, height: int = EDGE) -> None:
        """Publish an update and the whole grid, as the map memory does."""
        self.hub.subscriptions.message(self.updates, stamp_s, update(stamp_s))
        self.hub.subscriptions.message(
            self.map, stamp_s, payload_of(grid(stamp_s, height=height))
        )

    def has_grid(self) -> bool:
        """Take all frames; return whether a whole grid is among them."""
        frames = []
        while self.session.outbox:
            frames.append(self.session.outbox.pop())
        return any(isinstance(each, list) for each in frames)


@pytest.fixture
def page() -> Page:
    """A page that has the grid of 2 s, and would not get that of 3 s."""
    made = Page()
    made.publish(1)
    made.publish(2)
    assert made.has_grid()
    return made


def test_a_grid_that_an_update_made_is_not_sent_again(page: Page) -> None:
    for stamp_s in (3, 4, 5):
        page.publish(stamp_s)
        assert not page.has_grid()


def test_other_clients_get_every_grid() -> None:
    other = Page(applies_updates=False)
    for stamp_s in (1, 2, 3, 4):
        other.publish(stamp_s)
        assert other.has_grid()


def test_a_grid_without_its_update_is_sent(page: Page) -> None:
    page.hub.subscriptions.message(page.map, 3, payload_of(grid(3)))
    assert page.has_grid()
    page.publish(4)
    assert not page.has_grid()


def test_a_grid_of_another_extent_is_sent(page: Page) -> None:
    page.publish(3, height=EDGE + 1)
    assert page.has_grid()
    page.publish(4, height=EDGE + 1)
    assert not page.has_grid()


def test_a_grid_that_replaces_the_one_before_is_sent(page: Page) -> None:
    """An update without cells announces it."""
    header = Header(stamp=Time(sec=3), frame_id="map")
    empty = serialize(OccupancyGridUpdate(header=header))
    page.hub.subscriptions.message(page.updates, 3, empty)
    page.hub.subscriptions.message(page.map, 3, payload_of(grid(3)))
    assert page.has_grid()
    page.publish(4)
    assert not page.has_grid()


def test_a_grid_from_before_the_newest_update_is_followed_by_a_whole_one() -> None:
    """A latched grid is from before the newest update: others may lie between."""
    page = Page()
    page.hub.subscriptions.message(page.updates, 3, update(3))
    page.hub.subscriptions.message(page.map, 1, payload_of(grid(1)))
    assert page.has_grid()
    page.publish(4)
    assert page.has_grid()
    page.publish(5)
    assert not page.has_grid()


def test_an_update_that_cannot_be_decoded_is_none(page: Page) -> None:
    page.hub.subscriptions.message(page.updates, 3, update(3)[:-1])
    page.hub.subscriptions.message(page.map, 3, payload_of(grid(3)))
    assert page.has_grid()


def test_after_a_lost_update_the_next_grid_is_sent(page: Page) -> None:
    for stamp_s in (3, 4, 5):  # more than the outbox keeps of a slow client
        page.hub.subscriptions.message(page.updates, stamp_s, update(stamp_s))
    page.hub.subscriptions.message(page.map, 5, payload_of(grid(5)))
    assert page.has_grid()
    page.publish(6)
    assert not page.has_grid()


def test_after_a_lost_grid_the_next_one_is_sent(page: Page) -> None:
    page.hub.subscriptions.message(page.map, 3, payload_of(grid(3)))
    page.session.outbox.put_data("camera", b"i" * 100_000)  # too much with the grid
    assert page.session.outbox.lost(MAP_ID) == 1
    assert not page.has_grid()
    page.publish(4)
    assert page.has_grid()
    page.publish(5)
    assert not page.has_grid()


def _map_again(page: Page) -> None:
    page.unsubscribe(MAP_ID)
    page.subscribe(3, page.map.channel.id)


def _updates_again(page: Page) -> None:
    page.unsubscribe(UPDATES_ID)
    page.subscribe(3, page.updates.channel.id)


def _back(page: Page) -> None:
    page.hub.set_now(9)
    page.hub.set_now(8)


def _seek(page: Page) -> None:
    state = PlaybackState(PlaybackStatus.PAUSED, 8, 1.0)
    page.hub.set_playback(state, did_seek=True, request_id="1")


@pytest.mark.parametrize("change", [_map_again, _updates_again, _back, _seek])
def test_a_client_that_has_no_grid_any_more_gets_one(
    page: Page, change: Callable[[Page], None]
) -> None:
    change(page)
    page.has_grid()
    page.publish(3)
    assert page.has_grid()
    page.publish(4)
    assert not page.has_grid()


class Mapper(Node):
    """Publishes a large map and its updates, on request."""

    def __init__(self, context: Context) -> None:
        super().__init__("mapper", context=context)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.map = self.create_publisher(OccupancyGrid, "/map", latched)
        self.updates = self.create_publisher(OccupancyGridUpdate, "/map_updates", 10)

    def publish_all(self, stamp_s: int, height: int) -> None:
        self.updates.publish(deserialize(update(stamp_s), OccupancyGridUpdate))
        self.map.publish(grid(stamp_s, height=height, seed=stamp_s))


@pytest.mark.parametrize("transport", [None, "zenoh"])
def test_a_real_client_gets_grids_and_updates(transport: str | None) -> None:
    with Program(Mapper, transport=transport) as program:
        mapper = program.nodes[0]
        assert isinstance(mapper, Mapper)
        with Client(program.address) as client:
            client.send(op="applyGridUpdates")
            client.subscribe("/map", MAP_ID)
            client.subscribe("/map_updates", UPDATES_ID)
            client.get_parameters()  # the subscriptions exist
            for stamp_s in (1, 2, 3, 4):
                height = EDGE + (stamp_s > 3)
                program.do(lambda s=stamp_s, h=height: mapper.publish_all(s, h))
            wholes = []
            while not wholes or wholes[-1].header.stamp.sec < 4:
                _, payload = client.message(MAP_ID)
                wholes.append(deserialize(payload, OccupancyGrid))
        assert [each.header.stamp.sec for each in wholes] == [1, 4]
        assert wholes[-1].data == grid(4, height=EDGE + 1, seed=4).data
