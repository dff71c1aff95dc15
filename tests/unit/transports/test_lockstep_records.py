"""Reports and grants on the wire; invalid ones are refused."""

import json
from typing import Any

import pytest

from navette.errors import DecodeError
from navette.transports.lockstep import (
    Sent,
    StepGrant,
    StepReport,
    parse_grant,
    parse_report,
)

GID = bytes(range(16))
REPORT = StepReport(3, ("/a", "/b/c"), 17, {"abc1": 4}, {GID: Sent("/a", 1, 2, 9)})
GRANT = StepGrant("abc1", 4, 40_000_000, ("f0", "f1"), {GID: Sent("/a", 1, 2, 9)})


def test_reports_and_grants_survive_encoding() -> None:
    assert parse_report(REPORT.encode()) == REPORT
    assert parse_grant(GRANT.encode()) == GRANT


REPORT_INVALID: dict[str, Any] = {
    "step": [-1, True, 1.0, "1", None, 2**63],
    "nodes": ["/a", [1], [""], ["x" * 513], {}],
    "own": [None, -2],
    "seen": [[], {"XYZ": 1}, {"abc": -1}, {"a" * 33: 1}],
    "sent": [
        [],
        {"00": ["/a", 1, 1, 1]},
        {GID.hex(): ["/a", 1, 1]},
        {GID.hex(): ["/a", 1, 1, -1]},
        {GID.hex(): [7, 1, 1, 1]},
    ],
}


@pytest.mark.parametrize(
    ("field", "value"), [(f, v) for f, values in REPORT_INVALID.items() for v in values]
)
def test_a_report_with_an_invalid_field_is_refused(field: str, value: Any) -> None:
    record = json.loads(REPORT.encode()) | {field: value}
    with pytest.raises(DecodeError, match=field):
        parse_report(json.dumps(record).encode())


@pytest.mark.parametrize(
    ("field", "value"),
    [("is_last", 0), ("coordinator", "no!"), ("roster", "ab"), ("until_ns", -1)],
)
def test_a_grant_with_an_invalid_field_is_refused(field: str, value: Any) -> None:
    record = json.loads(GRANT.encode()) | {field: value}
    with pytest.raises(DecodeError, match=field):
        parse_grant(json.dumps(record).encode())


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff\xfe",
        b"[]",
        b"{}",
        b"[" * 100_000,
        b'{"step": 1}',
        b" " * (2**22 + 1),
        json.dumps(json.loads(REPORT.encode()) | {"more": 1}).encode(),
    ],
)
def test_invalid_records_are_refused(data: bytes) -> None:
    with pytest.raises(DecodeError):
        parse_report(data)
    with pytest.raises(DecodeError):
        parse_grant(data)
