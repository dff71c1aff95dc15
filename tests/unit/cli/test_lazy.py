"""Verbs come when they are called: the same ones, said in the same words."""

import subprocess
import sys
from typing import Any

import pytest
import typer
from topic_world import navette
from typer.main import get_group

from navette.cli.app import app
from navette.cli.verbs import VERBS

LOADED = """
import sys
sys.argv = ["navette", *{arguments!r}]
from navette.cli import main
try:
    main()
except SystemExit:
    pass
print([name for name in {modules!r} if name in sys.modules])
"""


def loaded(modules: list[str], *arguments: str) -> str:
    """Which of the modules a command has imported: the last line of its output."""
    code = LOADED.format(arguments=arguments, modules=modules)
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    return done.stdout.splitlines()[-1]


def commands() -> dict[str, Any]:
    group: Any = get_group(app)
    return dict(group.commands)


@pytest.mark.parametrize("name", list(VERBS))
def test_the_help_is_that_of_the_command_itself(name: str) -> None:
    command = commands()[name].load()
    assert command.name == name
    assert command.help.split("\n\n")[0] == VERBS[name].help


def test_every_verb_is_listed_and_found() -> None:
    shown = navette("--help").stdout
    for name in VERBS:
        assert name in shown
        assert navette(name, "--help").exit_code == 0
    assert navette("topics", "list").exit_code == 2
    assert "Did you mean 'topic'?" in navette("topics", "list").stderr


def test_a_verb_is_a_verb_with_its_own_settings() -> None:
    assert navette("run").exit_code == 2
    shown = navette("topic", "--help").stdout
    assert "--install-completion" not in shown
    assert "echo" in shown


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("--help",), "[]"),
        (("topic", "list", "--help"), "['navette.cli.topic']"),
    ],
)
def test_only_what_is_needed_is_imported(
    arguments: tuple[str, ...], expected: str
) -> None:
    modules = ["numpy", "zenoh", "pydantic", "navette.runtime", "navette.cli.topic",
               "navette.cli.bag"]  # fmt: skip
    assert loaded(modules, *arguments) == expected


def test_plain_words_need_no_schemas(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NAVETTE_TRANSPORT", "inprocess")
    heavy = ["pydantic", "numba", "mujoco", "mcap", "websockets", "rich"]
    assert loaded(heavy, "topic", "list", "-t") == "[]"
    assert loaded(heavy, "topic", "echo", "/nothing", "--field", "x", "--once",
                  "nonsense") == "[]"  # fmt: skip


def test_numbers_are_still_checked() -> None:
    for arguments in (["-n", "0"], ["-n", "two"], ["--timeout", "-1"]):
        shown = navette("topic", "echo", "/chatter", *arguments)
        assert shown.exit_code == 2
        assert "Invalid value" in shown.stderr


def test_defaults_lists_and_numbers_arrive_as_declared() -> None:
    seen: dict[str, Any] = {}

    def verb(
        words: list[str],
        number: int = typer.Option(3),
        ratio: float = typer.Option(0.5),
        text: str = typer.Option("none"),
        many: list[int] = typer.Option([]),  # noqa: B008 - Typer's way
    ) -> None:
        seen.update(words=words, number=number, ratio=ratio, text=text, many=many)

    from typer.testing import CliRunner

    from navette.cli.lazy import Later, lazy_group

    group = lazy_group({"verb": Later("", lambda app: app.command()(verb))})
    outer = typer.Typer(cls=group)
    outer.callback()(lambda: None)
    runner = CliRunner()
    assert runner.invoke(outer, ["verb", "a", "b"]).exit_code == 0
    assert seen == {
        "words": ["a", "b"], "number": 3, "ratio": 0.5, "text": "none", "many": []
    }  # fmt: skip
    line = ["verb", "a", "--number", "4", "--ratio", "2", "--text", "5", "--many", "6"]
    assert runner.invoke(outer, line).exit_code == 0
    assert seen == {
        "words": ["a"], "number": 4, "ratio": 2.0, "text": "5", "many": [6]
    }  # fmt: skip


def test_help_does_not_say_that_a_flag_takes_a_value() -> None:
    for words in (["topic", "echo", "--help"], ["--help"]):
        assert "<bool>" not in navette(*words).stdout
