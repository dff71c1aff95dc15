"""What sessions tell each other about their samples, and how they ask for some.

A letter goes to ``@navette/<domain>/<to>/mail/<from>``: a byte that says its kind, then
its entries. An ask goes to ``@navette/<domain>/<to>/recover``; before the end of the
answer the samples come to ``<the topic's key>/recovered/<who asked>``, where the rules
of access for the topic hold. Who is not Navette never hears of any.
"""

import re
import struct
from collections.abc import Iterable
from enum import IntEnum
from typing import NamedTuple

from navette.errors import DecodeError
from navette.transports.zenoh.attachment import SIZE

SPACE = "@navette"
_ZID = re.compile(r"[0-9a-f]{1,32}")
_HEAD = struct.Struct("<16sq")
_GID = struct.Struct("<16s")
_ASK = struct.Struct("<16sqqq")
_PIECE = struct.Struct("<qq")
_END = struct.Struct("<q?q")

MOST_ENTRIES = 2000
_MOST_BYTES = 1 + MOST_ENTRIES * _HEAD.size


class Kind(IntEnum):
    """What a letter says."""

    #: This publisher (the first entry) has come so far, and owes these subscriptions of
    #: yours what comes after their numbers.
    MATCHED = 1
    #: These publishers have come to these numbers.
    HEADS = 2
    #: What do these publishers owe me? The first letter has not come.
    WHERE = 3
    #: These publishers and subscriptions are closed, not lost.
    CLOSED = 4
    #: The session ends, with all that is in it.
    BYE = 5
    #: Have these sessions died? They are not to be seen here; they run where you do.
    SEEN = 6
    #: These sessions have died: the answer.
    DIED = 7
    #: These publishers assert that they are alive, without a sample.
    ALIVE = 8


_WITHOUT_NUMBERS = {Kind.WHERE, Kind.CLOSED, Kind.SEEN, Kind.DIED, Kind.ALIVE}


class Head(NamedTuple):
    """How far a publisher has come."""

    gid: bytes
    number: int


class Letter(NamedTuple):
    """Entries of one kind; where only gids (or sessions) are told the numbers are 0."""

    kind: Kind
    entries: tuple[Head, ...] = ()

    def encode(self) -> bytes:
        if self.kind in _WITHOUT_NUMBERS:
            parts = [_GID.pack(entry.gid) for entry in self.entries]
        else:
            parts = [_HEAD.pack(*entry) for entry in self.entries]
        return b"".join((bytes([self.kind]), *parts))


class Ask(NamedTuple):
    """Samples of a publisher, by number, both ends included.

    Long ones, in pieces, only where ``offset`` is not negative: the ask and its answer
    then give way to what else is on the link. The first sample is sent from there on.
    """

    gid: bytes
    first: int
    last: int
    offset: int = -1
    #: The session that asks.
    by: str = ""

    @property
    def takes_long(self) -> bool:
        return self.offset >= 0

    def encode(self) -> bytes:
        return _ASK.pack(*self[:4]) + self.by.encode()


class End(NamedTuple):
    """The end of an answer: there is nothing more up to the number ``covered``.

    ``is_long``: the next one is there, but long; it may have come in part. ``sent``: so
    many samples and pieces went before.
    """

    covered: int
    is_long: bool = False
    sent: int = 0

    def encode(self) -> bytes:
        return _END.pack(*self)


class Piece(NamedTuple):
    """Where a piece of a long sample begins, and how long all of it is.

    It travels behind the sample's attachment.
    """

    offset: int
    total: int

    def encode(self) -> bytes:
        return _PIECE.pack(*self)


def mail_key(domain_id: int, to: str, sender: str) -> str:
    """Where a letter goes; the mailbox is that of all senders, ``*``."""
    return f"{SPACE}/{domain_id}/{to}/mail/{sender}"


def ask_key(domain_id: int, to: str) -> str:
    """Where that session is asked."""
    return f"{SPACE}/{domain_id}/{to}/recover"


def recovered_key(topic_key: str, to: str) -> str:
    """Where samples go that the session ``to`` has asked for."""
    return f"{topic_key}/recovered/{to}"


def parse_sender(key: str) -> str:
    """Whose letter it is, by its key.

    Raises:
        DecodeError: no session.
    """
    sender = key.rpartition("/")[2]
    if not _ZID.fullmatch(sender):
        raise DecodeError(f"{sender[:100]!r} is no session")
    return sender


def parse_letter(data: bytes) -> Letter:
    """The inverse of :meth:`Letter.encode`.

    Raises:
        DecodeError: it is no letter.
    """
    if not 1 <= len(data) <= _MOST_BYTES:
        raise DecodeError(f"letter of {len(data)} bytes, wanted 1 … {_MOST_BYTES}")
    if data[0] not in {*Kind}:
        raise DecodeError(f"letter of kind {data[0]}, wanted {[*map(int, Kind)]}")
    kind = Kind(data[0])
    layout = _GID if kind in _WITHOUT_NUMBERS else _HEAD
    if (len(data) - 1) % layout.size:
        raise DecodeError(f"{kind.name} of {len(data)} bytes is cut off")
    entries = layout.iter_unpack(data[1:])
    return Letter(kind, tuple(Head(each[0], (*each, 0)[1]) for each in entries))


def parse_ask(data: bytes) -> Ask:
    """The inverse of :meth:`Ask.encode`.

    Raises:
        DecodeError: it is no ask.
    """
    by = data[_ASK.size :].decode(errors="replace")
    if not _ZID.fullmatch(by):
        raise DecodeError(f"ask of {len(data)} bytes, by {by[:100]!r}")
    gid, first, last, offset = _ASK.unpack(data[: _ASK.size])
    return Ask(gid, first, last, offset, by)


def split_attachment(data: bytes) -> tuple[bytes, Piece | None]:
    """The attachment of a sample in an answer, and what piece of it this is."""
    if len(data) != SIZE + _PIECE.size:
        return data, None
    return data[:SIZE], Piece(*_PIECE.unpack(data[SIZE:]))


def parse_end(data: bytes) -> End:
    """The inverse of :meth:`End.encode`.

    Raises:
        DecodeError: it is no end of an answer.
    """
    if len(data) != _END.size:
        raise DecodeError(f"end of an answer of {len(data)} bytes, wanted {_END.size}")
    return End(*_END.unpack(data))


def letters(kind: Kind, entries: Iterable[Head]) -> list[Letter]:
    """As many letters as the entries take."""
    every = tuple(entries)
    step = MOST_ENTRIES
    return [Letter(kind, every[i : i + step]) for i in range(0, len(every), step)]


def sessions_in(letter: Letter) -> list[str]:
    """The sessions that a letter is about."""
    return [entry.gid.hex() for entry in letter.entries]


def about_sessions(kind: Kind, sessions: Iterable[str]) -> list[Letter]:
    """As many letters as they take; each has 32 hex digits."""
    return letters(kind, [Head(bytes.fromhex(session), 0) for session in sessions])
