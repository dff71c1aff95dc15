"""Send queue of a slow client."""

from navette.viewer.outbox import Frame, MessageFrame, Outbox, Parts
from navette.viewer.replies import message_head


def drain(outbox: Outbox) -> list[Frame | Parts]:
    frames: list[Frame | Parts] = []
    while outbox:
        frames.append(outbox.pop())
    return frames


def test_frames_are_sent_in_order_control_first() -> None:
    outbox = Outbox()
    outbox.put_data(1, b"a")
    outbox.put_data(2, b"b")
    outbox.put_control("info")
    outbox.put_data(1, b"c")
    assert drain(outbox) == ["info", b"a", b"b", b"c"]


def test_each_stream_keeps_its_newest() -> None:
    outbox = Outbox(depth=2)
    for number in range(5):
        outbox.put_data("fast", b"f%d" % number)
    outbox.put_data("slow", b"s0")
    assert drain(outbox) == [b"f3", b"f4", b"s0"]
    assert outbox.dropped == 3


def test_large_frames_are_bounded_by_bytes_but_one_always_stays() -> None:
    outbox = Outbox(stream_bytes=10)
    for character in (b"a", b"b", b"c"):
        outbox.put_data("image", character * 6)
    outbox.put_data("map", b"m" * 100)
    assert drain(outbox) == [b"cccccc", b"m" * 100]


def test_a_dropped_stream_leaves_no_frames() -> None:
    outbox = Outbox()
    outbox.put_data(1, b"a")
    outbox.put_data(2, b"b")
    outbox.put_data(1, b"c")
    outbox.forget(1)
    outbox.forget(3)
    assert drain(outbox) == [b"b"]


def test_a_client_that_never_reads_overflows() -> None:
    outbox = Outbox(control_bytes=10)
    outbox.put_control("x" * 8)
    assert not outbox.overflowed
    outbox.put_control("x" * 8)
    outbox.put_control("x" * 8)
    assert outbox.overflowed
    assert len(drain(outbox)) == 2


def test_of_too_many_bytes_the_largest_stream_loses_its_oldest() -> None:
    """A goal outlives the images that come after it."""
    outbox = Outbox(data_bytes=100)
    outbox.put_data("goal", b"goal")
    for number in range(20):
        outbox.put_data("camera", bytes([number]) * 40)
        outbox.put_data("depth", bytes([number]) * 30)
    frames: list[Frame | Parts] = []
    while outbox:
        frames.append(outbox.pop())
    assert frames[0] == b"goal"
    assert bytes([19]) * 40 in frames
    assert bytes([19]) * 30 in frames
    assert sum(map(len, frames)) <= 100


def test_a_long_message_is_sent_in_parts_without_a_copy_of_it() -> None:
    outbox = Outbox()
    payload = bytes(range(256)) * 4096
    outbox.put_data("map", MessageFrame(3, 5, payload))
    parts = outbox.pop()
    assert isinstance(parts, list)
    assert b"".join(parts) == message_head(3, 5) + payload
    assert max(len(each) for each in parts) < len(payload) / 2
    assert outbox.size == len(payload)
    outbox.sent()
    assert outbox.size == 0


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
