"""The player node: published messages, their times, and the clock."""

from typing import Any

import pytest
from memory_source import LATCHED, MemorySource, S, recorded, topic_of

from navette.bags import OfferedQos
from navette.bags.bag import BagMessage, BagTopic
from navette.bags.play import PlayOptions, PlayState
from navette.bags.play.node import PlayerNode
from navette.errors import InvalidValueError
from navette.msgs.builtin_interfaces.msg import Time
from navette.msgs.rosbag2_interfaces import srv
from navette.msgs.rosgraph_msgs.msg import Clock
from navette.msgs.std_msgs.msg import Float64, String
from navette.runtime import PacedClock, stamp_to_ns
from navette.runtime.testing import GraphHarness

CHATTER = topic_of("/chatter", String)
MAP = topic_of("/map", String, LATCHED)


def source() -> MemorySource:
    return MemorySource(
        [
            recorded(MAP, 100.0, String(data="map")),
            *(recorded(CHATTER, 100 + i / 2, String(data=f"{i}")) for i in range(5)),
        ]
    )


def play(graph: GraphHarness, of: MemorySource, **more: Any) -> PlayerNode:
    options = {k: more.pop(k) for k in list(more) if k in PlayOptions.__annotations__}
    node = PlayerNode(of, PlayOptions(**options), context=graph.context, **more)
    return graph.add(node)


def texts(probe: Any) -> list[str]:
    return [m.data for m in probe.messages]


def test_messages_are_published_at_their_time() -> None:
    with GraphHarness() as graph:
        probe = graph.collect("/chatter", String)
        ended: list[int] = []
        player = play(graph, source(), on_end=lambda: ended.append(graph.now_ns))
        graph.run_for(1.0)
        player.start()
        graph.run_for(5.0)
        assert texts(probe) == list("01234")
        assert probe.stamps_ns == [S + i * S // 2 for i in range(5)]
        assert ended == [3 * S]
        progress = player.progress()
        assert progress.state is PlayState.ENDED
        assert progress.published == 6
        assert progress.position_ns == progress.end_ns == 102 * S


def test_names_can_be_remapped() -> None:
    with GraphHarness() as graph:
        probe = graph.collect("/other", String)
        play(graph, source(), remap=["/chatter:=/other"]).start()
        graph.run_for(5.0)
        assert probe.count == 5


def test_late_subscribers_receive_latched_messages() -> None:
    with GraphHarness() as graph:
        play(graph, source()).start()
        graph.run_for(1.2)
        assert texts_after(graph, graph.collect("/map", String, latched=True)) == [
            "map"
        ]
        assert texts_after(graph, graph.collect("/map", String)) == []


def test_a_subscriber_receives_the_last_message_while_the_recording_is_paused() -> None:
    """A page that is opened, or opens a panel, then displays the moment."""
    with GraphHarness() as graph:
        player = play(graph, source())
        player.start()
        graph.run_for(1.2)
        assert texts_after(graph, graph.collect("/chatter", String)) == []
        player.pause()
        assert texts_after(graph, graph.collect("/chatter", String)) == ["2"]
        player.resume()
        graph.run_for(5.0)
        assert player.player.state is PlayState.ENDED
        assert texts_after(graph, graph.collect("/chatter", String)) == ["4"]


def texts_after(graph: GraphHarness, probe: Any) -> list[str]:
    graph.run_for(0.0)
    return texts(probe)


def test_a_start_in_the_middle_publishes_earlier_latched_messages() -> None:
    with GraphHarness() as graph:
        probe = graph.collect("/map", String)
        player = play(graph, source(), start_offset_s=1.0, paused=True)
        player.start()
        graph.run_for(0.1)
        assert texts(probe) == ["map"]


def test_the_clock_is_published_at_its_rate_and_first_at_jumps() -> None:
    with GraphHarness() as graph:
        order: list[tuple[str, float]] = []
        node = graph.node
        node.create_subscription(
            Clock, "/clock", lambda m: order.append(("t", stamp_to_ns(m.clock) / S)), 99
        )
        node.create_subscription(
            String, "/map", lambda m: order.append(("map", 0.0)), 10
        )
        player = play(graph, source(), clock_rate_hz=4.0, start_offset_s=1.0)
        player.start()
        graph.run_for(0.5)
        times = [t for kind, t in order if kind == "t"]
        assert times[0] == 101.0
        assert {101.0, 101.25, 101.5} <= set(times)
        order.clear()
        player.seek(101 * S)
        graph.run_for(0.0)
        assert order == [("t", 101.0), ("map", 0.0)]


def test_a_published_clock_replaces_a_recorded_one() -> None:
    clock = topic_of("/clock", Clock)
    of = MemorySource([recorded(clock, 1.0, Clock()), recorded(CHATTER, 1.0, String())])
    with GraphHarness() as graph:
        assert play(graph, of, clock_rate_hz=1.0).player.names == ("/chatter",)
    with GraphHarness() as graph:
        assert play(graph, of).player.names == ("/clock", "/chatter")


def test_a_subscriber_acts_before_the_next_message() -> None:
    """A queue of depth 1 loses no message, although many have the same stamp."""
    of = MemorySource([recorded(CHATTER, 1.0, String(data=f"{i}")) for i in range(50)])
    with GraphHarness() as graph:
        received: list[str] = []
        graph.node.create_subscription(
            String, "/chatter", lambda m: received.append(m.data), 1
        )
        play(graph, of).start()
        graph.run_for(0.1)
        assert received == [f"{i}" for i in range(50)]


SENSOR = OfferedQos(reliability="best_effort", depth=5)


@pytest.mark.parametrize(
    ("offers", "reliability", "durability", "depth"),
    [
        ((), "RELIABLE", "VOLATILE", 10),
        (
            (OfferedQos(reliability="best_effort", depth=5),),
            "BEST_EFFORT",
            "VOLATILE",
            5,
        ),
        ((LATCHED,), "RELIABLE", "TRANSIENT_LOCAL", 1),
        (
            (LATCHED, OfferedQos(reliability="best_effort")),
            "RELIABLE",
            "TRANSIENT_LOCAL",
            1,
        ),
        ((LATCHED, LATCHED), "RELIABLE", "TRANSIENT_LOCAL", 2),
    ],
)
def test_publishers_have_the_recorded_qos(
    offers: tuple[OfferedQos, ...], reliability: str, durability: str, depth: int
) -> None:
    topic = topic_of("/t", String, *offers)
    with GraphHarness() as graph:
        play(graph, MemorySource([recorded(topic, 1.0, String())]))
        (endpoint,) = graph.context.graph.endpoints("/t")
        assert endpoint.qos.reliability.name == reliability
        assert endpoint.qos.durability.name == durability
        assert endpoint.qos.depth == depth


def test_a_type_that_is_not_installed_is_played() -> None:
    topic = BagTopic("/t", "strange_msgs/msg/Play", "float64 odd\nuint8[] more\n")
    data = b"\x00\x01\x00\x00" + bytes(8) + b"\x02\x00\x00\x00\x05\x06"
    with GraphHarness() as graph:
        play(graph, MemorySource([BagMessage(topic, S, data)])).start()
        probe = graph.collect("/t", "strange_msgs/msg/Play")
        graph.run_for(0.1)
        assert list(probe.last.more) == [5, 6]


def test_topics_that_cannot_be_played_are_logged_and_others_played(
    capsys: pytest.CaptureFixture[str],
) -> None:
    unknown = BagTopic("/u", "absent_msgs/msg/Absent")
    of = MemorySource([BagMessage(unknown, S, b""), recorded(CHATTER, 1.0, String())])
    with GraphHarness() as graph:
        probe = graph.collect("/chatter", String)
        play(graph, of).start()
        graph.run_for(0.1)
        assert probe.count == 1
    assert "/u is not played" in capsys.readouterr().err


def test_a_topic_of_another_type_here_is_named(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with GraphHarness() as graph:
        graph.collect("/chatter", Float64)
        play(graph, source()).start()
        graph.run_for(5.0)
    assert "/chatter is not played" in capsys.readouterr().err


def test_invalid_options_leave_no_node() -> None:
    with GraphHarness() as graph:
        with pytest.raises(InvalidValueError):
            play(graph, source(), exclude=".")
        assert [n.name for n in graph.context.graph.nodes()] == ["harness"]


def call(graph: GraphHarness, kind: Any, name: str, **fields: Any) -> Any:
    client = graph.node.create_client(kind, f"/rosbag2_player/{name}")
    future = client.call_async(kind.Request(**fields))
    assert graph.executor.spin_until_complete(future, 0)
    graph.node.destroy_client(client)
    return future.result()


def test_services_are_those_of_rosbag2(caplog: pytest.LogCaptureFixture) -> None:
    with GraphHarness() as graph:
        probe = graph.collect("/chatter", String)
        ended: list[bool] = []
        player = play(graph, source(), on_end=lambda: ended.append(True))
        player.start()
        graph.run_for(0.1)
        assert not call(graph, srv.IsPaused, "is_paused").paused
        assert not call(graph, srv.PlayNext, "play_next").success
        call(graph, srv.Pause, "pause")
        assert call(graph, srv.IsPaused, "is_paused").paused
        assert call(graph, srv.PlayNext, "play_next").success
        graph.run_for(3.0)
        assert texts(probe) == ["0", "1"]
        call(graph, srv.TogglePaused, "toggle_paused")
        assert player.player.state is PlayState.PLAYING
        assert call(graph, srv.SetRate, "set_rate", rate=2.0).success
        assert not call(graph, srv.SetRate, "set_rate", rate=-1.0).success
        assert "rate not changed" in caplog.text
        assert call(graph, srv.GetRate, "get_rate").rate == 2.0
        graph.run_for(0.25)
        assert texts(probe) == ["0", "1", "2"]
        assert not call(graph, srv.Seek, "seek", time=Time(sec=99)).success
        assert call(graph, srv.Seek, "seek", time=Time(sec=100)).success
        graph.run_for(0.0)
        assert texts(probe)[3:] == ["0"]
        call(graph, srv.Resume, "resume")
        call(graph, srv.Stop, "stop")
        assert ended == [True]


def test_the_end_can_be_played_again() -> None:
    with GraphHarness() as graph:
        probe = graph.collect("/chatter", String)
        player = play(graph, source())
        player.start()
        graph.run_for(9.0)
        player.toggle_paused()
        graph.run_for(9.0)
        assert texts(probe) == list("01234") * 2


def test_a_paced_clock_gives_the_same_result() -> None:
    """With any clock: the same messages, order and times."""

    def run(graph: GraphHarness) -> list[tuple[int, str]]:
        probe = graph.collect("/chatter", String)
        play(graph, source(), loop=True, rate=0.7).start()
        graph.run_for(8.0)
        return list(zip(probe.stamps_ns, texts(probe), strict=True))

    with GraphHarness() as virtual, GraphHarness(clock=PacedClock(500.0)) as paced:
        assert run(virtual) == run(paced)
