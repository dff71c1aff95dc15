"""YAML loader for untrusted text: bounded nesting, nodes, aliases and numbers.

libyaml's own composer recurses in C without a limit, so that 60,000 opening brackets
end the process; PyYAML's composer, which is used here on libyaml's events, does not.
"""

from typing import Any, ClassVar

import yaml
from yaml.composer import Composer, ComposerError
from yaml.constructor import ConstructorError, SafeConstructor
from yaml.parser import Parser
from yaml.reader import Reader
from yaml.resolver import Resolver
from yaml.scanner import Scanner

from navette.files.untrusted.budget import DOCUMENT, Budget, BudgetError, BudgetMeter


class _PythonParser(Reader, Scanner, Parser):
    """Parser of a PyYAML that was built without libyaml."""

    def __init__(self, stream: Any) -> None:
        Reader.__init__(self, stream)
        Scanner.__init__(self)
        Parser.__init__(self)


_Parser: Any = _PythonParser
if yaml.__with_libyaml__:
    from yaml.cyaml import CParser  # type: ignore[attr-defined] # absent from the stubs

    _Parser = CParser
_PLAIN_TAGS = ("tag:yaml.org,2002:int", "tag:yaml.org,2002:float")


class BoundedLoader(Composer, _Parser, SafeConstructor, Resolver):  # type: ignore[misc] # the base is a variable
    """``yaml.SafeLoader`` with a budget; every refusal is a ``yaml.YAMLError``.

    Derived classes set other budgets. An alias counts as much as the nodes that it
    repeats; an alias inside its own anchor is refused.
    """

    BUDGET: ClassVar[Budget] = DOCUMENT

    def __init__(self, stream: Any) -> None:
        self._meter = BudgetMeter(self.BUDGET)
        #: Nodes below each finished anchor.
        self._sizes: dict[str, int] = {}
        if isinstance(stream, str | bytes):
            _checked(self._meter.spend_octets, len(stream))
        try:
            _Parser.__init__(self, stream)
        except UnicodeError as error:
            raise yaml.YAMLError(f"invalid text: {error}") from error
        Composer.__init__(self)
        SafeConstructor.__init__(self)
        Resolver.__init__(self)

    def compose_node(self, parent: Any, index: Any) -> Any:
        event: Any = self.peek_event()
        meter = self._meter
        if self.check_event(yaml.AliasEvent):
            size = self._sizes.get(event.anchor)
            if size is None and event.anchor in self.anchors:
                raise ComposerError(
                    None,
                    None,
                    f"alias *{event.anchor} contains itself",
                    event.start_mark,
                )
            _checked(meter.spend_items, size or 1, mark=event.start_mark)
            return super().compose_node(parent, index)
        before = meter.items
        _checked(meter.spend_items, 1, mark=event.start_mark)
        _checked(meter.enter, mark=event.start_mark)
        node: Any = super().compose_node(parent, index)
        meter.leave()
        if event.anchor is not None:
            self._sizes[event.anchor] = meter.items - before
        if node.tag in _PLAIN_TAGS and len(node.value) > self.BUDGET.word:
            raise ComposerError(
                None, None, f"a number of {len(node.value)} characters", node.start_mark
            )
        return node

    def construct_document(self, node: Any) -> Any:
        """Construct the values; an invalid date or number is an error of YAML, too."""
        try:
            return super().construct_document(node)
        except (ValueError, OverflowError, LookupError, AttributeError) as error:
            raise ConstructorError(None, None, str(error), node.start_mark) from error


def _checked(spend: Any, *count: int, mark: Any = None) -> None:
    try:
        spend(*count)
    except BudgetError as error:
        raise ComposerError(None, None, str(error), mark) from None


def load_yaml(text: str | bytes, loader: Any = BoundedLoader) -> Any:
    """Return the value of one document; None for an empty text.

    Args:
        loader: a :class:`BoundedLoader`.

    Raises:
        yaml.YAMLError: not YAML, or beyond the loader's budget.
    """
    return yaml.load(text, Loader=loader)


def load_all_yaml(text: str | bytes, loader: Any = BoundedLoader) -> list[Any]:
    """Return the values of all documents, separated by ``---``."""
    return list(yaml.load_all(text, Loader=loader))


def compose_yaml(text: str | bytes, loader: Any = BoundedLoader) -> Any:
    """Return the root node of one document; None for an empty text."""
    return yaml.compose(text, Loader=loader)


def line_of(error: yaml.YAMLError) -> int | None:
    """Return the line of an error, from 1."""
    mark = getattr(error, "problem_mark", None)
    return None if mark is None else int(mark.line) + 1


def problem_of(error: yaml.YAMLError) -> str:
    """Return what is wrong, without the place."""
    return getattr(error, "problem", None) or str(error)
