"""Click parameters from annotations: options, arguments, option groups, completion."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import click
from click.testing import CliRunner

from navette.cli.commands import AnnotatedCommand
from navette.cli.options import Argument, Option, click_parameters


@dataclass(frozen=True, kw_only=True)
class Look:
    colour: Annotated[str, Option("--colour", "-c")] = "red"
    bold: Annotated[bool, Option("--bold")] = False


@dataclass(frozen=True, kw_only=True)
class Options:
    name: Annotated[str, Argument()]
    look: Look = field(default_factory=Look)
    times: Annotated[int, Option("--times", min=1)] = 2


def greet(options: Options, *, loud: Annotated[bool, Option()] = False) -> None:
    """Print the options."""
    click.echo(f"{options} {loud}")


def output(*words: str) -> str:
    command = AnnotatedCommand("greet", callback=greet, help=greet.__doc__)
    return CliRunner().invoke(command, list(words)).output.strip()


def test_fields_of_an_option_group_are_options() -> None:
    assert output("anna") == f"{Options(name='anna')} False"
    given = Options(name="eva", times=3, look=Look(colour="blue", bold=True))
    words = ("eva", "--times", "3", "-c", "blue", "--bold", "--loud")
    assert output(*words) == f"{given} True"


def test_an_option_of_a_list_takes_several_words() -> None:
    seen: dict[str, Any] = {}

    def verb(
        files: Annotated[list[str], Argument()],
        remap: Annotated[
            list[str] | None, Option("-m", "--remap", takes_words=True)
        ] = None,
        only: Annotated[list[str] | None, Option("--only")] = None,
    ) -> None:
        seen.update(files=files, remap=remap, only=only)

    command = AnnotatedCommand("verb", callback=verb)
    typed = "a -m b:=c d:=e --only f g --remap h:=i"
    assert CliRunner().invoke(command, typed.split()).exit_code == 0
    expected = {"files": ["a", "g"], "remap": ["b:=c", "d:=e", "h:=i"], "only": ["f"]}
    assert seen == expected
    empty = CliRunner().invoke(command, ["a", "--remap"])
    assert "'--remap' requires an argument" in empty.output


def test_a_variable_is_checked_as_the_option_is() -> None:
    def verb(
        domain: Annotated[int, Option("--domain", max=232, variable="DOMAIN")] = 0,
    ) -> None:
        click.echo(domain)

    command = AnnotatedCommand("verb", callback=verb)
    for variable, words, expected in (
        ("7", [], "7\n"),
        ("7", ["--domain", "8"], "8\n"),
        ("", [], "0\n"),
        ("300", [], "(env var: 'DOMAIN'): 300 is not in the range"),
    ):
        done = CliRunner().invoke(command, words, env={"DOMAIN": variable})
        assert expected in done.output


def test_values_are_checked_and_options_are_listed() -> None:
    assert "Missing argument" in output()
    assert "Invalid value for '--times'" in output("anna", "--times", "0")
    shown = output("--help")
    assert "Print the options." in shown
    assert shown.index("--colour") < shown.index("--times") < shown.index("--loud")


def test_values_arrive_with_the_declared_type() -> None:
    seen: dict[str, Any] = {}

    def verb(
        words: Annotated[list[str], Argument()],
        number: Annotated[int, Option()] = 3,
        ratio: Annotated[float, Option()] = 0.5,
        file: Annotated[Path | None, Option()] = None,
        many: Annotated[list[int] | None, Option()] = None,
        pose: Annotated[tuple[float, float] | None, Option()] = None,
    ) -> None:
        seen.update(words=words, number=number, ratio=ratio, file=file, many=many,
                    pose=pose)  # fmt: skip

    command = AnnotatedCommand("verb", callback=verb)
    assert CliRunner().invoke(command, ["a", "b"]).exit_code == 0
    assert seen == {
        "words": ["a", "b"], "number": 3, "ratio": 0.5, "file": None, "many": None,
        "pose": None,
    }  # fmt: skip
    line = "a --number 4 --ratio 2 --file 5 --many 6 --many 7 --pose 1 2.5"
    assert CliRunner().invoke(command, line.split()).exit_code == 0
    assert seen == {
        "words": ["a"], "number": 4, "ratio": 2.0, "file": Path("5"), "many": [6, 7],
        "pose": (1.0, 2.5),
    }  # fmt: skip


def test_the_shell_completes_files_where_no_name_matches() -> None:
    def complete(incomplete: str) -> list[str]:
        return ["arena"] if "arena".startswith(incomplete) else []

    def verb(world: Annotated[str, Argument(complete=complete)]) -> None: ...

    (parameter,) = click_parameters(verb)
    context = click.Context(AnnotatedCommand("verb", callback=verb))

    def completions(word: str) -> list[tuple[str, str]]:
        found = parameter.shell_complete(context, word)
        return [(each.type, each.value) for each in found]

    assert completions("ar") == [("plain", "arena")]
    assert completions("./ma") == [("file", "./ma")]


def test_a_value_can_begin_with_a_dash_and_cannot_be_omitted() -> None:
    def verb(number: Annotated[int, Option()] = 3) -> None:
        click.echo(number)

    command = AnnotatedCommand("verb", callback=verb)
    assert CliRunner().invoke(command, ["--number", "-4"]).output == "-4\n"
    assert "requires an argument" in CliRunner().invoke(command, ["--number"]).stderr
