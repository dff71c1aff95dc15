"""Substitutions that write a changed copy of a file and stand for its path."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from navette.files.untrusted.yaml_input import load_yaml
from navette.ros2.packages.launch.condition import Condition
from navette.ros2.packages.launch.launch_context import LaunchContext
from navette.ros2.packages.launch.substitution import (
    Parts,
    SomeSubstitutionsType,
    Substitution,
)

_Rewrites = Mapping[str, SomeSubstitutionsType]


class _FileSubstitution(Substitution):
    """Base of substitutions that read a file whose path is a substitution, too."""

    def __init__(self, source_file: SomeSubstitutionsType) -> None:
        self.name = Parts.of(source_file)

    def _source(self, context: LaunchContext) -> Path:
        return Path(self.name.perform(context))


class RewrittenYaml(_FileSubstitution):
    """Path of a copy of a parameter file with other values.

    Args:
        source_file: the parameter file.
        param_rewrites: parameter → value. A name such as ``use_sim_time`` stands for
            each parameter of that name; one with dots (``amcl.ros__parameters.x``) for
            that parameter, which is added if the file does not have it.
        root_key: name under which the content is placed, such as a namespace.
        key_rewrites: key → new key.
        convert_types: write numbers as numbers; ``true`` and ``false`` always are.
        value_rewrites: value → new value, of any parameter.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        param_rewrites: _Rewrites,
        root_key: SomeSubstitutionsType | None = None,
        key_rewrites: _Rewrites | None = None,
        convert_types: bool = False,
        value_rewrites: _Rewrites | None = None,
    ) -> None:
        super().__init__(source_file)
        self._params = _parts(param_rewrites)
        self._root_key = Parts.optional(root_key)
        self._keys = _parts(key_rewrites)
        self._convert_types = convert_types
        self._values = _parts(value_rewrites)

    def perform(self, context: LaunchContext) -> str:
        """Write the copy, which exists until the launch ends."""
        params = {
            name: self._converted(text)
            for name, text in _performed(self._params, context).items()
        }
        content = load_yaml(self._source(context).read_bytes()) or {}
        content = _with_values(
            content, params, _performed(self._values, context), path=""
        )
        for name, value in params.items():
            if "ros__parameters" in name.split("."):
                _set(content, name.split("."), value)
        content = _with_keys(content, _performed(self._keys, context))
        root_key = "" if self._root_key is None else self._root_key.perform(context)
        if root_key:
            content = {root_key: content}
        return _write(context, yaml.safe_dump(content), ".yaml")

    def _converted(self, text: str) -> Any:
        if text.lower() in ("true", "false"):
            return text.lower() == "true"
        if not self._convert_types:
            return text
        try:
            return float(text) if "." in text else int(text)
        except ValueError:
            return text


class ReplaceString(_FileSubstitution):
    """Path of a copy of a file in which texts are replaced.

    Args:
        source_file: the file.
        replacements: text → new text.
        condition: if false, the path is that of the file itself.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        replacements: _Rewrites,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(source_file)
        self._replacements = _parts(replacements)
        self.condition = condition

    def perform(self, context: LaunchContext) -> str:
        """Write the copy, which exists until the launch ends."""
        source = self._source(context)
        if self.condition is not None and not self.condition.evaluate(context):
            return str(source)
        text = source.read_text("utf-8")
        for old, new in _performed(self._replacements, context).items():
            text = text.replace(old, new)
        return _write(context, text, source.suffix)


class HasNodeParams(_FileSubstitution):
    """``True`` if a parameter file has a section of a node, else ``False``."""

    def __init__(self, source_file: SomeSubstitutionsType, node_name: str) -> None:
        super().__init__(source_file)
        self._node_name = node_name

    def perform(self, context: LaunchContext) -> str:
        content = load_yaml(self._source(context).read_bytes()) or {}
        return str(self._node_name in content)


def _parts(rewrites: _Rewrites | None) -> dict[str, Parts]:
    return {key: Parts.of(value) for key, value in (rewrites or {}).items()}


def _performed(rewrites: dict[str, Parts], context: LaunchContext) -> dict[str, str]:
    return {key: value.perform(context) for key, value in rewrites.items()}


def _with_values(
    content: Any, params: dict[str, Any], values: dict[str, str], path: str
) -> Any:
    """Return content whose values are replaced by name, path or value."""
    if path in params:
        return params[path]
    if isinstance(content, dict):
        return {
            key: params[key]
            if key in params
            else _with_values(value, params, values, f"{path}.{key}".lstrip("."))
            for key, value in content.items()
        }
    if isinstance(content, list):
        return [
            _with_values(value, params, values, f"{path}.{index}")
            for index, value in enumerate(content)
        ]
    return values.get(content, content) if isinstance(content, str) else content


def _with_keys(content: Any, keys: dict[str, str]) -> Any:
    if not isinstance(content, dict):
        return content
    return {keys.get(key, key): _with_keys(each, keys) for key, each in content.items()}


def _set(content: Any, path: list[str], value: Any) -> None:
    """Set the value at a path, and make what is missing on the way."""
    for key in path[:-1]:
        is_list = isinstance(content, list)
        content = content[int(key)] if is_list else content.setdefault(key, {})
    content[int(path[-1]) if isinstance(content, list) else path[-1]] = value


def _write(context: LaunchContext, text: str, suffix: str) -> str:
    file = context.scratch_folder() / f"{context.unique_name('rewritten')}{suffix}"
    file.write_text(text, "utf-8")
    return str(file)
