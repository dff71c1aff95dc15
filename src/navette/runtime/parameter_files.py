"""Reader and writer of ROS 2 parameter files, with limits on size and depth."""

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from navette.errors import FileFormatError, ParameterError
from navette.files.untrusted.budget import DOCUMENT
from navette.files.untrusted.files import read_bounded
from navette.files.untrusted.yaml_input import (
    BoundedLoader,
    line_of,
    load_yaml,
    problem_of,
)
from navette.runtime.strict_mode import is_strict

NodeParameters = list[tuple[str, dict[str, Any]]]
"""(node pattern such as ``/ns/node`` or ``/**``, flat name → value), in file order."""


class RosLoader(BoundedLoader):
    """YAML loader with ROS 2's scalars: ``1e5`` is a double, dates are strings.

    Keys are always text, so that a parameter may be named ``y``. A key that occurs
    again adds to its first mapping: of a file's two blocks for a node, both count.
    """

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        first: dict[str, int] = {}
        pairs: list[tuple[Any, Any]] = []
        for key, value in node.value:
            if isinstance(key, yaml.ScalarNode):
                key.tag = "tag:yaml.org,2002:str"
                at = first.setdefault(key.value, len(pairs))
                if at < len(pairs) and _are_mappings(value, pairs[at][1]):
                    whole = pairs[at][1].value + value.value
                    pairs[at] = key, yaml.MappingNode(value.tag, whole)
                    continue
            pairs.append((key, value))
        node.value = pairs
        return super().construct_mapping(node, deep)


_NODE_PATTERN = re.compile(r"[\w/*]*", re.ASCII)


def _are_mappings(*nodes: yaml.Node) -> bool:
    return all(isinstance(node, yaml.MappingNode) for node in nodes)


RosLoader.yaml_implicit_resolvers = {}
for _tag, _pattern, _starts in (
    ("bool", r"(?:y|Y|yes|Yes|YES|n|N|no|No|NO|[tT]rue|TRUE|[fF]alse|FALSE"
     r"|on|On|ON|off|Off|OFF)\Z", "yYnNtTfFoO"),
    ("int", r"[-+]?(?:0[xX][0-9a-fA-F]+|[0-9]+)\Z", "-+0123456789"),
    ("float", r"(?:[-+]?(?:[0-9]+\.[0-9]*|\.[0-9]+|[0-9]+(?=[eE]))(?:[eE][-+]?[0-9]+)?"
     r"|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN))\Z", "-+0123456789."),
    ("null", r"(?:~|null|Null|NULL|)\Z", ["~", "n", "N", ""]),
):  # fmt: skip
    RosLoader.add_implicit_resolver(
        f"tag:yaml.org,2002:{_tag}", re.compile(_pattern), list(_starts)
    )
RosLoader.add_constructor(
    "tag:yaml.org,2002:bool",
    lambda loader, node: str(node.value).lower() in ("y", "yes", "true", "on"),
)


def _construct_int(loader: RosLoader, node: yaml.ScalarNode) -> int | float | str:
    text = str(node.value)
    return text if node.style else _integer(text)  # text if quoted, as in rcl


RosLoader.add_constructor("tag:yaml.org,2002:int", _construct_int)
RosLoader.add_constructor(
    "tag:yaml.org,2002:float", lambda loader, node: _double(str(node.value))
)


def _integer(text: str) -> int | float:
    """Return a number by the rules of C's strtol, which rcl uses: 010 is octal.

    What does not fit into 64 bits, or is not octal, is a double.
    """
    digits = text.lstrip("+-").lower()
    try:
        base = 16 if digits.startswith("0x") else 8 if digits.startswith("0") else 10
        number = int(text, base)
    except ValueError:
        return float(text)
    return number if -(2**63) <= number < 2**63 else float(number)


def _double(text: str) -> float | str:
    """Return a double; the text if its range is exceeded, as rcl does."""
    named = text.lower().replace(".inf", "inf").replace(".nan", "nan")
    number = float(named)
    return text if math.isinf(number) and "inf" not in named else number


def parse_value(text: str) -> Any:
    """Return the value of ``-p name:=text``, read as YAML; a string if not YAML.

    Raises:
        ParameterError: a YAML mapping or another value that parameters cannot have.
    """
    try:
        value = load_yaml(text, RosLoader)
    except yaml.YAMLError:
        return text
    if value is None:
        return text
    return _leaf("value", value, "command line")


def read_parameter_file(path: Path | str) -> NodeParameters:
    """Read a file of the form ``node: ros__parameters: …``.

    Nested names are joined with dots.

    Raises:
        FileFormatError: the file is not readable, not YAML, or has another form; names
            the line.
        ParameterError: a value has a type that parameters cannot have.
    """
    path = Path(path)
    try:
        text = read_bounded(path, DOCUMENT).decode("utf-8")
    except UnicodeDecodeError as error:
        raise FileFormatError(path, f"cannot be read: {error}") from error
    return parse_parameters(text, path)


def parse_parameters(text: str, origin: Path | str = "parameters") -> NodeParameters:
    """Read parameters from a text as :func:`read_parameter_file` does from a file."""
    try:
        document = load_yaml(text, RosLoader)
    except yaml.YAMLError as error:
        reason = f"not YAML: {problem_of(error)}"
        raise FileFormatError(origin, reason, line_of(error)) from error
    if document is None:  # an empty file, or comments only
        return []
    if not isinstance(document, dict):
        raise FileFormatError(origin, "expected 'node_name: ros__parameters: …'")
    reader = _Reader(str(origin))
    reader.nodes("", document)
    return reader.found


class _Reader:
    """Traversal of the nested mappings, whose depth and size the loader limits."""

    def __init__(self, origin: str) -> None:
        self.found: NodeParameters = []
        self._origin = origin

    def nodes(self, prefix: str, mapping: dict[Any, Any]) -> None:
        """Read namespaces and node names down to ``ros__parameters``."""
        for key, value in mapping.items():
            if key == "ros__parameters":
                values: dict[str, Any] = {}
                self._parameters("", value, values)
                self.found.append((prefix or "/", values))
                continue
            pattern = f"{prefix}/{str(key).strip('/')}"
            if not _NODE_PATTERN.fullmatch(pattern):
                raise FileFormatError(
                    self._origin,
                    f"node name {str(key)!r}: expected letters, digits, _, / and *",
                )
            if not isinstance(value, dict):
                raise FileFormatError(
                    self._origin,
                    f"{pattern}: expected 'ros__parameters:' below a node name, "
                    f"got {value!r}",
                )
            self.nodes(pattern, value)

    def _parameters(self, prefix: str, mapping: Any, values: dict[str, Any]) -> None:
        if mapping is None:
            return
        if not isinstance(mapping, dict):
            raise FileFormatError(
                self._origin,
                f"{prefix or 'ros__parameters'}: expected name: value pairs",
            )
        for key, value in mapping.items():
            name = f"{prefix}{key}"
            if isinstance(value, dict):
                self._parameters(f"{name}.", value, values)
            else:
                values[name] = _leaf(name, value, self._origin)


def _leaf(name: str, value: Any, origin: str) -> Any:
    """Return a scalar or a list of one type; ints among doubles become doubles."""
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, list):
        kinds = {type(item) for item in value}
        if kinds == {int, float} and not is_strict():
            return [float(item) for item in value]
        if len(kinds) <= 1 and kinds <= {bool, int, float, str}:
            return value
    raise ParameterError(
        f"{origin}: parameter {name!r}: {value!r} is not a parameter value; expected "
        "a bool, int, float, string, or a list of one of these"
    )


class _Dumper(yaml.SafeDumper):
    """YAML dumper that quotes text which a reader would not read as text."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


_Dumper.yaml_implicit_resolvers = {
    start: [*_Dumper.yaml_implicit_resolvers.get(start, ()), *own]
    for start, own in {
        **dict.fromkeys(_Dumper.yaml_implicit_resolvers, ()),
        **RosLoader.yaml_implicit_resolvers,
    }.items()
}


def format_parameters(nodes: Mapping[str, Mapping[str, Any]]) -> str:
    """Return the text of a parameter file with the values by node and flat name.

    Dotted names are nested. If a name is both a value and a prefix, the longer name
    stays dotted. Reading the text returns the same values.
    """
    document = {node: {"ros__parameters": _nested(own)} for node, own in nodes.items()}
    text: str = yaml.dump(document, Dumper=_Dumper, allow_unicode=True, width=2**31 - 1)
    return text


def format_value(value: Any) -> str:
    """Return a value as one line of text for :func:`parse_value`."""
    text: str = yaml.dump(
        value,
        Dumper=_Dumper,
        allow_unicode=True,
        width=2**31 - 1,
        default_flow_style=True,
    )
    return text.removesuffix("...\n").rstrip("\n")


def _nested(values: Mapping[str, Any]) -> dict[str, Any]:
    tree: dict[str, Any] = {}
    for name in sorted(values, key=lambda name: (name.count("."), name)):
        *path, last = name.split(".")
        branch, rest = tree, []
        for at, part in enumerate(path):
            below = branch.setdefault(part, {})
            if not isinstance(below, dict):
                rest = path[at:]
                break
            branch = below
        branch[".".join([*rest, last])] = values[name]
    return tree
