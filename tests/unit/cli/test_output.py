"""What verbs print: strict JSON, harmless texts, columns that fit the terminal."""

import json
import math
from typing import Any

import click
import pytest

from navette.cli.output import beside, hanging, json_text, styled
from navette.cli.session import fail
from navette.cli.stderr import note
from navette.cli.topic.echo_options import Style
from navette.cli.topic.printing import text_of
from navette.files.untrusted.escaping import escaped
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.msgs.std_msgs.msg import String


def strict(text: str) -> Any:
    def refuse(constant: str) -> None:
        pytest.fail(f"{constant} is not JSON")

    return json.loads(text, parse_constant=refuse)


def test_numbers_that_json_has_not_are_null() -> None:
    scan = LaserScan(ranges=[1.5, math.inf, math.nan], angle_min=-math.inf)
    read = strict(text_of(scan, (), Style(as_json=True)))
    assert read["ranges"] == [1.5, None, None]
    assert read["angle_min"] is None
    assert strict(json_text({"a": (math.nan, [2])}, indent=2)) == {"a": [None, [2]]}


HOSTILE = "\x1b[2J\x9b31m\x07\u202eabc\u2028\r"


def test_received_control_characters_are_escaped_on_a_terminal(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert escaped("a\tb\n" + HOSTILE) == (
        "a\tb\n\\x1b[2J\\x9b31m\\x07\\u202eabc\\u2028\\x0d"
    )
    for module in ("output", "message_yaml"):
        monkeypatch.setattr(f"navette.cli.{module}.is_terminal", lambda: True)
    monkeypatch.setenv("NO_COLOR", "1")
    message = String(data=HOSTILE)
    for style in (Style(), Style(csv=True), Style(as_json=True)):
        shown = text_of(message, (), style)
        assert not set(shown) & set(HOSTILE.replace("a", "")) - set("[2J31mabc"), style
    note(HOSTILE)
    with pytest.raises(click.exceptions.Exit):
        fail(HOSTILE)
    assert not set(capsys.readouterr().err) & set("\x1b\x9b\x07\u202e\u2028\r")


def test_bidirectional_controls_are_escaped_in_yaml_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    message = String(data="\u202eabc")
    assert text_of(message, (), Style()) == "data: \u202eabc\n---"
    for module in ("output", "message_yaml"):
        monkeypatch.setattr(f"navette.cli.{module}.is_terminal", lambda: True)
    monkeypatch.setenv("NO_COLOR", "1")
    assert text_of(message, (), Style()) == "data: \\u202eabc\n---"


def test_json_in_a_pipe_is_the_same_value() -> None:
    message = String(data=HOSTILE)
    assert strict(text_of(message, (), Style(as_json=True))) == {"data": HOSTILE}


def test_rows_of_numbers_end_between_two_of_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for module in ("output", "message_yaml"):
        monkeypatch.setattr(f"navette.cli.{module}.is_terminal", lambda: True)
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "30")
    scan = LaserScan(ranges=[float(i) for i in range(9)])
    text = text_of(scan, (), Style())
    assert text.splitlines()[-5:] == [
        "ranges: [0.0, 1.0, 2.0, 3.0,",
        "         4.0, 5.0, 6.0, 7.0,",
        "         8.0]",
        "intensities: []",
        "---",
    ]


def test_long_text_is_printed_below_the_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("COLUMNS", "24")
    rows = [("/a", "pkg/msg/A"), ("/long_name", "pkg/msg/Longer"), ("/b", "")]
    assert beside(rows) == [
        "/a          pkg/msg/A",
        "/long_name\n    pkg/msg/Longer",
        "/b",
    ]


def test_a_dumb_terminal_gets_no_colours(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("navette.cli.output.is_terminal", lambda: True)
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    assert styled("a", bold=True) == "\x1b[1ma\x1b[0m"
    monkeypatch.setenv("TERM", "dumb")
    assert styled("a", bold=True) == "a"


def test_lines_are_wrapped_at_words_on_a_terminal_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("COLUMNS", "30")
    lines = "lost seconds  turning in place 1.20, final 0.30\nCPU  control 3 %\n"
    assert hanging(lines, 14) == lines
    monkeypatch.setattr("navette.cli.output.is_terminal", lambda: True)
    assert hanging(lines, 14) == (
        "lost seconds  turning in place\n"
        "              1.20, final 0.30\n"
        "CPU  control 3 %\n"
    )
