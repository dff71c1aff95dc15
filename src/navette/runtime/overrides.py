"""Parameter values from files, launch files and the command line.

Of several values for one parameter the last one counts.
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from navette.errors import ParameterError, instead_of, similar_names
from navette.runtime.arguments import ParameterArgument


class Override(NamedTuple):
    """A value for a parameter of a node, and its origin."""

    value: Any
    origin: str
    is_for_all: bool = False  # given for "/**": nodes without the parameter ignore it


class ParameterOwner(Protocol):
    """The part of a node that :meth:`ParameterOverrides.check` needs."""

    def get_fully_qualified_name(self) -> str: ...
    def _node_known_parameters(self) -> list[str] | None:
        """Return the declared names; None if the node accepts any."""


@dataclass
class OverrideSet:
    """Values from one origin for the nodes that match a pattern.

    With ``by_base_name`` (``-p node:name:=value``) the pattern is a name without
    namespace, otherwise a full name, in which ``*`` stands for one part and ``**`` for
    any number of parts.
    """

    pattern: str
    values: dict[str, Any]
    origin: str
    by_base_name: bool = False
    seen_nodes: set[str] = field(default_factory=set)

    def matches(self, full_name: str) -> bool:
        if self.by_base_name:
            return full_name.rpartition("/")[2] == self.pattern
        return bool(_regex(self.pattern).match(full_name))

    @property
    def names_a_node(self) -> bool:
        """Whether the pattern does not simply stand for all nodes."""
        return self.pattern != "/**"


@lru_cache(maxsize=256)
def _regex(pattern: str) -> re.Pattern[str]:
    parts = pattern.strip("/").split("/")
    text = "".join(
        r"(?:/[^/]+)*"
        if part == "**"
        else "/" + re.escape(part).replace(r"\*", "[^/]*")
        for part in parts
    )
    return re.compile(text + r"\Z")


class ParameterOverrides:
    """All override sets of a context, in increasing precedence."""

    def __init__(self) -> None:
        self.sets: list[OverrideSet] = []

    def add(
        self,
        pattern: str,
        values: Mapping[str, Any],
        origin: str,
        *,
        by_base_name: bool = False,
    ) -> None:
        """Add values that take precedence over all values added before."""
        if not by_base_name:
            pattern = "/" + pattern.strip("/")
        self.sets.append(OverrideSet(pattern, dict(values), origin, by_base_name))

    def add_file(self, path: Path | str) -> None:
        from navette.runtime.parameter_files import read_parameter_file

        for pattern, values in read_parameter_file(path):
            self.add(pattern, values, str(path))

    def add_arguments(
        self, arguments: Iterable[Path | ParameterArgument], origin: str
    ) -> None:
        """Add ``--params-file`` and ``-p`` arguments in their order."""
        for item in arguments:
            if isinstance(item, Path):
                self.add_file(item)
                continue
            node, name, value = item
            text = f"{origin} -p {node + ':' if node else ''}{name}"
            by_base_name = node is not None
            self.add(node or "/**", {name: value}, text, by_base_name=by_base_name)

    def for_node(self, full_name: str) -> dict[str, Override]:
        """Return the values for a node by parameter name."""
        chosen: dict[str, Override] = {}
        for override in self.sets:
            if override.matches(full_name):
                override.seen_nodes.add(full_name)
                for name, value in override.values.items():
                    chosen[name] = Override(
                        value, override.origin, not override.names_a_node
                    )
        return chosen

    def check(self, nodes: Iterable[ParameterOwner]) -> None:
        """Check that every value belongs to a declared parameter of a node.

        A value for ``/**`` needs one node with such a parameter.

        Raises:
            ParameterError: names the file or argument and the existing nodes or
                parameters.
        """
        known = {
            each.get_fully_qualified_name(): each._node_known_parameters()
            for each in nodes
        }
        for override in self.sets:
            matching = [name for name in known if override.matches(name)]
            if not matching and not override.seen_nodes:
                raise ParameterError(
                    f"{override.origin}: no node matches {override.pattern!r}; "
                    f"nodes: {', '.join(sorted(known)) or 'none'}"
                )
            for name in override.values:
                self._check_name(override, name, {n: known[n] for n in matching})

    def check_used_by(self, nodes: Sequence[ParameterOwner]) -> None:
        """As :meth:`check`, for nodes that are only a part of the system.

        A parameter file often serves a whole system: entries for other nodes are
        accepted, but a file without any entry for these nodes is an error. Values that
        a file gives for ``/**`` are not checked.
        """
        names = [node.get_fully_qualified_name() for node in nodes]
        by_origin: dict[str, list[OverrideSet]] = defaultdict(list)
        for each in self.sets:
            by_origin[each.origin].append(each)
        checked = ParameterOverrides()
        for sets in by_origin.values():
            own = [each for each in sets if any(map(each.matches, names))]
            is_file = len(sets) > 1 or sets[0].names_a_node
            named = [each for each in own if each.names_a_node or not is_file]
            checked.sets += named if own else sets
        checked.check(nodes)

    @staticmethod
    def _check_name(
        override: OverrideSet, name: str, known: dict[str, list[str] | None]
    ) -> None:
        if not known:
            return
        if any(names is None or name in names for names in known.values()):
            return
        every = {each for names in known.values() for each in names or ()}
        nodes = next(iter(known)) if len(known) == 1 else "NODE"
        if similar_names(name, every):
            see_all = f"navette param list {nodes}, while it runs"
            end = instead_of(name, every, see_all=see_all)
        else:
            listed = (
                f"{node}: {', '.join(sorted(names or [])) or 'none'}"
                for node, names in sorted(known.items())
            )
            end = f"; known: {'; '.join(listed)}"
        raise ParameterError(
            f"{override.origin}: unknown parameter {name!r} for "
            f"{override.pattern!r}{end}"
        )
