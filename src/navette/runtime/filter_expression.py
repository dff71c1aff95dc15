"""Filter expressions of DDS: ``temperature < %0 OR NOT (name LIKE 'a%')``.

Grammar: OMG DDS 1.4, annex B, the part that chooses samples, with ``!=`` beside ``<>``,
and with MATCH (a regular expression for the whole text) as the vendors have it. Fields
are named as in the message, ``header.stamp.sec``, ``ranges[0]``; NOT binds before AND,
AND before OR; keywords in any case.
"""

import operator
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from navette.errors import InvalidValueError
from navette.msgs import get_interface
from navette.msgs.interface import FieldType, MessageSpec
from navette.runtime.exceptions import RCLError

Condition = Callable[[Any], bool]

_TOKEN = re.compile(
    r"\s*(?:(?P<number>[-+]?(?:0[xX][0-9a-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?))"
    r"|(?P<text>['`][^']*')"
    r"|(?P<parameter>%\d{1,2})"
    r"|(?P<operator><=|>=|<>|!=|[=<>()])"
    r"|(?P<word>[A-Za-z_]\w*(?:\[\d+\])?(?:\.[A-Za-z_]\w*(?:\[\d+\])?)*))"
)
_COMPARISONS: dict[str, Callable[[Any, Any], bool]] = {
    "=": operator.eq,
    "<>": operator.ne,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_KEYWORDS = frozenset("AND OR NOT BETWEEN LIKE MATCH TRUE FALSE".split())
_LONGEST = 4096  # characters; also bounds how deep parentheses nest
_DEEPEST = 50


class ContentFilterError(RCLError, InvalidValueError):
    """A filter expression or its parameters cannot be used; says where and why."""


def compile_filter(
    expression: str, parameters: Sequence[str], message_class: type
) -> Condition:
    """What tells whether a message passes.

    Args:
        parameters: what ``%0``, ``%1``, … stand for: numbers, TRUE, FALSE or text in
            quotes.

    Raises:
        ContentFilterError: names the expression and what is wrong with it.
    """
    if len(expression) > _LONGEST:
        raise ContentFilterError(f"filter of {len(expression)} characters: too long")
    parser = _Parser(expression, parameters, message_class)
    condition = parser.either()
    parser.expect_end()

    def passes(message: Any) -> bool:
        try:
            return condition(message)
        except IndexError:  # a sequence without the element that is asked for
            return False

    return passes


@dataclass(frozen=True)
class _Term:
    """A field or a value: ``kind`` is number, text or bool."""

    kind: str
    get: Callable[[Any], Any]
    shown: str
    value: Any = None


class _Parser:
    """Recursive descent over the tokens (group name, text)."""

    def __init__(
        self, expression: str, parameters: Sequence[str], message_class: type
    ) -> None:
        self._expression = expression
        self._parameters = parameters
        self._class = message_class
        self._tokens = self._split(expression)
        self._next = 0
        self._depth = 0

    # -- conditions ------------------------------------------------------------

    def either(self) -> Condition:
        found = [self._both()]
        while self._skip("OR"):
            found.append(self._both())
        return found[0] if len(found) == 1 else lambda m: any(c(m) for c in found)

    def _both(self) -> Condition:
        found = [self._single()]
        while self._skip("AND"):
            found.append(self._single())
        return found[0] if len(found) == 1 else lambda m: all(c(m) for c in found)

    def _single(self) -> Condition:
        self._depth += 1
        if self._depth > _DEEPEST:
            raise self._error("nested too deeply")
        try:
            if self._skip("NOT"):
                negated = self._single()
                return lambda m: not negated(m)
            if self._skip("("):
                inner = self.either()
                self._expect(")")
                return inner
            return self._predicate()
        finally:
            self._depth -= 1

    def _predicate(self) -> Condition:
        left = self._term()
        is_negated = self._skip("NOT")
        if self._skip("BETWEEN"):
            return self._between(left, is_negated=is_negated)
        if is_negated:
            raise self._error("wanted BETWEEN behind NOT")
        for word, pattern_of in (("LIKE", _like_pattern), ("MATCH", str)):
            if self._skip(word):
                return self._pattern(left, pattern_of)
        sign = self._take()[1]
        if sign not in _COMPARISONS:
            raise self._error(f"wanted one of {' '.join(_COMPARISONS)}, got {sign!r}")
        right = self._term()
        self._check_kinds(left, right)
        compare, get_left, get_right = _COMPARISONS[sign], left.get, right.get
        return lambda m: compare(get_left(m), get_right(m))

    def _between(self, term: _Term, *, is_negated: bool) -> Condition:
        low = self._term()
        self._expect("AND")
        high = self._term()
        self._check_kinds(term, low)
        self._check_kinds(term, high)
        return lambda m: (low.get(m) <= term.get(m) <= high.get(m)) != is_negated

    def _pattern(self, term: _Term, pattern_of: Callable[[str], str]) -> Condition:
        wanted = self._term()
        self._check_kinds(term, wanted)
        if term.kind != "text" or wanted.value is None:
            raise self._error("LIKE and MATCH compare a text field with a text")
        try:
            matches = re.compile(pattern_of(wanted.value), re.DOTALL).fullmatch
        except re.error as error:
            raise self._error(f"pattern {wanted.shown}: {error}") from None
        return lambda m: matches(term.get(m)) is not None

    def _check_kinds(self, left: _Term, right: _Term) -> None:
        if left.kind != right.kind:
            raise self._error(
                f"{left.shown} is a {left.kind}, {right.shown} a {right.kind}"
            )

    # -- terms -----------------------------------------------------------------

    def _term(self) -> _Term:
        kind, token = self._take()
        if kind == "parameter":
            number = int(token[1:])
            if number >= len(self._parameters):
                count = len(self._parameters)
                raise self._error(f"{token}: only {count} parameters are given")
            return self._parameter(token, self._parameters[number])
        if kind == "word" and token.upper() not in _KEYWORDS:
            return self._field(token)
        value = _literal(kind, token)
        if value is None:
            raise self._error(f"wanted a field or a value, got {token!r}")
        return value

    def _parameter(self, name: str, text: str) -> _Term:
        match = _TOKEN.fullmatch(text.strip())
        value = None
        if match is not None and match.lastgroup is not None:
            value = _literal(match.lastgroup, match[match.lastgroup])
        if value is None:
            raise self._error(
                f"{name} is {text!r}: wanted a number, TRUE, FALSE, or text in single "
                "quotes"
            )
        return value

    def _field(self, path: str) -> _Term:
        spec: MessageSpec = self._class._spec_  # type: ignore[attr-defined]
        getters: list[Callable[[Any], Any]] = []
        type_ = FieldType(spec.name)
        for part in path.split("."):
            name, _, index = part.rstrip("]").partition("[")
            if not type_.is_message or not type_.is_scalar:
                raise self._error(f"{path}: {type_} has no field {name!r}")
            spec = get_interface(type_.base)._spec_  # type: ignore[attr-defined]
            types = {field.name: field.type for field in spec.fields}
            if name not in types:
                known = ", ".join(types) or "none"
                raise self._error(f"{spec.name} has no field {name!r}; known: {known}")
            type_ = types[name]
            getters.append(operator.attrgetter(name))
            if index:
                if type_.is_scalar:
                    raise self._error(f"{path}: {name} is no array")
                getters.append(operator.itemgetter(int(index)))
                type_ = FieldType(type_.base, string_bound=type_.string_bound)
        if not type_.is_scalar or type_.is_message:
            raise self._error(f"{path} is a {type_}: wanted one number, text or bool")
        if type_.base == "byte":
            getters.append(operator.itemgetter(0))
        kind = "text" if type_.is_string else "bool" if type_.base == "bool" else ""
        return _Term(kind or "number", _chained(getters), path)

    # -- tokens ----------------------------------------------------------------

    def _split(self, expression: str) -> list[tuple[str, str]]:
        tokens, position, text = [], 0, expression.rstrip()
        while position < len(text):
            match = _TOKEN.match(text, position)
            if match is None or match.lastgroup is None:
                raise self._error(f"cannot be read from {text[position:][:20]!r} on")
            tokens.append((match.lastgroup, match[match.lastgroup]))
            position = match.end()
        return tokens

    def _take(self) -> tuple[str, str]:
        if self._next >= len(self._tokens):
            raise self._error("ends too early")
        self._next += 1
        return self._tokens[self._next - 1]

    def _skip(self, wanted: str) -> bool:
        is_there = (
            self._next < len(self._tokens)
            and self._tokens[self._next][1].upper() == wanted
        )
        self._next += is_there
        return is_there

    def _expect(self, wanted: str) -> None:
        if not self._skip(wanted):
            raise self._error(f"wanted {wanted}")

    def expect_end(self) -> None:
        if self._next < len(self._tokens):
            raise self._error(f"unexpected {self._tokens[self._next][1]!r}")

    def _error(self, reason: str) -> ContentFilterError:
        return ContentFilterError(f"filter {self._expression!r}: {reason}")


def _literal(kind: str, token: str) -> _Term | None:
    value: Any
    if kind == "number":
        is_integer = re.fullmatch(r"[-+]?(\d+|0[xX][0-9a-fA-F]+)", token)
        base = 16 if "x" in token.lower() else 10
        value = int(token, base) if is_integer else float(token)
    elif kind == "text":
        value = token[1:-1]
    elif kind == "word" and token.upper() in ("TRUE", "FALSE"):
        kind, value = "bool", token.upper() == "TRUE"
    else:
        return None
    return _Term(kind, lambda _: value, token, value)


def _like_pattern(text: str) -> str:
    """SQL's: ``%`` any characters, ``_`` one."""
    signs = {"%": ".*", "_": "."}
    return "".join(signs.get(c) or re.escape(c) for c in text)


def _chained(getters: list[Callable[[Any], Any]]) -> Callable[[Any], Any]:
    if len(getters) == 1:
        return getters[0]

    def get(value: Any) -> Any:
        for getter in getters:
            value = getter(value)
        return value

    return get
