"""Sessions, channels, subscriptions and requests."""

import json
from pathlib import Path
from typing import Any

import pytest
from viewer_fakes import DirectCommands, RecordingProgram, sent

from navette.viewer.assets import AssetFolders
from navette.viewer.frames import ClientChannel, WireParameter
from navette.viewer.hub import Hub
from navette.viewer.outbox import Outbox
from navette.viewer.replies import Channel, ConnectionGraph, message_head
from navette.viewer.session import Session, Topic, Watch

SCAN = Topic("/lidar", "sensor_msgs/msg/LaserScan", "float32[] ranges")
GOAL = Topic("/goal_point", "geometry_msgs/msg/PointStamped", "Header header")
MAP = Topic("/map", "nav_msgs/msg/OccupancyGrid", "int8[] data", latched=True)

LARGE = "package://navette/large"


class Bench:
    """A hub with a recording program and clients that send JSON."""

    def __init__(self, folder: Path) -> None:
        self.program = RecordingProgram()
        self.hub = Hub(
            self.program,
            DirectCommands(),
            name="test",
            session_id="1",
            assets=AssetFolders({"navette": folder}),
        )

    def join(self) -> Session:
        session = self.hub.join(Outbox())
        sent(session.outbox)
        return session

    def ask(self, session: Session, **document: Any) -> list[Any]:
        """Send one JSON frame; gives what is sent back."""
        self.hub.receive(session, json.dumps(document))
        return sent(session.outbox)

    def subscribe(self, session: Session, subscription: int, channel: int) -> list[Any]:
        pair = {"id": subscription, "channelId": channel}
        return self.ask(session, op="subscribe", subscriptions=[pair])

    def stream(self, channel: Channel) -> None:
        """Publish as often as a stream for two periods."""
        for _ in range(2):
            for stamp_ns in range(1, 6):
                self.hub.message(Watch(channel, None), stamp_ns, b"old")
            self.hub.end_period()

    def channel(self, topic: str) -> Channel:
        return next(c for c in self.hub.channels if c.topic == topic)


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path)


def test_new_clients_receive_info_channels_and_time(bench: Bench) -> None:
    bench.hub.set_topics([SCAN])
    bench.hub.set_now(5)
    session = bench.hub.join(Outbox())
    info, channels, time = sent(session.outbox)
    assert info["op"] == "serverInfo"
    assert [c["topic"] for c in channels["channels"]] == ["/lidar"]
    assert time[0] == 2


def test_topics_are_added_and_removed(bench: Bench) -> None:
    session = bench.join()
    bench.hub.set_topics([SCAN])
    bench.hub.set_topics([SCAN, MAP])
    bench.hub.set_topics([MAP])
    first, second, third = sent(session.outbox)
    assert [c["id"] for c in first["channels"]] == [1]
    assert [c["id"] for c in second["channels"]] == [2]
    assert third == {"op": "unadvertise", "channelIds": [1]}


def test_a_topic_without_clients_is_not_subscribed(bench: Bench) -> None:
    bench.hub.set_topics([SCAN])
    one, two = bench.join(), bench.join()
    channel = bench.channel("/lidar")
    assert bench.program.take() == []
    bench.subscribe(one, 10, channel.id)
    bench.subscribe(two, 20, channel.id)
    assert bench.program.take() == [("watch", "/lidar", None)]
    bench.ask(one, op="unsubscribe", subscriptionIds=[10])
    assert bench.program.take() == []
    bench.hub.leave(two)
    assert bench.program.take() == [("unwatch", "/lidar", None)]


def test_messages_go_to_their_watchers_under_their_own_ids(bench: Bench) -> None:
    bench.hub.set_topics([SCAN])
    one, two, other = bench.join(), bench.join(), bench.join()
    channel = bench.channel("/lidar")
    bench.subscribe(one, 10, channel.id)
    bench.subscribe(two, 20, channel.id)
    bench.hub.message(Watch(channel, None), 123, b"scan")
    assert sent(one.outbox) == [message_head(10, 123) + b"scan"]
    assert sent(two.outbox) == [message_head(20, 123) + b"scan"]
    assert sent(other.outbox) == []


def test_latched_topics_are_watched_once_per_client(bench: Bench) -> None:
    """New clients receive earlier messages only through a new subscription."""
    bench.hub.set_topics([MAP])
    one, two = bench.join(), bench.join()
    channel = bench.channel("/map")
    bench.subscribe(one, 1, channel.id)
    bench.subscribe(two, 1, channel.id)
    assert bench.program.take() == [
        ("watch", "/map", one.id),
        ("watch", "/map", two.id),
    ]
    bench.hub.message(Watch(channel, two.id), 1, b"map")
    assert sent(one.outbox) == []
    assert len(sent(two.outbox)) == 1


def test_a_removed_topic_ends_its_subscriptions(bench: Bench) -> None:
    bench.hub.set_topics([SCAN])
    session = bench.join()
    channel = bench.channel("/lidar")
    bench.subscribe(session, 10, channel.id)
    bench.hub.message(Watch(channel, None), 1, b"late")
    bench.hub.set_topics([])
    assert bench.program.take()[-1] == ("unwatch", "/lidar", None)
    assert sent(session.outbox) == [{"op": "unadvertise", "channelIds": [1]}]
    bench.hub.message(Watch(channel, None), 2, b"too late")
    assert not session.outbox


@pytest.mark.parametrize(
    ("document", "complaint"),
    [
        (
            {"op": "subscribe", "subscriptions": [{"id": 1, "channelId": 99}]},
            "unknown channel id 99",
        ),
        (
            {"op": "subscribe", "subscriptions": [{"id": 10, "channelId": 1}]},
            "id 10 is in use",
        ),
        (
            {"op": "subscribe", "subscriptions": [{"id": 11, "channelId": 1}]},
            "is subscribed",
        ),
        ({"op": "unsubscribe", "subscriptionIds": [7]}, "unknown subscription id 7"),
        ({"op": "unadvertise", "channelIds": [7]}, "unknown channel id 7"),
        ({"op": "nonsense"}, "unknown op"),
    ],
)
def test_bad_requests_get_a_status(
    bench: Bench, document: dict[str, Any], complaint: str
) -> None:
    bench.hub.set_topics([SCAN])
    session, other = bench.join(), bench.join()
    bench.subscribe(session, 10, 1)
    (status,) = bench.ask(session, **document)
    assert status["op"] == "status"
    assert status["level"] >= 1
    assert complaint in status["message"]
    assert not other.outbox


def advertise(bench: Bench, session: Session, **fields: Any) -> list[Any]:
    channel = {
        "id": 1,
        "topic": "/goal_point",
        "encoding": "json",
        "schemaName": "geometry_msgs/msg/PointStamped",
        **fields,
    }
    return bench.ask(session, op="advertise", channels=[channel])


def test_clients_publish_on_channels_that_they_advertised(bench: Bench) -> None:
    session = bench.join()
    assert advertise(bench, session) == []
    bench.hub.receive(session, b"\x01\x01\x00\x00\x00{}")
    bench.ask(session, op="unadvertise", channelIds=[1])
    channel = ClientChannel(1, "/goal_point", "json", "geometry_msgs/msg/PointStamped")
    assert bench.program.take() == [
        ("open", session.id, channel),
        ("publish", session.id, 1, b"{}"),
        ("close", session.id, 1),
    ]
    bench.hub.receive(session, b"\x01\x01\x00\x00\x00{}")
    (status,) = sent(session.outbox)
    assert "channel 1 is not advertised" in status["message"]
    assert bench.program.take() == []


def test_invalid_channels_are_refused(bench: Bench) -> None:
    session = bench.join()
    (status,) = advertise(bench, session, encoding="protobuf")
    assert "known: cdr, json" in status["message"]
    advertise(bench, session)
    (status,) = advertise(bench, session)
    assert "channel id 1 is in use" in status["message"]
    for number in range(2, 400):
        replies = advertise(bench, session, id=number)
    assert "64 channels at most" in replies[0]["message"]


def test_publishers_of_a_client_end_with_it(bench: Bench) -> None:
    session = bench.join()
    advertise(bench, session)
    bench.program.take()
    bench.hub.leave(session)
    assert bench.program.take() == [("close", session.id, 1)]
    bench.hub.done(session.id)
    assert bench.hub.clients == 0


def test_pending_requests_are_counted(bench: Bench) -> None:
    session = bench.join()
    advertise(bench, session)
    bench.ask(session, op="getParameters", parameterNames=[], id="x")
    assert session.pending == 2
    bench.hub.done(session.id)
    assert session.pending == 1


def test_parameter_answers_and_updates(bench: Bench) -> None:
    one, two = bench.join(), bench.join()
    bench.ask(one, op="subscribeParameterUpdates", parameterNames=["/n.a"])
    bench.ask(two, op="subscribeParameterUpdates", parameterNames=[])
    a, b = WireParameter("/n.a", 1), WireParameter("/n.b", True)
    bench.hub.parameters(one.id, [b], "req")
    (answer,) = sent(one.outbox)
    assert answer["id"] == "req"
    bench.hub.parameters_changed([a, b])
    (update,) = sent(one.outbox)
    assert update["parameters"] == [{"name": "/n.a", "value": 1}]
    assert len(sent(two.outbox)[0]["parameters"]) == 2
    bench.ask(one, op="unsubscribeParameterUpdates", parameterNames=["/n.a"])
    bench.ask(two, op="unsubscribeParameterUpdates", parameterNames=[])
    bench.hub.parameters_changed([a, b])
    assert not one.outbox
    assert not two.outbox


def test_the_graph_is_sent_whole_and_then_in_changes(bench: Bench) -> None:
    bench.hub.set_graph(ConnectionGraph({"/a": ("/n",)}, {}))
    session, other = bench.join(), bench.join()
    (whole,) = bench.ask(session, op="subscribeConnectionGraph")
    assert whole["publishedTopics"] == [{"name": "/a", "publisherIds": ["/n"]}]
    bench.hub.set_graph(ConnectionGraph({"/a": ("/n",)}, {"/a": ("/m",)}))
    (change,) = sent(session.outbox)
    assert change["publishedTopics"] == []
    assert change["subscribedTopics"] == [{"name": "/a", "subscriberIds": ["/m"]}]
    bench.ask(session, op="unsubscribeConnectionGraph")
    bench.hub.set_graph(ConnectionGraph({}, {}))
    assert not session.outbox
    assert not other.outbox


def test_only_the_newest_time_is_queued(bench: Bench) -> None:
    session = bench.join()
    for now in (1, 2, 2, 3):
        bench.hub.set_now(now)
    assert sent(session.outbox) == [b"\x02" + (3).to_bytes(8, "little")]


def test_assets_are_sent_or_refused(bench: Bench, tmp_path: Path) -> None:
    (tmp_path / "robot.urdf").write_text("<robot/>")
    session = bench.join()
    (found,) = bench.ask(
        session, op="fetchAsset", uri="package://navette/robot.urdf", requestId=4
    )
    assert found == b"\x04\x04\x00\x00\x00\x00\x00\x00\x00\x00<robot/>"
    (missing,) = bench.ask(session, op="fetchAsset", uri="file:///x", requestId=5)
    assert missing[5] == 1
    assert b"unknown asset 'file:///x'" in missing


def test_problems_of_long_requests_are_summed_up(bench: Bench) -> None:
    session = bench.join()
    pairs = [{"id": i, "channelId": 1000 + i} for i in range(1000)]
    statuses = bench.ask(session, op="subscribe", subscriptions=pairs)
    assert len(statuses) == 4
    assert "unknown channel id 1000" in statuses[0]["message"]
    assert statuses[-1]["message"] == "subscribe: 997 more entries are refused"


def test_all_clients_together_open_a_bounded_number_of_channels(bench: Bench) -> None:
    for _ in range(5):
        session = bench.join()
        for number in range(64):
            replies = advertise(bench, session, id=number)
    assert "all clients together can open 256 channels" in replies[0]["message"]


def test_a_client_subscribes_to_a_bounded_number_of_parameters(bench: Bench) -> None:
    session = bench.join()
    for start in range(0, 3000, 500):
        names = [f"/a.{n}" for n in range(start, start + 500)]
        replies = bench.ask(
            session, op="subscribeParameterUpdates", parameterNames=names
        )
    assert "1000 parameters at most" in replies[0]["message"]
    assert len(session.parameter_names) == 1000


def test_files_are_sent_only_while_clients_receive_them(tmp_path: Path) -> None:
    (tmp_path / "large").write_bytes(bytes(30_000_000))
    bench = Bench(tmp_path)
    failed = 0
    for _ in range(12):
        session = bench.hub.join(Outbox())
        bench.hub.receive(
            session, json.dumps({"op": "fetchAsset", "uri": LARGE, "requestId": 1})
        )
        frames = list[str | bytes]()
        if session.outbox.size < 1_000_000:
            while session.outbox:
                frames.append(session.outbox.pop())
            failed += b"request it again" in frames[-1]  # type: ignore[operator]
    assert failed == 3


def test_queued_bytes_are_counted_until_they_are_sent() -> None:
    outbox = Outbox(data_bytes=100)
    outbox.put_control("12345")
    for stream in range(5):
        outbox.put_data(stream, b"a" * 30)
    assert outbox.size == 5 + 90
    outbox.pop()
    outbox.forget(4)
    assert outbox.size == 5 + 60
    outbox.sent()
    outbox.pop()
    outbox.pop()
    outbox.sent()
    assert outbox.size == 0


def test_a_client_that_does_not_read_has_no_streams_until_it_reads(
    bench: Bench,
) -> None:
    bench.hub.set_topics([SCAN, MAP])
    scan, grid = bench.channel("/lidar"), bench.channel("/map")
    slow, other = bench.join(), bench.join()
    bench.subscribe(slow, 1, scan.id)
    bench.subscribe(slow, 2, grid.id)
    bench.program.take()
    bench.stream(scan)
    sent(slow.outbox)
    bench.hub.suspend(slow)
    assert bench.program.take() == [("unwatch", "/lidar", None)]

    bench.subscribe(other, 1, scan.id)
    assert bench.program.take() == [("watch", "/lidar", None)]
    bench.hub.message(Watch(scan, None), 5, b"scan")
    bench.hub.message(Watch(grid, slow.id), 6, b"map")
    assert sent(slow.outbox) == [message_head(2, 6) + b"map"]
    assert sent(other.outbox) == [message_head(1, 5) + b"scan"]

    bench.hub.resume(slow)
    bench.hub.message(Watch(scan, None), 7, b"new")
    assert sent(slow.outbox) == [message_head(1, 7) + b"new"]
    bench.ask(other, op="unsubscribe", subscriptionIds=[1])
    bench.ask(slow, op="unsubscribe", subscriptionIds=[1])
    assert bench.program.take() == [("unwatch", "/lidar", None)]


def test_a_client_that_hangs_receives_what_is_sent_once(bench: Bench) -> None:
    """A goal, for example: no later message replaces it."""
    bench.hub.set_topics([SCAN, GOAL])
    scan, goal = bench.channel("/lidar"), bench.channel("/goal_point")
    slow = bench.join()
    bench.subscribe(slow, 1, scan.id)
    bench.subscribe(slow, 2, goal.id)
    bench.stream(scan)
    sent(slow.outbox)
    bench.hub.suspend(slow)
    bench.hub.message(Watch(goal, None), 5, b"goal")
    bench.hub.resume(slow)
    assert sent(slow.outbox) == [message_head(2, 5) + b"goal"]


def test_a_topic_that_becomes_a_stream_is_suspended_later(bench: Bench) -> None:
    bench.hub.set_topics([SCAN])
    scan = bench.channel("/lidar")
    slow = bench.join()
    bench.subscribe(slow, 1, scan.id)
    bench.program.take()
    bench.hub.suspend(slow)
    assert bench.program.take() == []
    bench.stream(scan)
    bench.hub.suspend(slow)
    assert bench.program.take() == [("unwatch", "/lidar", None)]


def test_few_messages_with_many_bytes_are_a_stream(bench: Bench) -> None:
    """A camera at 1 Hz: no image is rendered for a client that does not read."""
    bench.hub.set_topics([SCAN])
    scan = bench.channel("/lidar")
    slow = bench.join()
    bench.subscribe(slow, 1, scan.id)
    bench.program.take()
    bench.hub.message(Watch(scan, None), 5, bytes(600_000))
    bench.hub.end_period()
    bench.hub.suspend(slow)
    assert bench.program.take() == [("unwatch", "/lidar", None)]
    bench.hub.resume(slow)
    bench.program.take()
    for _ in range(2):
        bench.hub.end_period()
    bench.hub.suspend(slow)
    assert bench.program.take() == [], "no message in the last two periods"


def test_a_suspended_client_changes_its_subscriptions(bench: Bench) -> None:
    bench.hub.set_topics([SCAN])
    scan = bench.channel("/lidar")
    slow = bench.join()
    bench.hub.suspend(slow)
    assert bench.subscribe(slow, 1, scan.id) == []
    bench.stream(scan)
    sent(slow.outbox)
    bench.hub.suspend(slow)
    assert bench.program.take() == [
        ("watch", "/lidar", None),
        ("unwatch", "/lidar", None),
    ]
    assert bench.ask(slow, op="unsubscribe", subscriptionIds=[1]) == []
    bench.hub.resume(slow)
    bench.hub.leave(slow)
    assert bench.program.take() == []
