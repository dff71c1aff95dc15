"""The last message for late clients: cached, sent first, dropped when outdated."""

import struct
from pathlib import Path
from typing import Any

import pytest
from viewer_fakes import Bench, sent

from navette.viewer.playback import PlaybackState, PlaybackStatus
from navette.viewer.replies import ConnectionGraph, message_head
from navette.viewer.session import Topic, Watch

PATH = Topic("/path", "nav_msgs/msg/Path", "float64[] x")
SCAN = Topic("/lidar", "sensor_msgs/msg/LaserScan", "float32[] ranges")
PUBLISHED = ConnectionGraph({"/path": ("/planner",)}, {})


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    bench = Bench(tmp_path)
    bench.hub.subscriptions.set_topics([PATH, SCAN])
    bench.hub.set_graph(PUBLISHED)
    return bench


def say(bench: Bench, stamp_ns: int, payload: bytes = b"way") -> None:
    bench.hub.subscriptions.message(
        Watch(bench.channel("/path"), None), stamp_ns, payload
    )


def latecomer(bench: Bench) -> list[Any]:
    """What a new client is given when it subscribes."""
    return bench.subscribe(bench.join(), 7, bench.channel("/path").id)


def test_a_state_topic_is_subscribed_before_a_client_watches(bench: Bench) -> None:
    assert bench.program.take() == [("watch", "/path", None)]


def test_late_clients_receive_the_last_message(bench: Bench) -> None:
    assert latecomer(bench) == []
    say(bench, 1)
    say(bench, 2, b"newer")
    assert latecomer(bench) == [message_head(7, 2) + b"newer"]
    assert latecomer(bench) == [message_head(7, 2) + b"newer"]


def test_a_state_topic_stays_subscribed_when_the_last_client_leaves(
    bench: Bench,
) -> None:
    session = bench.join()
    bench.subscribe(session, 1, bench.channel("/path").id)
    bench.program.take()
    bench.hub.leave(session)
    assert bench.program.take() == []
    say(bench, 3)
    assert latecomer(bench) == [message_head(7, 3) + b"way"]


def test_the_message_of_a_publisher_that_left_is_dropped(bench: Bench) -> None:
    say(bench, 1)
    bench.program.take()
    bench.hub.set_graph(ConnectionGraph({}, {"/path": ("/control",)}))
    assert bench.program.take() == [("unwatch", "/path", None)]
    assert latecomer(bench) == []
    bench.program.take()
    bench.hub.set_graph(PUBLISHED)  # watched already
    assert bench.program.take() == []
    say(bench, 2)
    assert latecomer(bench) == [message_head(7, 2) + b"way"]


def test_command_topics_are_not_subscribed(bench: Bench) -> None:
    """The sender of a goal waits for a subscriber, which must be the planner."""
    bench.program.take()
    goal = Topic("/goal_point", "geometry_msgs/msg/PointStamped", "float64 x")
    bench.hub.subscriptions.set_topics([goal])
    bench.hub.set_graph(ConnectionGraph({"/goal_point": ("/missions",)}, {}))
    assert ("watch", "/goal_point", None) not in bench.program.take()


def test_a_seek_clears_the_cache(bench: Bench) -> None:
    say(bench, 1)
    state = PlaybackState(PlaybackStatus.PLAYING, 5, 1.0)
    bench.hub.set_playback(state, did_seek=True, request_id="")
    assert latecomer(bench) == []


def test_a_stream_is_unsubscribed_without_a_client(bench: Bench) -> None:
    bench.program.take()
    for number in range(20):
        say(bench, number * 100_000_000)
    assert bench.program.take() == [("unwatch", "/path", None)]
    bench.hub.set_graph(ConnectionGraph({**PUBLISHED.published, "/new": ("/b",)}, {}))
    assert bench.program.take() == []
    assert latecomer(bench) == []  # the next one comes soon


def test_a_watched_stream_stays_subscribed(bench: Bench) -> None:
    session = bench.join()
    bench.subscribe(session, 1, bench.channel("/path").id)
    bench.program.take()
    for number in range(30):
        say(bench, number * 100_000_000)
    assert bench.program.take() == []
    assert len([f for f in sent(session.outbox) if isinstance(f, bytes)]) == 16
    bench.hub.leave(session)
    assert bench.program.take() == [("unwatch", "/path", None)]


def test_a_clock_that_is_set_back_makes_no_stream(bench: Bench) -> None:
    bench.program.take()
    for _ in range(20):
        for second in range(0, 30, 10):
            say(bench, second * 1_000_000_000)
    assert bench.program.take() == []


def test_huge_messages_are_not_cached(bench: Bench) -> None:
    bench.program.take()
    say(bench, 1, bytes(5_000_000))
    assert bench.program.take() == [("unwatch", "/path", None)]


def test_a_removed_topic_is_unsubscribed(bench: Bench) -> None:
    bench.program.take()
    bench.hub.subscriptions.set_topics([SCAN])
    assert bench.program.take() == [("unwatch", "/path", None)]


def test_latched_topics_are_not_cached(bench: Bench) -> None:
    bench.program.take()
    bench.hub.subscriptions.set_topics(
        [Topic("/map", "nav_msgs/msg/OccupancyGrid", "", True)]
    )
    assert ("watch", "/map", None) not in bench.program.take()


def test_a_cached_message_keeps_its_stamp(bench: Bench) -> None:
    say(bench, 5)
    ((frame),) = latecomer(bench)
    assert struct.unpack_from("<BIQ", frame) == (1, 7, 5)
