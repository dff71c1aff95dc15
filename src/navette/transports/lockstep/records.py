"""What the processes in lock-step tell each other: reports and grants, as JSON.

What arrives may be anybody's: it is checked field by field and bounded.
"""

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

from navette.errors import DecodeError

MOST_BYTES = 2**22
_MOST_ENTRIES = 20_000
_LONGEST_NAME = 512
_MOST = 2**63 - 1
_GID = re.compile(r"[0-9a-f]{32}", re.ASCII)
_SESSION = re.compile(r"[0-9a-f]{1,32}", re.ASCII)

T = TypeVar("T")


class Sent(NamedTuple):
    """What a publisher has put on the network so far.

    ``publisher`` tells a node's publishers apart, in the order of their making.
    """

    node: str
    publisher: int
    total: int
    last: int


@dataclass(frozen=True)
class Report:
    """A process has nothing left to do until the end of a step.

    Attributes:
        step: which; 0 before the first.
        nodes: full names of its nodes.
        own: how many nodes and endpoints it has announced.
        seen: session → how many nodes and endpoints of it are known here.
        sent: publishers, by gid, that sent something since the last step.
    """

    step: int
    nodes: tuple[str, ...]
    own: int
    seen: Mapping[str, int]
    sent: Mapping[bytes, Sent]

    def encode(self) -> bytes:
        record = {
            "step": self.step,
            "nodes": self.nodes,
            "own": self.own,
            "seen": dict(self.seen),
            "sent": _packed(self.sent),
        }
        return json.dumps(record, separators=(",", ":")).encode()


@dataclass(frozen=True)
class Grant:
    """Time may go on until ``until_ns``, once all that was sent has arrived.

    Attributes:
        conductor: the session that says so.
        step: which one begins, from 1.
        until_ns: the end of it.
        roster: the sessions that take part.
        sent: all publishers, by gid, that sent something in the step before.
        is_last: there will be no other.
    """

    conductor: str
    step: int
    until_ns: int
    roster: tuple[str, ...]
    sent: Mapping[bytes, Sent]
    is_last: bool = False

    def encode(self) -> bytes:
        record = {
            "conductor": self.conductor,
            "step": self.step,
            "until_ns": self.until_ns,
            "roster": self.roster,
            "sent": _packed(self.sent),
            "is_last": self.is_last,
        }
        return json.dumps(record, separators=(",", ":")).encode()


def parse_report(data: bytes) -> Report:
    """The inverse of :meth:`Report.encode`.

    Raises:
        DecodeError: says what is wrong.
    """
    record = _record(data, {"step", "nodes", "own", "seen", "sent"})
    return Report(
        step=_count(record["step"], "step"),
        nodes=_list(record["nodes"], "nodes", _name),
        own=_count(record["own"], "own"),
        seen={
            _session(key, "seen"): _count(value, "seen")
            for key, value in _table(record["seen"], "seen").items()
        },
        sent=_sent(record["sent"]),
    )


def parse_grant(data: bytes) -> Grant:
    """The inverse of :meth:`Grant.encode`.

    Raises:
        DecodeError: says what is wrong.
    """
    fields = {"conductor", "step", "until_ns", "roster", "sent", "is_last"}
    record = _record(data, fields)
    if not isinstance(record["is_last"], bool):
        raise DecodeError("is_last is neither true nor false")
    return Grant(
        conductor=_session(record["conductor"], "conductor"),
        step=_count(record["step"], "step"),
        until_ns=_count(record["until_ns"], "until_ns"),
        roster=_list(record["roster"], "roster", _session),
        sent=_sent(record["sent"]),
        is_last=record["is_last"],
    )


def _packed(sent: Mapping[bytes, Sent]) -> dict[str, list[Any]]:
    return {gid.hex(): list(each) for gid, each in sent.items()}


def _record(data: bytes, fields: set[str]) -> dict[str, Any]:
    if len(data) > MOST_BYTES:
        raise DecodeError(f"{len(data)} bytes: longer than {MOST_BYTES}")
    try:
        record = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise DecodeError(f"no JSON: {error}") from error
    if not isinstance(record, dict) or record.keys() != fields:
        raise DecodeError(f"wanted an object of {', '.join(sorted(fields))}")
    return record


def _sent(value: Any) -> dict[bytes, Sent]:
    found: dict[bytes, Sent] = {}
    for key, entry in _table(value, "sent").items():
        if not _GID.fullmatch(key) or not isinstance(entry, list) or len(entry) != 4:
            raise DecodeError("sent: wanted gid → node, publisher, total, last")
        node, *counts = entry
        publisher, total, last = (_count(each, "sent") for each in counts)
        found[bytes.fromhex(key)] = Sent(_name(node, "sent"), publisher, total, last)
    return found


def _table(value: Any, field: str) -> dict[str, Any]:
    if not isinstance(value, dict) or len(value) > _MOST_ENTRIES:
        raise DecodeError(f"{field}: wanted an object of at most {_MOST_ENTRIES}")
    return value


def _list(value: Any, field: str, item: Callable[[Any, str], T]) -> tuple[T, ...]:
    if not isinstance(value, list) or len(value) > _MOST_ENTRIES:
        raise DecodeError(f"{field}: wanted a list of at most {_MOST_ENTRIES}")
    return tuple(item(each, field) for each in value)


def _count(value: Any, field: str) -> int:
    if type(value) is not int or not 0 <= value <= _MOST:
        raise DecodeError(f"{field}: {str(value)[:40]!r} is no count")
    return value


def _name(value: Any, field: str) -> str:
    if not isinstance(value, str) or not 0 < len(value) <= _LONGEST_NAME:
        raise DecodeError(f"{field}: {str(value)[:40]!r} is no name")
    return value


def _session(value: Any, field: str) -> str:
    if not isinstance(value, str) or not _SESSION.fullmatch(value):
        raise DecodeError(f"{field}: {str(value)[:40]!r} is no session")
    return value
