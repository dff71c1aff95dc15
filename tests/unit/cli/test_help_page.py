"""The help of a command: names in a column, texts beside them."""

from typing import Annotated

import click
import pytest
from click.testing import CliRunner

from navette.cli.app import app
from navette.cli.commands import AnnotatedCommand
from navette.cli.options import Option

ADDRESS = f"https://example.org/{'x' * 60}"


def drive(
    *,
    rate: Annotated[float, Option("--rate", "-r", metavar="HZ", help="Rate.")] = 1.0,
    wait_matching_subscriptions: Annotated[
        int | None,
        Option("-w", "--wait-matching-subscriptions", metavar="N", help="Wait."),
    ] = None,
    link: Annotated[str | None, Option(help=f"See {ADDRESS}")] = None,
) -> None:
    """Drive."""


def lines_of(command: click.Command, *words: str, columns: int = 80) -> list[str]:
    result = CliRunner(env={"COLUMNS": str(columns)}).invoke(
        command, [*words, "--help"]
    )
    return [line.strip("│╭╮╰╯─ ") for line in result.output.splitlines()]


def test_a_text_is_beside_its_name_or_below_a_long_name() -> None:
    lines = lines_of(AnnotatedCommand("drive", callback=drive))
    assert "--rate, -r HZ  Rate. [default: 1.0]" in lines
    long = lines.index("--wait-matching-subscriptions, -w N")
    assert lines[long + 1] == "Wait."


def test_no_word_of_a_text_is_lost() -> None:
    lines = lines_of(AnnotatedCommand("drive", callback=drive), columns=60)
    assert ADDRESS in "".join(lines)


@pytest.mark.parametrize("columns", [80, 120])
def test_the_options_of_sim_leave_their_texts_more_than_half(columns: int) -> None:
    result = CliRunner(env={"COLUMNS": str(columns)}).invoke(app, ["sim", "--help"])
    lines = result.output.splitlines()
    assert all(len(line) <= columns for line in lines)
    texts = [line[1:] for line in lines if line.startswith("│  ")]
    assert max(len(text) - len(text.lstrip()) for text in texts) < columns / 2
    titles = [line.split()[1] for line in lines if line.startswith("╭")]
    assert titles == ["Arguments", "Options", "Recording", "Bring", "Maps", "Live"]
