"""Playback logic without a node, in virtual time."""

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st
from memory_source import LATCHED, MemorySource, S, recorded, topic_of

from navette.bags.bag import BagMessage
from navette.bags.play import (
    DirectFeed,
    Player,
    PlayOptions,
    PlayState,
    PrefetchingFeed,
)
from navette.bags.play.playhead import Playhead
from navette.errors import FileFormatError, InvalidValueError, UnknownNameError
from navette.msgs.geometry_msgs.msg import TransformStamped
from navette.msgs.std_msgs.msg import String
from navette.msgs.tf2_msgs.msg import TFMessage

CHATTER = topic_of("/chatter", String)
OTHER = topic_of("/other", String)
MAP = topic_of("/map", String, LATCHED)
NOW = 5_000 * S  # when the player is started


def source(stamps: tuple[float, ...] = (10.0, 10.5, 11.0, 12.0)) -> MemorySource:
    return MemorySource([recorded(CHATTER, s, String(data=f"{s}")) for s in stamps])


def text(message: BagMessage | None) -> str | None:
    return None if message is None else message.data[8:].rstrip(b"\0").decode()


def started(of: MemorySource, **options: object) -> Player:
    player = Player(of, PlayOptions(**options))  # type: ignore[arg-type]
    player.start(NOW)
    player.pop_jump()
    return player


def run(player: Player, until_s: float) -> list[tuple[float, str]]:
    """Return (seconds since the start, message) of all messages played until then."""
    received = []
    while (due_ns := player.due_ns()) is not None and due_ns <= NOW + until_s * S:
        message = player.take(due_ns)
        if message is not None:
            received.append(((due_ns - NOW) / S, text(message) or ""))
    return received


def test_messages_are_due_at_their_times() -> None:
    player = started(source())
    assert run(player, 10.0) == [
        (0.0, "10.0"),
        (0.5, "10.5"),
        (1.0, "11.0"),
        (2.0, "12.0"),
    ]
    assert player.state is PlayState.ENDED
    assert player.due_ns() is None
    assert player.position_ns(NOW + 100 * S) == 12 * S


def test_no_message_is_early() -> None:
    player = started(source())
    assert text(player.take(NOW)) == "10.0"
    assert player.take(NOW + S // 2 - 1) is None
    assert text(player.take(NOW + S // 2)) == "10.5"


def test_the_rate_scales_time() -> None:
    assert [t for t, _ in run(started(source(), rate=0.5), 10.0)] == [0, 1, 2, 4]
    assert [t for t, _ in run(started(source(), rate=4.0), 10.0)] == [
        0,
        1 / 8,
        1 / 4,
        0.5,
    ]


def test_a_change_of_rate_applies_from_now() -> None:
    player = started(source())
    run(player, 0.5)
    player.set_rate(NOW + S // 2, 2.0)
    assert run(player, 10.0) == [(0.75, "11.0"), (1.25, "12.0")]


def test_a_pause_stops_time() -> None:
    player = started(source())
    run(player, 0.5)
    player.pause(NOW + 3 * S // 4)
    assert player.state is PlayState.PAUSED
    assert player.due_ns() is None
    assert player.take(NOW + 50 * S) is None
    assert player.position_ns(NOW + 50 * S) == 10.75 * S
    player.resume(NOW + 100 * S)
    assert run(player, 200.0) == [(100.25, "11.0"), (101.25, "12.0")]


def test_a_step_pauses_and_returns_the_next_message() -> None:
    player = started(source(), paused=True)
    assert player.take(NOW + 9 * S) is None
    assert [text(player.step(NOW)) for _ in range(2)] == ["10.0", "10.5"]
    assert player.position_ns(NOW) == 10.5 * S
    player.resume(NOW + S)
    assert text(player.step(NOW + S)) == "11.0"
    assert player.state is PlayState.PAUSED
    assert text(player.step(NOW + S)) == "12.0"
    assert player.step(NOW + S) is None
    assert player.state is PlayState.ENDED
    assert player.step(NOW + S) is None


def test_a_step_over_the_end_of_a_loop_returns_the_first() -> None:
    player = started(source(), paused=True, loop=True)
    assert [text(player.step(NOW)) for _ in range(6)] == [
        "10.0",
        "10.5",
        "11.0",
        "12.0",
        "10.0",
        "10.5",
    ]
    assert player.passes == 2


def test_a_loop_restarts_without_drift() -> None:
    player = started(source(), loop=True, rate=2.0)
    received = run(player, 3.0)
    assert received[:4] == [(0.0, "10.0"), (0.25, "10.5"), (0.5, "11.0"), (1.0, "12.0")]
    assert received[4:8] == [(t + 1.0, m) for t, m in received[:4]]
    assert received[8:12] == [(t + 2.0, m) for t, m in received[:4]]


def test_a_loop_of_a_single_stamp_advances_time() -> None:
    player = started(source((10.0,)), loop=True)
    assert len(run(player, 0.1)) == 11


def test_a_seek_continues_from_the_new_position() -> None:
    player = started(source())
    run(player, 0.5)
    assert player.seek(NOW + S, 11 * S) == 11 * S
    jump = player.pop_jump()
    assert jump is not None
    assert jump.to_ns == 11 * S
    assert player.pop_jump() is None
    assert run(player, 10.0) == [(1.0, "11.0"), (2.0, "12.0")]


@pytest.mark.parametrize(("place_s", "wanted_s"), [(-5, 10), (10.2, 10.2), (99, 12)])
def test_a_seek_stays_within_the_recording(place_s: float, wanted_s: float) -> None:
    player = started(source())
    assert player.seek(NOW, round(place_s * S)) == wanted_s * S


def test_a_seek_resumes_a_player_that_has_ended() -> None:
    player = started(source())
    run(player, 10.0)
    player.seek(NOW + 10 * S, 0)
    assert player.state is PlayState.PLAYING
    assert len(run(player, 20.0)) == 4


def test_only_a_part_is_played() -> None:
    player = started(source(), start_offset_s=0.5, duration_s=0.5)
    assert run(player, 10.0) == [(0.0, "10.5"), (0.5, "11.0")]


def test_a_start_in_the_middle_waits_for_the_first_message() -> None:
    assert run(started(source(), start_offset_s=0.75), 10.0)[0] == (0.25, "11.0")


def test_topics_are_selected() -> None:
    both = MemorySource(
        [
            recorded(t, 1.0 + i, String(data=t.name))
            for i, t in enumerate((CHATTER, OTHER))
        ]
    )
    for options, wanted in (
        ({"topics": ("/chatter",)}, ("/chatter",)),
        ({"topics": ("chatter",)}, ("/chatter",)),
        ({"regex": "^/o"}, ("/other",)),
        ({"topics": ("/chatter",), "regex": "^/o"}, ("/chatter", "/other")),
        ({"exclude": "chat"}, ("/other",)),
        ({}, ("/chatter", "/other")),
    ):
        player = Player(both, PlayOptions(**options))  # type: ignore[arg-type]
        assert player.names == wanted
    with pytest.raises(UnknownNameError, match=r"'/scan'; known: /chatter, /other"):
        Player(both, PlayOptions(topics=("/scan",)))
    with pytest.raises(InvalidValueError, match="no topic is selected"):
        Player(both, PlayOptions(exclude="."))


def test_thousands_of_topics_are_refused_unless_some_are_chosen() -> None:
    names = [f"/t{i}" for i in range(4001)]
    with pytest.raises(InvalidValueError, match="4001 topics; at most 4000 are played"):
        PlayOptions().choose(names)
    assert PlayOptions(regex="^/t7$").choose(names) == ("/t7",)
    with pytest.raises(InvalidValueError, match=r"/t98, /t99 and 3901 more$"):
        PlayOptions(exclude=".").choose(names)


@pytest.mark.parametrize(
    "wrong",
    [
        {"rate": 0.0},
        {"rate": -1.0},
        {"rate": float("nan")},
        {"rate": float("inf")},
        {"start_offset_s": -1.0},
        {"duration_s": 0.0},
        {"regex": "("},
        {"exclude": "["},
    ],
)
def test_invalid_options_are_named(wrong: dict[str, object]) -> None:
    with pytest.raises(InvalidValueError, match=next(iter(wrong)).split("_")[0]):
        PlayOptions(**wrong)  # type: ignore[arg-type]


def test_an_offset_beyond_the_end_is_refused() -> None:
    with pytest.raises(InvalidValueError, match=r"only 2.000 s"):
        Player(source(), PlayOptions(start_offset_s=2.5))


def test_playback_does_not_catch_up_after_a_pause_of_the_process() -> None:
    player = started(source((0.0, 1.0, 10.0, 11.0)))
    player.take(NOW)
    assert text(player.take(NOW + 60 * S)) == "1.0"  # 59 s late: time is set there
    assert player.due_ns() == NOW + 69 * S


# -- latched topics ----------------------------------------------------------------


def with_map() -> MemorySource:
    maps = [recorded(MAP, s, String(data=f"map {s}")) for s in (1.0, 2.0, 50.0)]
    rest = [recorded(CHATTER, s / 10, String(data="x")) for s in range(10, 1000)]
    return MemorySource([*maps, *rest])


@pytest.mark.parametrize(
    ("offset_s", "wanted"),
    [(0.0, []), (0.5, ["map 1.0"]), (30.0, ["map 2.0"]), (60.0, ["map 50.0"])],
)
def test_the_last_latched_message_comes_first(
    offset_s: float, wanted: list[str]
) -> None:
    player = Player(with_map(), PlayOptions(start_offset_s=offset_s))
    player.start(NOW)
    jump = player.pop_jump()
    assert jump is not None
    assert [text(m) for m in jump.latched] == wanted


def test_latched_messages_come_first_after_a_seek_and_in_every_pass() -> None:
    of = with_map()
    player = started(of, start_offset_s=60.0, duration_s=1.0, loop=True)
    run(player, 1.5)
    jump = player.pop_jump()
    assert jump is not None
    assert [text(m) for m in jump.latched] == ["map 50.0"]
    player.seek(NOW, 60 * S)
    assert player.pop_jump() is not None


def test_only_played_latched_topics_are_searched() -> None:
    player = Player(with_map(), PlayOptions(start_offset_s=60.0, topics=("/chatter",)))
    player.start(NOW)
    jump = player.pop_jump()
    assert jump is not None
    assert jump.latched == ()


def test_all_static_transforms_are_published_without_recorded_qos() -> None:
    static = topic_of("/tf_static", TFMessage)
    of = MemorySource(
        [recorded(static, s, TFMessage()) for s in (0.0, 0.1, 0.2, 300.0)]
        + [recorded(CHATTER, 0.0, String()), recorded(CHATTER, 500.0, String())]
    )
    player = Player(of, PlayOptions(start_offset_s=400.0))
    player.start(NOW)
    jump = player.pop_jump()
    assert jump is not None
    assert [m.stamp_ns / S for m in jump.latched] == [0.0, 0.1, 0.2, 300.0]


def placing(child: str) -> TFMessage:
    return TFMessage(transforms=[TransformStamped(child_frame_id=child)])


def test_a_seek_while_paused_returns_the_last_messages_and_transforms() -> None:
    tf = topic_of("/tf", TFMessage)
    frames = {5.0: "wheel", 8.5: "odom", 9.0: "base", 9.5: "base", 11.0: "base"}
    of = MemorySource(
        [recorded(tf, s, placing(child)) for s, child in frames.items()]
        + [recorded(CHATTER, s, String(data=f"{s}")) for s in (8.0, 9.0, 9.9, 10.5)]
        + [recorded(OTHER, s, String(data=f"other {s}")) for s in (7.0, 20.0)]
        + [recorded(MAP, 0.0, String(data="map"))]
    )
    player = started(of, paused=True)
    player.seek(NOW, 10 * S)
    jump = player.pop_jump()
    assert jump is not None
    assert [text(m) for m in jump.latched] == ["map"]
    seen = [(m.topic.name, m.stamp_ns / S) for m in jump.recent]
    assert seen == [("/tf", 8.5), ("/tf", 9.5), ("/chatter", 9.9)]
    player.resume(NOW)
    player.seek(NOW, 10 * S)
    jump = player.pop_jump()
    assert jump is not None
    assert jump.recent == ()


# -- time --------------------------------------------------------------------------


@given(
    rate=st.floats(0.001, 10_000.0),
    now_ns=st.integers(0, 2**62),
    bag_ns=st.integers(0, 2**62),
    ahead_ns=st.integers(0, 10**15),
)
def test_a_position_is_reached_when_it_is_due(
    rate: float, now_ns: int, bag_ns: int, ahead_ns: int
) -> None:
    head = Playhead(rate)
    head.place(now_ns, bag_ns)
    head.moves = True
    due_ns = head.due_ns(bag_ns + ahead_ns)
    assert head.at(due_ns) >= bag_ns + ahead_ns
    if due_ns > now_ns:
        assert head.at(due_ns - 1) < bag_ns + ahead_ns


# -- feeds -------------------------------------------------------------------------


def many(count: int) -> list[BagMessage]:
    return [recorded(CHATTER, i / 1000, String(data=f"{i}")) for i in range(count)]


@pytest.mark.parametrize("make", [DirectFeed, PrefetchingFeed])
def test_feeds_return_every_message_once(
    make: type[DirectFeed | PrefetchingFeed],
) -> None:
    messages = many(5000)
    feed = make(iter(messages))
    received = []
    while feed.peek() is not None:
        received.append(feed.pop())
    assert received == messages
    assert feed.pop() is None
    feed.close()


@pytest.mark.parametrize("make", [DirectFeed, PrefetchingFeed])
def test_feeds_can_be_closed_at_any_time(
    make: type[DirectFeed | PrefetchingFeed],
) -> None:
    before = threading.active_count()
    for taken in (0, 1, 2, 7, 49):
        feed = make(iter(many(4000)))
        for _ in range(taken):
            feed.pop()
        feed.close()
        assert feed.pop() is None
        feed.close()
    assert threading.active_count() == before


def test_reading_ahead_is_bounded() -> None:
    taken = []

    def endless() -> object:
        for i, message in enumerate(many(1) * 100_000):
            taken.append(i)
            yield message

    feed = PrefetchingFeed(endless())  # type: ignore[arg-type]
    for _ in range(100):
        feed.pop()
    feed.close()
    assert len(taken) < 3000


def test_damage_is_reported_after_the_message_before_it() -> None:
    def damaged() -> object:
        yield from many(3)
        raise FileFormatError("x.mcap", "byte 7: damaged")

    feed = PrefetchingFeed(damaged())  # type: ignore[arg-type]
    assert [feed.pop() is None for _ in range(3)] == [False] * 3
    with pytest.raises(FileFormatError, match="byte 7"):
        feed.pop()
    feed.close()
