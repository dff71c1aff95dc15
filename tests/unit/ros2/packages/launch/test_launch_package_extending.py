"""Tags and substitutions of other packages, by ROS 2's interface."""

import io
from collections.abc import Iterator
from typing import Any

import pytest

from navette.ros2.packages.launch import LaunchContext
from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.conditions import IfCondition
from navette.ros2.packages.launch.frontend import (
    SUBSTITUTIONS,
    Entity,
    Parser,
    expose_action,
    expose_substitution,
)
from navette.ros2.packages.launch.frontend.attribute_types import converted
from navette.ros2.packages.launch.frontend.parser import ACTIONS
from navette.ros2.packages.launch.substitution import TextSubstitution


class Greet(Action):
    """A custom action as packages of ROS 2 write it."""

    def __init__(self, *, words: Any, times: int, to: list[str], **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.words, self.times, self.to = words, times, to

    @classmethod
    def parse(cls, entity: Any, parser: Any) -> tuple[type[Action], dict[str, Any]]:
        _, kwargs = super().parse(entity, parser)
        kwargs["words"] = parser.parse_substitution(entity.get_attr("words"))
        kwargs["times"] = entity.get_attr("times", data_type=int, optional=True) or 1
        people = entity.get_attr("person", data_type=list[Entity], optional=True) or []
        kwargs["to"] = [person.get_attr("name") for person in people]
        return cls, kwargs


def entities(text: str) -> list[Any]:
    root, parser = Parser.load(io.StringIO(text))
    return list(parser.parse_description(root).entities)


def upper(data: list[Any]) -> tuple[type, dict[str, Any]]:
    return TextSubstitution, {"text": data[0].perform(LaunchContext()).upper()}


@pytest.fixture
def tables() -> Iterator[None]:
    entities('<launch><log message=""/></launch>')  # imports Navette's own tags, once
    before = dict(ACTIONS), dict(SUBSTITUTIONS)
    yield
    for table, kept in zip((ACTIONS, SUBSTITUTIONS), before, strict=True):
        table.clear()
        table.update(kept)  # type: ignore[arg-type]


XML = """<launch>
  <greet words="hello $(upper you)" times="3" if="true">
    <person name="Ada"/><person name="Alan"/>
  </greet>
</launch>"""
YAML = """
launch:
  - greet: {words: hello $(upper you), times: 3, person: [{name: Ada}, {name: Alan}]}
"""


@pytest.mark.parametrize("text", [XML, YAML])
def test_a_tag_and_a_substitution_of_a_package(tables: None, text: str) -> None:
    expose_action("greet")(Greet)
    expose_substitution("upper")(upper)
    (greet,) = entities(text)
    assert greet.words.perform(LaunchContext()) == "hello YOU"
    assert (greet.times, greet.to) == (3, ["Ada", "Alan"])
    if text is XML:
        assert isinstance(greet.condition, IfCondition)


def test_an_attribute_that_the_tag_does_not_read_is_an_error(tables: None) -> None:
    expose_action("greet")(Greet)
    with pytest.raises(ValueError, match="unknown attribute 'wrods'"):
        entities('<launch><greet words="a" wrods="b"/></launch>')


def test_what_cannot_be_exposed(tables: None) -> None:
    with pytest.raises(RuntimeError, match="class method called 'parse'"):
        expose_substitution("text")(TextSubstitution)
    with pytest.raises(RuntimeError, match="not a callable"):
        expose_action("five")(5)
    expose_action("greeting")(Greet)
    expose_action("greeting")(Greet)
    with pytest.raises(RuntimeError, match="same name: \\[greeting\\]"):
        expose_action("greeting")(lambda entity, parser: (Greet, {}))


@pytest.mark.parametrize(
    ("value", "kind", "expected"),
    [
        ("4", int, 4),
        ("4", str, "4"),
        ("1", bool, True),
        ("$(var x)", int, "$(var x)"),
        ("[1, 2]", list[int], [1, 2]),
        (["1.5", "2"], list[float], [1.5, 2.0]),
        ("[a, b]", None, ["a", "b"]),
        (3, float, 3.0),
    ],
)
def test_types_of_attributes(value: Any, kind: Any, expected: Any) -> None:
    assert converted(value, kind, can_be_str=True) == expected


@pytest.mark.parametrize(
    ("value", "kind"), [("a", int), ("1.5", int), ("x", bool), ("1", list[int])]
)
def test_other_types_are_errors(value: Any, kind: Any) -> None:
    with pytest.raises(TypeError, match="cannot be converted"):
        converted(value, kind, can_be_str=False)
    with pytest.raises(ValueError, match="Unrecognized data type"):
        converted(value, bytes, can_be_str=False)
