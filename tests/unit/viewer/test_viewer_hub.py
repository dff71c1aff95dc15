"""Clients of the hub: joining, status messages, time, files."""

import json
from pathlib import Path
from typing import Any

import pytest
from viewer_fakes import Bench, sent

from navette.viewer.outbox import Outbox
from navette.viewer.session import Topic

SCAN = Topic("/lidar", "sensor_msgs/msg/LaserScan", "float32[] ranges")

LARGE = "package://navette/large"


def test_new_clients_receive_info_channels_and_time(bench: Bench) -> None:
    bench.hub.subscriptions.set_topics([SCAN])
    bench.hub.set_now(5)
    session = bench.hub.join(Outbox())
    info, channels, time = sent(session.outbox)
    assert info["op"] == "serverInfo"
    assert [c["topic"] for c in channels["channels"]] == ["/lidar"]
    assert time[0] == 2


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
    bench.hub.subscriptions.set_topics([SCAN])
    session, other = bench.join(), bench.join()
    bench.subscribe(session, 10, 1)
    (status,) = bench.ask(session, **document)
    assert status["op"] == "status"
    assert status["level"] >= 1
    assert complaint in status["message"]
    assert not other.outbox


def test_problems_of_long_requests_are_summed_up(bench: Bench) -> None:
    session = bench.join()
    pairs = [{"id": i, "channelId": 1000 + i} for i in range(1000)]
    statuses = bench.ask(session, op="subscribe", subscriptions=pairs)
    assert len(statuses) == 4
    assert "unknown channel id 1000" in statuses[0]["message"]
    assert statuses[-1]["message"] == "subscribe: 997 more entries are refused"


def test_pending_requests_are_counted(bench: Bench) -> None:
    session = bench.join()
    bench.advertise(session)
    bench.ask(session, op="getParameters", parameterNames=[], id="x")
    assert session.pending == 2
    bench.hub.done(session.id)
    assert session.pending == 1


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
