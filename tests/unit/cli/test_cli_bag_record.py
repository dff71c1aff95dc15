"""``navette bag record``: which topics are recorded, and that none is lost."""

import re
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from navette.cli.bag import bag
from navette.errors import NavetteError


@pytest.fixture
def recorded(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """The parameters of the recorders that would run."""
    found: list[dict[str, Any]] = []

    def record(path: Path, parameters: dict[str, Any], *, overwrite: bool) -> int:
        found.append(parameters)
        return 0

    monkeypatch.setattr("navette.cli.bag.record._record", record)
    return found


def run(*words: str) -> Result:
    return CliRunner().invoke(bag, ["record", *words, "-o", "nowhere"])


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["bad topic"], "invalid topic name"),
        (["-a", "--regex", "("], r"'\(' is not a regular expression"),
        (["-a", "--topic-types", "nosuch"], "'nosuch': expected 'package/msg/Name'"),
        (["-a", "--exclude-topic-types", "nosuch"], "'nosuch': expected"),
    ],
)
def test_malformed_selections_are_refused(
    recorded: list[dict[str, Any]], words: list[str], reason: str
) -> None:
    refused = run(*words)
    assert isinstance(refused.exception, NavetteError)
    assert re.search(reason, str(refused.exception))
    assert recorded == []


def test_all_overrides_the_rest_with_a_note(recorded: list[dict[str, Any]]) -> None:
    done = run("-a", "--regex", "scan")
    assert "have no effect" in done.stderr
    assert recorded[0]["regex"] == ""
    assert run("--topic-types", "std_msgs/String", "--regex", "scan").stderr == ""
    assert recorded[1]["regex"] == "scan"
    assert recorded[1]["types"] == ["std_msgs/msg/String"]
