import math

import pytest

from navette.cli.arguments import (
    fill_values,
    join_pairs,
    parse_goal,
    parse_speed,
    split_run,
    without_daemon,
)
from navette.errors import InvalidValueError


def test_each_goal_becomes_one_word() -> None:
    typed = "world.sdf --goal -13.2 4 --headless --goal 1 2 --start 1 2 90".split()
    assert join_pairs(typed) == [
        "world.sdf",
        "--goal",
        "-13.2 4",
        "--headless",
        "--goal",
        "1 2",
        "--start",
        "1",
        "2",
        "90",
    ]


def test_options_of_the_daemon_are_removed() -> None:
    typed = "topic list --no-daemon -t --spin-time 2 --spin-time=3 -v".split()
    assert without_daemon(typed) == ["topic", "list", "-t", "-v"]
    typed = ["--domain-id", "3", "node", "list", "--no-daemon"]
    assert without_daemon(typed) == typed[:-1]
    typed = "param get /n p --include-hidden-nodes --hide-type".split()
    assert without_daemon(typed) == "param get /n p --hide-type".split()
    typed = "param list --include-hidden-nodes".split()
    assert without_daemon(typed) == typed
    others = ["launch", "x", "--no-daemon"]
    assert without_daemon(others) == others
    assert without_daemon([]) == []


def test_a_goal_already_joined_stays() -> None:
    assert join_pairs(["--goal", "1,2", "--headless"]) == [
        "--goal",
        "1,2",
        "--headless",
    ]


@pytest.mark.parametrize("text", ["-13.2 4", "-13.2,4", " -13.2 , 4.0 "])
def test_goals_in_either_spelling(text: str) -> None:
    assert parse_goal(text) == (-13.2, 4.0)


def test_a_goal_behind_an_equals_sign() -> None:
    for typed in (["--goal=3", "-2", "--json"], ["--goal=3 -2", "--json"]):
        assert join_pairs(typed) == ["--goal", "3 -2", "--json"]


@pytest.mark.parametrize(
    "text", ["1", "1 2 3", "here there", "", "nan 2", "1 inf", "1 -inf"]
)
def test_a_malformed_goal_shows_how_to_write_one(text: str) -> None:
    with pytest.raises(InvalidValueError, match="--goal 6 -12"):
        parse_goal(text)


def test_speeds() -> None:
    assert parse_speed("max") == math.inf
    assert parse_speed("2.5") == 2.5


@pytest.mark.parametrize("text", ["0", "-1", "nan", "fast", "inf"])
def test_the_error_of_a_malformed_speed_lists_what_is_allowed(text: str) -> None:
    with pytest.raises(InvalidValueError, match="max"):
        parse_speed(text)


def test_no_words_at_all() -> None:
    assert fill_values(join_pairs([])) == []


def test_the_run_is_chosen_before_or_after_the_verb() -> None:
    rest = ["topic", "echo", "/map", "--once"]
    for typed in (
        "--run demo topic echo /map --once",
        "topic echo --run demo /map --once",
        "topic echo /map --once --run demo",
    ):
        assert split_run(typed.split()) == (["--run", "demo"], rest)
    assert split_run([*rest, "--run=demo"]) == (["--run=demo"], rest)
    assert split_run(rest) == ([], rest)
    with pytest.raises(InvalidValueError, match="navette ps lists the runs"):
        split_run(["topic", "list", "--run"])


def test_the_arguments_of_a_program_are_its_own() -> None:
    typed = "run --navette --path lib --run demo drive.py --run fast".split()
    program = "run --navette --path lib drive.py --run fast".split()
    assert split_run(typed) == (["--run", "demo"], program)
    typed = "--domain-id 3 run drive.py --run=fast".split()
    assert split_run(typed) == ([], typed)
    typed = "topic pub /x std_msgs/msg/String -- --run x".split()
    assert split_run(typed) == ([], typed)
