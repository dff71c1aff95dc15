"""The tutorials run as printed; the reference pages match the code."""

import contextlib
import dataclasses
import io
import re
import runpy
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

import navette
from navette.cli.app import app
from navette.navigation.control.states import ControlState
from navette.navigation.missions.sequence import (
    FAILURES,
    REACHED,
    SKIPPED,
    TIMED_OUT,
    UNFINISHED,
)
from navette.navigation.planning.outcome import Outcome
from navette.navigation.planning.reports import Phase, State
from navette.navigation.stack.stage_classes import node_classes

DOCS = Path(__file__).parent.parent / "docs"
BLOCK = re.compile(r"```(python|text)\n(.*?)```", re.DOTALL)


@pytest.mark.slow
@pytest.mark.parametrize(
    "page", sorted(DOCS.glob("tutorials/*.md")), ids=lambda page: page.stem
)
def test_tutorial_output_matches_the_page(page: Path) -> None:
    names: dict[str, object] = {"__name__": "__tutorial__"}
    printed = ""
    for language, block in BLOCK.findall(page.read_text(encoding="utf-8")):
        if language == "python":
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(compile(block, str(page), "exec"), names)
            printed = output.getvalue()
        else:
            assert printed == block


def test_the_node_reference_is_up_to_date() -> None:
    generator = runpy.run_path(str(DOCS / "generate.py"))
    page = (DOCS / "reference" / "nodes.md").read_text(encoding="utf-8")
    assert page == generator["nodes_page"](), "run: python docs/generate.py"


def test_every_status_has_a_section() -> None:
    page = (DOCS / "reference" / "troubleshooting.md").read_text(encoding="utf-8")
    sections = re.findall(r"^### `(\w+)`$", page, re.MULTILINE)
    statuses = {*Outcome, *Phase, *State, *ControlState, *FAILURES}
    statuses |= {REACHED, TIMED_OUT, SKIPPED, UNFINISHED}
    assert sorted(sections) == sorted(statuses)
    listed = set(re.findall(r"\(#(\w+)\)", page))
    assert listed <= set(sections)


def test_parameters_in_the_troubleshooting_page_exist() -> None:
    page = (DOCS / "reference" / "troubleshooting.md").read_text(encoding="utf-8")
    known = {
        field.name
        for _, cls in node_classes()
        for field in dataclasses.fields(cls.PARAMS)
    }
    named = set(re.findall(r"`([a-z_]+_(?:m|s|mps|rad|margin|check|frame))\b", page))
    assert named - {"unknown_frame"} <= known


def test_files_and_folders_of_the_design_exist() -> None:
    page = (DOCS / "design.md").read_text(encoding="utf-8")
    table = page[page.index("| question |") : page.index("## Rules")]
    files = set(re.findall(r"`((?:\w+/)+(?:\w+\.py)?)`", table))
    assert len(files) >= 10
    source = DOCS.parent / "src" / "navette"
    assert [path for path in sorted(files) if not (source / path).exists()] == []
    tree = page[page.index("src/navette/") : page.index("The reasons for")]
    named = set(re.findall(r"(\w+)/\s", tree)) - {"navette"}
    folders = {path.name for path in source.rglob("*") if path.is_dir()}
    assert named - folders == set()
    assert {path.name for path in source.iterdir() if path.is_dir()} <= (
        named | {"__pycache__"}
    )


@pytest.mark.parametrize(
    "script", ["picture.py", "gallery.py", "map_picture.py", "screenshot.py"]
)
def test_scripts_that_make_pictures_load(
    script: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(DOCS)
    assert runpy.run_path(str(DOCS / script), run_name="loaded")


def test_names_in_the_idioms_page_exist() -> None:
    page = (DOCS / "reference" / "idioms.md").read_text(encoding="utf-8")
    names = set(re.findall(r"navette\.([A-Za-z_]+)", page)) - {"msgs"}
    assert len(names) > 15
    assert [name for name in sorted(names) if not _is_there(name)] == []
    verbs = {tuple(words.split()) for words in re.findall(r"`navette ([a-z_ ]+)", page)}
    assert [verb for verb in sorted(verbs) if not _is_command(app, verb)] == []


def _is_there(name: str) -> bool:
    """Whether Navette has that name or a module of that name."""
    return hasattr(navette, name) or find_spec(f"navette.{name}") is not None


def _is_command(root: Any, verb: tuple[str, ...]) -> bool:
    """Whether the words lead to a command; further words are its arguments."""
    command = root
    for word in verb:
        if not hasattr(command, "commands"):
            return True
        if word not in command.commands:
            return False
        command = command.commands[word]
        command = command.load() if hasattr(command, "load") else command
    return not hasattr(command, "commands")
