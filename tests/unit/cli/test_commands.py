"""Verbs are imported when they are called; the list has the texts of the verbs."""

import re
import subprocess
import sys

import pytest
from topic_world import navette

from navette.cli.commands import LazyCommand
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


@pytest.mark.parametrize("verb", VERBS, ids=lambda verb: verb.name)
def test_the_list_has_the_first_line_of_the_verbs_help(verb: LazyCommand) -> None:
    command = verb.load()
    assert command.name == verb.name
    assert command.help is not None
    assert command.help.split("\n\n")[0] == verb.help


def test_every_verb_is_listed_and_can_be_called() -> None:
    shown = navette("--help").stdout
    for name in (str(verb.name) for verb in VERBS):
        assert name in shown
        assert navette(name, "--help").exit_code == 0
    assert navette("topics", "list").exit_code == 2
    assert "'topic'?" in navette("topics", "list").stderr


def test_the_help_begins_with_what_newcomers_need() -> None:
    shown = navette("--help").stdout
    panels = re.findall(r"─ ([A-Z][a-z ]+) ─", shown)
    assert panels[:2] == ["Options", "Drive"]
    assert len(set(panels)) == len(panels) == 5
    names = re.findall(r"^│ ([a-z]+) ", shown, re.MULTILINE)
    assert names[:3] == ["demo", "sim", "explore"]
    assert names.index("stop") < names.index("run") < names.index("topic")


def test_a_group_lists_its_commands() -> None:
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
    modules = ["numpy", "zenoh", "navette.runtime", "navette.cli.topic",
               "navette.cli.bag"]  # fmt: skip
    assert loaded(modules, *arguments) == expected


def test_verbs_import_no_heavy_modules(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NAVETTE_TRANSPORT", "inprocess")
    heavy = ["numba", "mujoco", "mcap", "websockets", "rich"]
    assert loaded(heavy, "topic", "list", "-t") == "[]"
    assert loaded(heavy, "topic", "echo", "/nothing", "--field", "x", "--once",
                  "nonsense") == "[]"  # fmt: skip


def test_numbers_are_checked() -> None:
    for arguments in (["-n", "0"], ["-n", "two"], ["--timeout", "-1"]):
        shown = navette("topic", "echo", "/chatter", *arguments)
        assert shown.exit_code == 2
        assert "Invalid value" in shown.stderr


@pytest.mark.parametrize("verb", ["up", "restart"])
def test_a_negative_timeout_is_refused(verb: str) -> None:
    refused = navette(verb, "robot", "--timeout", "-1")
    assert refused.exit_code == 2
    assert "-1.0 is not in the range x>=0" in refused.output


def test_flags_have_no_metavar() -> None:
    for words in (["topic", "echo", "--help"], ["--help"]):
        assert "BOOLEAN" not in navette(*words).stdout
