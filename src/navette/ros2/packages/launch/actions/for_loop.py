"""Loops: actions that create entities for each of several values."""

from collections.abc import Callable, Iterable
from typing import Any

import yaml

from navette.errors import InvalidValueError
from navette.files.untrusted.yaml_input import load_yaml
from navette.ros2.packages.launch.action import Action
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
    normalize_to_list_of_entities,
)
from navette.ros2.packages.launch.substitution import Parts

_MOST = 10_000


class ForEach(Action):
    """Calls ``function`` with each set of values and visits the returned entities.

    Args:
        input_values: sets of values as text, such as
            ``{name: 'a', id: 1};{name: 'b', id: 2}``; may be empty.
        function: takes the values as keyword arguments, returns entities.
    """

    def __init__(
        self, input_values: Any, *, function: Callable[..., Any], **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self._input_values = Parts.of(input_values)
        self._function = function

    @property
    def input_values(self) -> Any:
        return self._input_values

    @property
    def function(self) -> Callable[..., Any]:
        return self._function

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        text = self._input_values.perform(context)
        found: list[LaunchDescriptionEntity] = []
        for values in _value_sets(text):
            found += normalize_to_list_of_entities(self._function(**values))
        return found


class ForLoop(Action):
    """Calls ``function`` with 0 … ``length`` - 1 and visits the returned entities.

    Args:
        length: number of calls; may be substitutions.
        function: takes ``i``, returns entities.
    """

    def __init__(
        self, length: Any, *, function: Callable[[int], Any], **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        text = str(length) if isinstance(length, int) else length
        self._length = Parts.of(text)
        self._function = function

    @property
    def length(self) -> Any:
        return self._length

    @property
    def function(self) -> Callable[[int], Any]:
        return self._function

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        text = self._length.perform(context)
        if not text.isdigit() or int(text) > _MOST:
            raise InvalidValueError(f"ForLoop: length {text!r}: expected 0 … {_MOST}")
        found: list[LaunchDescriptionEntity] = []
        for i in range(int(text)):
            found += normalize_to_list_of_entities(self._function(i))
        return found


def _value_sets(text: str) -> Iterable[dict[str, Any]]:
    for part in text.split(";") if text.strip() else ():
        if not part.strip():
            continue
        try:
            values = load_yaml(part)
        except yaml.YAMLError as error:
            raise InvalidValueError(f"ForEach: {part!r}: not YAML: {error}") from None
        if not isinstance(values, dict):
            raise InvalidValueError(
                f"ForEach: {part!r}: expected a mapping, as in {{name: a}}"
            )
        yield {str(name): value for name, value in values.items()}
