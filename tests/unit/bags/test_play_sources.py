"""Playback sources: several recordings as one, and damaged recordings."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from memory_source import MemorySource, S, recorded, topic_of

from navette.bags import BagWriter, Damage, open_bag
from navette.bags.bag import BagMessage
from navette.bags.play import (
    MergedSource,
    Player,
    PlayOptions,
    PlayState,
    TolerantSource,
)
from navette.errors import FileFormatError
from navette.msgs import definition_text, serialize
from navette.msgs.std_msgs.msg import String

A, B = topic_of("/a", String), topic_of("/b", String)


def numbers(topic: object, *stamps: float) -> list[BagMessage]:
    return [recorded(topic, s, String(data=f"{s}")) for s in stamps]  # type: ignore[arg-type]


def test_several_recordings_play_as_one() -> None:
    merged = MergedSource(
        [MemorySource(numbers(A, 1, 3, 5)), MemorySource(numbers(B, 2, 3, 9))]
    )
    assert [t.name for t in merged.topics] == ["/a", "/b"]
    assert (merged.start_ns, merged.end_ns) == (1 * S, 9 * S)
    stamps = [(m.stamp_ns // S, m.topic.name) for m in merged.messages()]
    assert stamps == [(1, "/a"), (2, "/b"), (3, "/a"), (3, "/b"), (5, "/a"), (9, "/b")]
    part = merged.messages(["/b"], start_ns=3 * S, end_ns=8 * S)
    assert [m.stamp_ns // S for m in part] == [3]


def test_an_empty_recording_does_not_move_the_start() -> None:
    merged = MergedSource([MemorySource([]), MemorySource(numbers(A, 7, 8))])
    assert (merged.start_ns, merged.end_ns) == (7 * S, 8 * S)


def test_a_damaged_part_is_skipped_and_reported_once(tmp_path: Path) -> None:
    path = tmp_path / "talk.mcap"
    writer = BagWriter(path)
    kind = "std_msgs/msg/String"
    channel = writer.add_channel("/a", kind, definition_text(kind))
    for i in range(100):
        writer.write(channel, i * S, serialize(String(data=f"{i:040}")))
        if i % 10 == 9:
            writer.flush()
    writer.close()
    data = bytearray(path.read_bytes())
    middle = len(data) // 4
    data[middle : middle + 8] = bytes(8 * [0x5A])
    path.write_bytes(data)
    reported: list[Damage] = []
    with open_bag(path) as bag:
        with pytest.raises(FileFormatError):
            list(bag.messages())
        player = Player(
            TolerantSource(bag, on_damage=reported.append), PlayOptions(loop=True)
        )
        player.start(0)
        counts = []
        for _ in range(2):
            count, passes = 0, player.passes
            while player.passes == passes:
                due_ns = player.due_ns()
                assert due_ns is not None
                count += player.take(due_ns) is not None
            counts.append(count)
    assert counts == [90, 90]
    assert len(reported) == 1


OPERATIONS = st.lists(
    st.one_of(
        st.tuples(st.just("wait"), st.integers(0, 3 * S)),
        st.tuples(st.just("pause"), st.just(0)),
        st.tuples(st.just("resume"), st.just(0)),
        st.tuples(st.just("step"), st.just(0)),
        st.tuples(st.just("rate"), st.sampled_from([0.1, 0.7, 1.0, 3.0])),
    ),
    max_size=40,
)


@given(operations=OPERATIONS, gaps=st.lists(st.integers(0, S), max_size=30))
def test_no_message_is_lost_repeated_or_early_under_any_control(
    operations: list[tuple[str, float]], gaps: list[int]
) -> None:
    stamps = [sum(gaps[:i]) for i in range(len(gaps) + 1)]
    messages = [BagMessage(A, s, bytes([i])) for i, s in enumerate(stamps)]
    player = Player(MemorySource(messages), PlayOptions())
    now_ns, received = 0, []
    player.start(now_ns)
    for name, value in operations:
        if name == "wait":
            until_ns = now_ns + int(value)
            while (due_ns := player.due_ns()) is not None and due_ns <= until_ns:
                now_ns = max(now_ns, due_ns)
                message = player.take(now_ns)
                if message is not None:
                    assert message.stamp_ns <= player.position_ns(now_ns)
                    received.append(message)
            now_ns = until_ns
        elif name == "step":
            message = player.step(now_ns)
            received += [] if message is None else [message]
        elif name == "rate":
            player.set_rate(now_ns, value)
        else:
            getattr(player, name)(now_ns)
        assert 0 <= player.position_ns(now_ns) <= stamps[-1]
    assert received == messages[: len(received)]
    if player.state is PlayState.ENDED:
        assert received == messages
