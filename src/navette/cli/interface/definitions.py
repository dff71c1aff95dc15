"""Definitions of interfaces: from files, from loaded classes, or from running nodes."""

from collections.abc import Iterator
from enum import Enum
from pathlib import Path
from typing import Any

from navette.cli.interface.listing import Kind
from navette.cli.message_types import installed_class, interface_class, near_types
from navette.cli.output import harmless, is_terminal, styled
from navette.cli.peer_definitions import described_by_peers
from navette.cli.session import connect, endpoints, fail, service_endpoints
from navette.errors import InvalidNameError, UnknownNameError
from navette.msgs.definition_sections import read_definition, split_sections
from navette.msgs.definition_text import interface_text
from navette.msgs.parser import parse_message, without_comment
from navette.msgs.registry import full_name
from navette.ros2.packages.rosidl_runtime_py import (
    get_interface_path,
    get_interfaces,
    message_to_yaml,
)

_SEPARATOR = "---"
_INDENT, _INDENT_ON_TERMINAL = "\t", "    "


class Comments(Enum):
    """Which comments are printed."""

    NONE = 0
    OWN = 1  # not those of nested types
    ALL = 2


def definition_lines(name: str, comments: Comments) -> list[str]:
    """Return the lines of a definition, with the fields of nested types indented.

    The command fails if the type is unknown here and to all running nodes.
    """
    name = _full_name(name)
    return list(_Texts(name).lines(name, comments, 0))


def prototype(name: str) -> str:
    """Return a message, request or goal with its defaults as YAML."""
    name = _full_name(name)
    cls = installed_class(name)
    if cls is None:
        with connect() as node:
            of = [*endpoints(node), *service_endpoints(node)]
            cls = interface_class(node, name, of)
    part: Any = getattr(cls, "Goal", getattr(cls, "Request", cls))
    return message_to_yaml(part())


class _Texts:
    """Definitions by name; a peer's definition takes precedence over installed ones."""

    def __init__(self, top: str) -> None:
        self._sent: dict[str, str] = {}
        if self._installed(top) is None:
            self._sent = _sent_by_peers(top)

    def lines(self, name: str, comments: Comments, depth: int) -> Iterator[str]:
        indent = _INDENT_ON_TERMINAL if is_terminal() else _INDENT
        inside = comments if comments is Comments.ALL else Comments.NONE
        for line in self._text(name).splitlines():
            shown = _shown(harmless(line.rstrip()), comments)
            if shown is not None:
                yield f"{indent * depth}{shown}" if shown else ""
            contained = _contained_type(name, line)
            if contained is not None:
                yield from self.lines(contained, inside, depth + 1)

    def _text(self, name: str) -> str:
        sent = self._sent.get(name)
        text = self._installed(name) if sent is None else sent
        assert text is not None, f"{name} is nested in a checked definition"
        return text

    @staticmethod
    def _installed(name: str) -> str | None:
        try:
            return Path(get_interface_path(name)).read_text(encoding="utf-8")
        except UnknownNameError:
            pass
        try:
            return interface_text(name)
        except (UnknownNameError, InvalidNameError):
            return None


def _sent_by_peers(name: str) -> dict[str, str]:
    """Request a definition from running nodes; the command fails if there is none."""
    with connect() as node:
        definition = described_by_peers(
            node, name, [*endpoints(node), *service_endpoints(node)]
        )
    if definition.text is None:
        fail(f"no interface {name}{near_types(name)}")
    read_definition(name, definition.text)  # checks size and recursion
    sections = split_sections(name, definition.text, f"definition of {name}")
    return {full_name(each): text for each, text in sections}


def _full_name(name: str) -> str:
    """Expand ``pkg/Name`` to the message, service or action with that name."""
    package, _, rest = name.partition("/")
    if not rest and (near := near_types(name)):
        fail(f"no interface {name}{near}")
    if "/" in rest:
        return full_name(name)
    try:
        found = get_interfaces([package]).get(package, [])
    except UnknownNameError:
        found = []
    kinds = [kind.value for kind in Kind if f"{kind.value}/{rest}" in found]
    return f"{package}/{kinds[0]}/{rest}" if kinds else full_name(name)


def _shown(line: str, comments: Comments) -> str | None:
    """Return the line to print; None to omit it."""
    bare = without_comment(line)
    if comments is Comments.NONE:
        return bare.strip() or None
    return bare + styled(line[len(bare) :], fg="green", dim=True)


def _contained_type(owner: str, line: str) -> str | None:
    """Return the message type of the field that the line defines, if any."""
    bare = without_comment(line).strip()
    if not bare or bare == _SEPARATOR:
        return None
    for field in parse_message(owner, bare).fields:
        if field.type.is_message:
            return field.type.base
    return None
