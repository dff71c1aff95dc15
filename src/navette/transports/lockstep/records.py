"""Messages between processes in lock-step: reports and grants, as JSON.

Any program can send them, so every field is checked and limited.
"""

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Any, NamedTuple, TypeVar

from navette.errors import DecodeError

MAX_BYTES = 2**22
_MAX_ENTRIES = 20_000
_MAX_NAME = 512
_MAX_COUNT = 2**63 - 1
_GID = re.compile(r"[0-9a-f]{32}", re.ASCII)
_SESSION = re.compile(r"[0-9a-f]{1,32}", re.ASCII)

T = TypeVar("T")


class Sent(NamedTuple):
    """What a publisher has sent so far: count and last sequence number.

    ``publisher`` numbers the publishers of a node in the order of their creation.
    """

    node: str
    publisher: int
    total: int
    last: int


@dataclass(frozen=True)
class StepReport:
    """Sent by a process that has no events left in a step.

    Attributes:
        step: number of the step; 0 before the first.
        nodes: full names of its nodes.
        own: how many nodes and endpoints it has announced.
        seen: session → number of its nodes and endpoints that are known here.
        sent: publishers by gid that have sent samples since the last step.
    """

    step: int
    nodes: tuple[str, ...]
    own: int
    seen: Mapping[str, int]
    sent: Mapping[bytes, Sent]

    def encode(self) -> bytes:
        return _encoded(self)


@dataclass(frozen=True)
class StepGrant:
    """Lets time advance to ``until_ns``, once all samples sent before have arrived.

    Attributes:
        coordinator: the session that sends the grant.
        step: number of the step that begins, from 1.
        until_ns: end of the step.
        roster: the sessions that take part.
        sent: all publishers by gid that have sent samples in the previous step.
        is_last: whether the run ends with it.
    """

    coordinator: str
    step: int
    until_ns: int
    roster: tuple[str, ...]
    sent: Mapping[bytes, Sent]
    is_last: bool = False

    def encode(self) -> bytes:
        return _encoded(self)


def parse_report(data: bytes) -> StepReport:
    """Decode a report.

    Raises:
        DecodeError: ``data`` is not a report.
    """
    record = _record(data, StepReport)
    return StepReport(
        step=_count(record["step"], "step"),
        nodes=_list(record["nodes"], "nodes", _name),
        own=_count(record["own"], "own"),
        seen={
            _session(key, "seen"): _count(value, "seen")
            for key, value in _table(record["seen"], "seen").items()
        },
        sent=_sent(record["sent"]),
    )


def parse_grant(data: bytes) -> StepGrant:
    """Decode a grant.

    Raises:
        DecodeError: ``data`` is not a grant.
    """
    record = _record(data, StepGrant)
    if not isinstance(record["is_last"], bool):
        raise DecodeError("is_last: expected true or false")
    return StepGrant(
        coordinator=_session(record["coordinator"], "coordinator"),
        step=_count(record["step"], "step"),
        until_ns=_count(record["until_ns"], "until_ns"),
        roster=_list(record["roster"], "roster", _session),
        sent=_sent(record["sent"]),
        is_last=record["is_last"],
    )


def _encoded(message: StepReport | StepGrant) -> bytes:
    sent = {gid.hex(): list(each) for gid, each in message.sent.items()}
    return json.dumps({**vars(message), "sent": sent}, separators=(",", ":")).encode()


def _record(data: bytes, kind: type) -> dict[str, Any]:
    if len(data) > MAX_BYTES:
        raise DecodeError(f"{len(data)} bytes: longer than {MAX_BYTES}")
    try:
        record = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise DecodeError(f"not JSON: {error}") from error
    names = {field.name for field in fields(kind)}
    if not isinstance(record, dict) or record.keys() != names:
        raise DecodeError(f"expected an object with {', '.join(sorted(names))}")
    return record


def _sent(value: Any) -> dict[bytes, Sent]:
    found: dict[bytes, Sent] = {}
    for key, entry in _table(value, "sent").items():
        if not _GID.fullmatch(key) or not isinstance(entry, list) or len(entry) != 4:
            raise DecodeError("sent: expected gid → node, publisher, total, last")
        node, *counts = entry
        publisher, total, last = (_count(each, "sent") for each in counts)
        found[bytes.fromhex(key)] = Sent(_name(node, "sent"), publisher, total, last)
    return found


def _table(value: Any, field: str) -> dict[str, Any]:
    if not isinstance(value, dict) or len(value) > _MAX_ENTRIES:
        raise DecodeError(f"{field}: expected an object of at most {_MAX_ENTRIES}")
    return value


def _list(value: Any, field: str, item: Callable[[Any, str], T]) -> tuple[T, ...]:
    if not isinstance(value, list) or len(value) > _MAX_ENTRIES:
        raise DecodeError(f"{field}: expected a list of at most {_MAX_ENTRIES}")
    return tuple(item(each, field) for each in value)


def _count(value: Any, field: str) -> int:
    if type(value) is not int or not 0 <= value <= _MAX_COUNT:
        raise DecodeError(f"{field}: {str(value)[:40]!r} is not a count")
    return value


def _name(value: Any, field: str) -> str:
    if not isinstance(value, str) or not 0 < len(value) <= _MAX_NAME:
        raise DecodeError(f"{field}: {str(value)[:40]!r} is not a name")
    return value


def _session(value: Any, field: str) -> str:
    if not isinstance(value, str) or not _SESSION.fullmatch(value):
        raise DecodeError(f"{field}: {str(value)[:40]!r} is not a session id")
    return value
