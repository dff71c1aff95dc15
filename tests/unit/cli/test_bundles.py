"""Options declared as fields of dataclasses, in one another."""

from dataclasses import dataclass, field
from typing import Annotated

import typer
from typer.testing import CliRunner

from navette.cli.bundles import unbundled


@dataclass(frozen=True, kw_only=True)
class Look:
    colour: Annotated[str, typer.Option("--colour", "-c")] = "red"
    bold: Annotated[bool, typer.Option("--bold")] = False


@dataclass(frozen=True, kw_only=True)
class Options:
    name: Annotated[str, typer.Argument()]
    look: Look = field(default_factory=Look)
    times: Annotated[int, typer.Option("--times", min=1)] = 2


def greet(options: Options, *, loud: Annotated[bool, typer.Option()] = False) -> None:
    """Say hello."""
    typer.echo(f"{options} {loud}")


def said(*words: str) -> str:
    app = typer.Typer(add_completion=False)
    app.command()(unbundled(greet))
    return CliRunner().invoke(app, list(words)).output.strip()


def test_fields_are_options() -> None:
    assert said("anna") == f"{Options(name='anna')} False"
    given = Options(name="eva", times=3, look=Look(colour="blue", bold=True))
    words = ("eva", "--times", "3", "-c", "blue", "--bold", "--loud")
    assert said(*words) == f"{given} True"


def test_typer_checks_and_explains_them() -> None:
    assert "Missing argument" in said()
    assert "Invalid value for '--times'" in said("anna", "--times", "0")
    shown = said("--help")
    assert "Say hello." in shown
    assert shown.index("--colour") < shown.index("--times") < shown.index("--loud")
