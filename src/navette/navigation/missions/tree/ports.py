"""Ports of tree nodes: attributes of the XML, as literals or blackboard entries."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from navette.navigation.missions.tree.blackboard import TreeBlackboard

_ENTRY = re.compile(r"\{\s*([^{}\s]*)\s*\}")


ParsePort = Callable[[str], Any]
"""Converts the literal of a port; raises ValueError."""


def parse_text(text: str) -> str:
    return text


def parse_float(text: str) -> float:
    value = float(text)
    if math.isnan(value):
        raise ValueError(f"{text!r} is not a number")
    return value


def parse_int(text: str) -> int:
    return int(text, 10)


def parse_count(text: str) -> int:
    """Parse a number of cycles or attempts; -1 means without limit."""
    value = int(text, 10)
    if value < -1:
        raise ValueError(f"{text!r}: expected -1 (no limit) or more")
    return value


def parse_bool(text: str) -> bool:
    known = {"true": True, "1": True, "false": False, "0": False}
    if text.lower() not in known:
        raise ValueError(f"{text!r}: expected true or false")
    return known[text.lower()]


def parse_absent(text: str) -> bool:
    """Accept ``false`` for an option of newer versions of Nav2 that Navette lacks."""
    if parse_bool(text):
        raise ValueError(f"{text!r}: not available here; only false is")
    return False


def parse_ints(text: str) -> tuple[int, ...]:
    """Parse integers separated by ``;`` or ``,``."""
    return tuple(int(word, 10) for word in re.split("[;,]", text) if word.strip())


def parse_texts(text: str) -> tuple[str, ...]:
    """Parse words separated by ``;`` or ``,``."""
    return tuple(word.strip() for word in re.split("[;,]", text) if word.strip())


def parse_milliseconds(text: str) -> int:
    return int(text.removesuffix("ms"), 10)


def parse_message(text: str) -> Any:
    raise ValueError(f"{text!r}: expected a blackboard entry, as {{name}}")


KINDS: dict[ParsePort, str] = {
    parse_text: "text",
    parse_float: "number",
    parse_int: "whole number",
    parse_count: "whole number or -1",
    parse_bool: "true or false",
    parse_absent: "false: true is not available here",
    parse_ints: "whole numbers separated by ;",
    parse_texts: "words separated by ;",
    parse_milliseconds: "milliseconds",
    parse_message: "{entry}",
}
"""What each parser accepts, for error messages and the reference."""


@dataclass(frozen=True)
class Port:
    """A port of a kind of node.

    Attributes:
        default: literal of an input that is not given; None: no value.
        required: whether it must be given.
        output: whether the node writes it.
        entry: blackboard entry that is read if the port is not given.
    """

    parse: ParsePort = parse_text
    default: str | None = None
    required: bool = False
    output: bool = False
    entry: str = ""

    def read(self, text: str | None, blackboard: TreeBlackboard) -> Any:
        """Return the value of an input; None without a value.

        Raises:
            ValueError: a text in the blackboard is not of the port's kind.
        """
        if text is None:
            if self.entry and self.entry in blackboard:
                return blackboard.get(self.entry)
            return None if self.default is None else self.parse(self.default)
        entry = entry_of(text)
        if entry is None:
            return self.parse(text)
        value = blackboard.get(entry)
        if value is None and self.default is not None:
            return self.parse(self.default)
        # SetBlackboard and remapped subtree ports store literals as text.
        if isinstance(value, str) and self.parse is not parse_text:
            return self.parse(value)
        return value


def entry_of(text: str) -> str | None:
    """Return the entry's name of ``{name}``; None for a literal."""
    match = _ENTRY.fullmatch(text.strip())
    return None if match is None else match.group(1)


def output_port() -> Port:
    return Port(parse_message, output=True)
