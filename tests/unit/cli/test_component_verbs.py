"""``navette component``: texts as of ros2 component."""

import json
import sys
from collections.abc import Iterator
from types import ModuleType

import pytest
from verb_world import World, world

from navette.ros2.launch.components import ComponentManager
from navette.runtime import Context, Node


class Lamp(Node):
    """Something to load."""

    def __init__(self, *, context: Context) -> None:
        super().__init__("lamp", context=context)
        self.declare_parameter("watts", 40.0)


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> Iterator[World]:
    lamps = ModuleType("lamps")
    lamps.Lamp = Lamp  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "lamps", lamps)
    with world() as here:
        for name in ("box", "shelf"):
            node = here.graph.add(Node(name, context=here.context))
            ComponentManager(node, here.graph.executor)
        here.graph.add(Node("plain", context=here.context))
        yield here


def test_load_list_unload(here: World) -> None:
    load = ("component", "load", "/box", "lamps", "lamps::Lamp")
    assert here.read(*load, "-n", "left", "-p", "watts:=60") == (
        "Loaded component 1 into '/box' container node as '/left'\n"
    )
    assert here.read("param", "get", "left", "watts") == "Double value is: 60.0\n"
    assert here.read(*load, "--node-namespace", "/hall", "-q") == "2  /hall/lamp\n"
    assert (
        here.read("component", "list") == "/box\n  1  /left\n  2  /hall/lamp\n/shelf\n"
    )
    assert here.read("component", "list", "box") == "1  /left\n2  /hall/lamp\n"
    assert here.read("component", "list", "--containers-only") == "/box\n/shelf\n"
    as_json = json.loads(here.read("component", "list", "--json"))
    assert as_json == {"/box": {"1": "/left", "2": "/hall/lamp"}, "/shelf": {}}
    assert here.read("component", "unload", "/box", "1", "2") == (
        "Unloaded component 1 from '/box' container node\n"
        "Unloaded component 2 from '/box' container node\n"
    )
    assert here.read("component", "list", "box") == ""


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["load", "/box", "lamps", "lamps::Lump"], "'Lump'"),
        (["unload", "/box", "7"], "Failed to unload component 7 from '/box'"),
        (["list", "plain"], "node /plain is not a container; containers: /box, /shelf"),
        (["list", "bax"], "no node /bax; did you mean /box?"),
    ],
)
def test_failures(here: World, words: list[str], reason: str) -> None:
    done = here.run("component", *words)
    assert (done.out, done.code) == ("", 1)
    assert reason in done.err


@pytest.mark.parametrize("option", [["-p", "watts"], ["--log-level", "loud"]])
def test_wrong_words(here: World, option: list[str]) -> None:
    done = here.run("component", "load", "/box", "lamps", "lamps::Lamp", *option)
    assert done.code == 2
    assert option[-1] in done.err
