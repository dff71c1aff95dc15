"""What is printed beside the result: whole words on a terminal, one line in a pipe."""

import sys

import pytest

from navette.cli.stderr import note, print_error

LONG = "no publisher on /odometry/filtered_and_long; did you mean /odom/filtered?"


def test_a_pipe_gets_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    print_error(LONG)
    note("from a peer: \x1b[2J")
    assert capsys.readouterr().err == (f"navette: {LONG}\nfrom a peer: \\x1b[2J\n")


def test_on_a_terminal_lines_end_between_words(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", "40")
    monkeypatch.setenv("NO_COLOR", "1")
    print_error(LONG)
    note("known:\n- one [1]\n- two [2]")
    assert capsys.readouterr().err.splitlines() == [
        "navette: no publisher on",
        "  /odometry/filtered_and_long; did you",
        "  mean /odom/filtered?",
        "known:",
        "- one [1]",
        "- two [2]",
    ]


def test_colours(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    print_error("no")
    assert capsys.readouterr().err == "\x1b[31mnavette: no\x1b[0m\n"
    monkeypatch.setenv("TERM", "dumb")
    print_error("no")
    assert capsys.readouterr().err == "navette: no\n"
