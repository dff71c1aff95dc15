"""Letters, asks, what a publisher keeps, and long samples in pieces."""

import threading

import pytest
import zenoh
from hypothesis import given
from hypothesis import strategies as st

from navette.errors import DecodeError
from navette.transports.zenoh.attachment import Attachment
from navette.transports.zenoh.recovery import retention as retention_module
from navette.transports.zenoh.recovery.answer import Parts, Recovered
from navette.transports.zenoh.recovery.errands import Errands
from navette.transports.zenoh.recovery.mail import (
    MOST_ENTRIES,
    Ask,
    End,
    Head,
    Kind,
    Letter,
    letters,
    parse_ask,
    parse_end,
    parse_letter,
    parse_sender,
    split_attachment,
)
from navette.transports.zenoh.recovery.retention import Kept, Retention, pieces

GID = bytes(range(16))
heads = st.builds(Head, st.binary(min_size=16, max_size=16), st.integers(0, 2**63 - 1))


@given(kind=st.sampled_from(Kind), entries=st.lists(heads, max_size=5))
def test_letters_are_read_as_they_were_written(kind: Kind, entries: list[Head]) -> None:
    if kind not in {Kind.MATCHED, Kind.HEADS, Kind.BYE}:
        entries = [Head(entry.gid, 0) for entry in entries]
    letter = Letter(kind, tuple(entries))
    assert parse_letter(letter.encode()) == letter


@given(data=st.binary(max_size=60))
def test_what_is_no_letter_is_a_named_error(data: bytes) -> None:
    try:
        assert parse_letter(data).encode() == data
    except DecodeError:
        assert data[:1] not in {bytes([kind]) for kind in Kind} or len(data) % 8 != 1


def test_many_entries_take_several_letters() -> None:
    told = letters(Kind.HEADS, [Head(GID, number) for number in range(4500)])
    assert [len(letter.entries) for letter in told] == [MOST_ENTRIES, MOST_ENTRIES, 500]
    assert all(parse_letter(letter.encode()) == letter for letter in told)


def test_asks_and_ends_are_read_as_they_were_written() -> None:
    ask, end = Ask(GID, 3, 9, 4096, "1f"), End(7, is_long=True, sent=4)
    assert (parse_ask(ask.encode()), parse_end(end.encode())) == (ask, end)
    assert (ask.takes_long, Ask(GID, 3, 9).takes_long) == (True, False)
    for read in (parse_ask, parse_end):
        with pytest.raises(DecodeError, match="of 3 bytes"):
            read(b"abc")
    with pytest.raises(DecodeError, match="by 'x/y'"):
        parse_ask(ask._replace(by="x/y").encode())
    with pytest.raises(DecodeError, match="no session"):
        parse_sender("@navette/7/abc/mail/No")


def sample(number: int, size: int = 8) -> Kept:
    payload = zenoh.ZBytes(bytes([number % 256]) * size)
    return number, Attachment(number, 0, GID).encode(), payload, size


def kept(found: tuple[list[Kept], End]) -> tuple[list[int], End]:
    return [each[0] for each in found[0]], found[1]


def filled(count: int, *, depth: int | None, size: int = 8) -> Retention:
    retention = Retention(depth)
    retention.begin()
    for number in range(1, count + 1):
        assert retention.keeps(number)
        retention.add(sample(number, size))
    return retention


def test_the_last_ones_are_kept() -> None:
    retention = filled(9, depth=3)
    assert kept(retention.between(Ask(GID, 1, 20))) == ([7, 8, 9], End(9))
    assert kept(retention.between(Ask(GID, 4, 7))) == ([7], End(7))
    assert kept(retention.between(Ask(GID, 1, 5))) == ([], End(5))


def test_no_more_is_kept_than_there_is_room_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(retention_module, "MOST_BYTES", 20)
    assert kept(filled(9, depth=5).between(Ask(GID, 1, 9))) == ([8, 9], End(9))
    lone = filled(9, depth=5, size=99)
    assert kept(lone.between(Ask(GID, 1, 9))) == ([9], End(9))
    monkeypatch.setattr(retention_module, "MOST_OF_ALL", 2)
    assert kept(filled(9, depth=None).between(Ask(GID, 1, 9))) == ([8, 9], End(9))


def test_nothing_is_kept_for_nobody() -> None:
    retention = Retention(10)
    assert not retention.keeps(4)
    assert retention.newest == 4
    retention.begin()
    assert retention.keeps(5)
    assert retention.newest == 4  # until it is added
    retention.add(sample(5))
    assert kept(retention.between(Ask(GID, 1, 9))) == ([5], End(5))
    retention.end()
    assert not retention.keeps(7)
    assert kept(retention.between(Ask(GID, 1, 9))) == ([], End(7))


def test_a_long_sample_comes_in_pieces_over_several_answers(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(retention_module, "_MOST_SHORT", 10)
    monkeypatch.setattr(retention_module, "_MOST_LONG", 25)
    retention = Retention(10)
    for each in (sample(1), sample(2, 70), sample(3)):
        retention.add(each)
    assert kept(retention.between(Ask(GID, 1, 3))) == ([1], End(1, is_long=True))
    parts, whole = Parts(most=100), None
    answers = 0
    while whole is None:
        ask = Ask(GID, 2, 3, parts.offset(2))
        found, end = retention.between(ask)
        answers += 1
        for attachment, payload in pieces(found[0], ask):
            own, piece = split_attachment(attachment)
            assert piece is not None
            assert len(payload) <= 10
            assert parts.add(own, piece, zenoh.ZBytes(payload))
        whole = parts.whole()
    assert (answers, end) == (3, End(2))
    assert (whole.payload.to_bytes(), parts.offset(2)) == (bytes([2]) * 70, 0)


def test_pieces_that_do_not_fit_are_left_out() -> None:
    parts = Parts(most=20)
    own = Attachment(1, 0, GID).encode()

    def add(offset: int, total: int, size: int, of: bytes = own) -> bool:
        _, piece = split_attachment(of + offset.to_bytes(8, "little") * 2)
        assert piece is not None
        return parts.add(of, piece._replace(total=total), zenoh.ZBytes(bytes(size)))

    assert not add(5, 20, 5)  # without its beginning
    assert not add(0, 21, 5)  # too long
    assert add(0, 12, 5)
    assert parts.offset(1) == 5
    assert parts.offset(2) == 0
    assert not add(5, 12, 5, Attachment(2, 0, GID).encode())
    assert not add(5, 9, 5)  # longer than it says
    assert not add(4, 12, 5)
    assert parts.whole() is None
    assert add(5, 12, 7)
    whole = parts.whole()
    assert isinstance(whole, Recovered)
    assert len(whole.payload) == 12


def test_errands_are_done_by_few_threads_which_end() -> None:
    errands = Errands("errand")
    gate, begun, done = (threading.Semaphore(0) for _ in range(3))

    def work() -> None:
        begun.release()
        assert gate.acquire(timeout=20.0)
        done.release()

    for _ in range(8):
        assert errands.do(work)
        assert begun.acquire(timeout=20.0)
    assert all(errands.do(work) for _ in range(1000))
    assert not errands.do(work)
    assert sum(t.name == "errand" for t in threading.enumerate()) == 8
    gate.release(1008)
    for _ in range(1008):
        assert done.acquire(timeout=20.0)
    errands.close(20.0)
    assert not any(t.name == "errand" for t in threading.enumerate())
    assert not errands.do(work)


def test_the_end_of_errands_waits_for_those_under_way() -> None:
    errands = Errands("errand")
    begun, gate = threading.Event(), threading.Event()
    order: list[str] = []

    def work() -> None:
        begun.set()
        assert gate.wait(20.0)
        order.append("done")

    errands.do(work)
    assert begun.wait(20.0)
    threading.Timer(0.0, gate.set).start()
    errands.close(20.0)
    order.append("closed")
    assert order == ["done", "closed"]
