"""Channels of topics, subscriptions to them, and clients that do not read."""

from viewer_fakes import Bench, sent

from navette.viewer.replies import message_head
from navette.viewer.session import Topic, Watch

SCAN = Topic("/lidar", "sensor_msgs/msg/LaserScan", "float32[] ranges")
GOAL = Topic("/goal_point", "geometry_msgs/msg/PointStamped", "Header header")
MAP = Topic("/map", "nav_msgs/msg/OccupancyGrid", "int8[] data", latched=True)


def test_topics_are_added_and_removed(bench: Bench) -> None:
    session = bench.join()
    bench.hub.subscriptions.set_topics([SCAN])
    bench.hub.subscriptions.set_topics([SCAN, MAP])
    bench.hub.subscriptions.set_topics([MAP])
    first, second, third = sent(session.outbox)
    assert [c["id"] for c in first["channels"]] == [1]
    assert [c["id"] for c in second["channels"]] == [2]
    assert third == {"op": "unadvertise", "channelIds": [1]}


def test_a_topic_without_clients_is_not_subscribed(bench: Bench) -> None:
    bench.hub.subscriptions.set_topics([SCAN])
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
    bench.hub.subscriptions.set_topics([SCAN])
    one, two, other = bench.join(), bench.join(), bench.join()
    channel = bench.channel("/lidar")
    bench.subscribe(one, 10, channel.id)
    bench.subscribe(two, 20, channel.id)
    bench.hub.subscriptions.message(Watch(channel, None), 123, b"scan")
    assert sent(one.outbox) == [message_head(10, 123) + b"scan"]
    assert sent(two.outbox) == [message_head(20, 123) + b"scan"]
    assert sent(other.outbox) == []


def test_latched_topics_are_watched_once_per_client(bench: Bench) -> None:
    """New clients receive earlier messages only through a new subscription."""
    bench.hub.subscriptions.set_topics([MAP])
    one, two = bench.join(), bench.join()
    channel = bench.channel("/map")
    bench.subscribe(one, 1, channel.id)
    bench.subscribe(two, 1, channel.id)
    assert bench.program.take() == [
        ("watch", "/map", one.id),
        ("watch", "/map", two.id),
    ]
    bench.hub.subscriptions.message(Watch(channel, two.id), 1, b"map")
    assert sent(one.outbox) == []
    assert len(sent(two.outbox)) == 1


def test_a_removed_topic_ends_its_subscriptions(bench: Bench) -> None:
    bench.hub.subscriptions.set_topics([SCAN])
    session = bench.join()
    channel = bench.channel("/lidar")
    bench.subscribe(session, 10, channel.id)
    bench.hub.subscriptions.message(Watch(channel, None), 1, b"late")
    bench.hub.subscriptions.set_topics([])
    assert bench.program.take()[-1] == ("unwatch", "/lidar", None)
    assert sent(session.outbox) == [{"op": "unadvertise", "channelIds": [1]}]
    bench.hub.subscriptions.message(Watch(channel, None), 2, b"too late")
    assert not session.outbox


def test_a_client_that_does_not_read_has_no_streams_until_it_reads(
    bench: Bench,
) -> None:
    bench.hub.subscriptions.set_topics([SCAN, MAP])
    scan, grid = bench.channel("/lidar"), bench.channel("/map")
    slow, other = bench.join(), bench.join()
    bench.subscribe(slow, 1, scan.id)
    bench.subscribe(slow, 2, grid.id)
    bench.program.take()
    bench.stream(scan)
    sent(slow.outbox)
    bench.hub.subscriptions.suspend(slow)
    assert bench.program.take() == [("unwatch", "/lidar", None)]

    bench.subscribe(other, 1, scan.id)
    assert bench.program.take() == [("watch", "/lidar", None)]
    bench.hub.subscriptions.message(Watch(scan, None), 5, b"scan")
    bench.hub.subscriptions.message(Watch(grid, slow.id), 6, b"map")
    assert sent(slow.outbox) == [message_head(2, 6) + b"map"]
    assert sent(other.outbox) == [message_head(1, 5) + b"scan"]

    bench.hub.subscriptions.resume(slow)
    bench.hub.subscriptions.message(Watch(scan, None), 7, b"new")
    assert sent(slow.outbox) == [message_head(1, 7) + b"new"]
    bench.ask(other, op="unsubscribe", subscriptionIds=[1])
    bench.ask(slow, op="unsubscribe", subscriptionIds=[1])
    assert bench.program.take() == [("unwatch", "/lidar", None)]


def test_a_client_that_hangs_receives_what_is_sent_once(bench: Bench) -> None:
    """A goal, for example: no later message replaces it."""
    bench.hub.subscriptions.set_topics([SCAN, GOAL])
    scan, goal = bench.channel("/lidar"), bench.channel("/goal_point")
    slow = bench.join()
    bench.subscribe(slow, 1, scan.id)
    bench.subscribe(slow, 2, goal.id)
    bench.stream(scan)
    sent(slow.outbox)
    bench.hub.subscriptions.suspend(slow)
    bench.hub.subscriptions.message(Watch(goal, None), 5, b"goal")
    bench.hub.subscriptions.resume(slow)
    assert sent(slow.outbox) == [message_head(2, 5) + b"goal"]


def test_a_topic_that_becomes_a_stream_is_suspended_later(bench: Bench) -> None:
    bench.hub.subscriptions.set_topics([SCAN])
    scan = bench.channel("/lidar")
    slow = bench.join()
    bench.subscribe(slow, 1, scan.id)
    bench.program.take()
    bench.hub.subscriptions.suspend(slow)
    assert bench.program.take() == []
    bench.stream(scan)
    bench.hub.subscriptions.suspend(slow)
    assert bench.program.take() == [("unwatch", "/lidar", None)]


def test_few_messages_with_many_bytes_are_a_stream(bench: Bench) -> None:
    """A camera at 1 Hz: no image is rendered for a client that does not read."""
    bench.hub.subscriptions.set_topics([SCAN])
    scan = bench.channel("/lidar")
    slow = bench.join()
    bench.subscribe(slow, 1, scan.id)
    bench.program.take()
    bench.hub.subscriptions.message(Watch(scan, None), 5, bytes(600_000))
    bench.hub.subscriptions.end_period()
    bench.hub.subscriptions.suspend(slow)
    assert bench.program.take() == [("unwatch", "/lidar", None)]
    bench.hub.subscriptions.resume(slow)
    bench.program.take()
    for _ in range(2):
        bench.hub.subscriptions.end_period()
    bench.hub.subscriptions.suspend(slow)
    assert bench.program.take() == [], "no message in the last two periods"


def test_a_suspended_client_changes_its_subscriptions(bench: Bench) -> None:
    bench.hub.subscriptions.set_topics([SCAN])
    scan = bench.channel("/lidar")
    slow = bench.join()
    bench.hub.subscriptions.suspend(slow)
    assert bench.subscribe(slow, 1, scan.id) == []
    bench.stream(scan)
    sent(slow.outbox)
    bench.hub.subscriptions.suspend(slow)
    assert bench.program.take() == [
        ("watch", "/lidar", None),
        ("unwatch", "/lidar", None),
    ]
    assert bench.ask(slow, op="unsubscribe", subscriptionIds=[1]) == []
    bench.hub.subscriptions.resume(slow)
    bench.hub.leave(slow)
    assert bench.program.take() == []
