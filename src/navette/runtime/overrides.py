"""Parameter values given from outside: files, launch, command line; the last wins."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from navette.errors import ParameterError
from navette.runtime.arguments import ParameterArgument
from navette.runtime.parameter_files import read_parameter_file


class Override(NamedTuple):
    """A value for a parameter of a node, and where it comes from."""

    value: Any
    origin: str
    is_for_all: bool = False  # given for "/**": not every node need know the name


class NodeWithParameters(Protocol):
    """What :meth:`ParameterOverrides.check` needs to know of a node."""

    def get_fully_qualified_name(self) -> str: ...
    def known_parameters(self) -> list[str] | None:
        """Declared names; None if the node takes any."""


@dataclass
class OverrideSet:
    """Values from one origin for the nodes that a pattern names.

    ``by_base_name`` rules (``-p node:name:=value``) go by the node's bare name; the
    others by the full name, with ``*`` for one part and ``**`` for any number.
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
        """Whether the pattern is more than "every node"."""
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
    """All override sets of a context, weakest first."""

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
        """Add values that win over everything added before."""
        if not by_base_name:
            pattern = "/" + pattern.strip("/")
        self.sets.append(OverrideSet(pattern, dict(values), origin, by_base_name))

    def add_file(self, path: Path | str) -> None:
        """Add a ROS 2 parameter file, in the order of its entries."""
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
        """name → value for a node, the last word already chosen."""
        chosen: dict[str, Override] = {}
        for override in self.sets:
            if override.matches(full_name):
                override.seen_nodes.add(full_name)
                for name, value in override.values.items():
                    chosen[name] = Override(
                        value, override.origin, not override.names_a_node
                    )
        return chosen

    def check(self, nodes: Iterable[NodeWithParameters]) -> None:
        """Raise unless every value given reaches a parameter that a node declared.

        Values for ``/**`` need one node that knows the name.

        Raises:
            ParameterError: names the file or argument and the known nodes or names.
        """
        known = {n.get_fully_qualified_name(): n.known_parameters() for n in nodes}
        for override in self.sets:
            matching = [name for name in known if override.matches(name)]
            if not matching and not override.seen_nodes:
                raise ParameterError(
                    f"{override.origin}: no node matches {override.pattern!r}; "
                    f"nodes: {', '.join(sorted(known)) or 'none'}"
                )
            for name in override.values:
                self._check_name(override, name, {n: known[n] for n in matching})

    @staticmethod
    def _check_name(
        override: OverrideSet, name: str, known: dict[str, list[str] | None]
    ) -> None:
        if not known:
            return
        takers = [names is None or name in names for names in known.values()]
        if any(takers):
            return
        listed = "; ".join(
            f"{node}: {', '.join(sorted(names or [])) or 'none'}"
            for node, names in sorted(known.items())
        )
        raise ParameterError(
            f"{override.origin}: unknown parameter {name!r} for "
            f"{override.pattern!r}; known: {listed}"
        )
