"""DDS content filter expressions: ``temperature < %0 OR NOT (name LIKE 'a%')``.

Grammar: OMG DDS 1.4, annex B, FilterExpression, with two extensions that DDS vendors
have: ``!=`` beside ``<>``, and MATCH (a regular expression for the whole string).
"""

import operator
import re
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from lark import Lark, Token, Transformer, UnexpectedInput, UnexpectedToken, v_args
from lark.exceptions import VisitError

from navette.errors import InvalidValueError
from navette.msgs import type_name
from navette.msgs.field_path import parse_field_path
from navette.runtime.exceptions import RCLError

Condition = Callable[[Any], bool]

MAX_LENGTH = 4096  # characters
MAX_NESTING = 100  # NOTs and opening parentheses

_GRAMMAR = r"""
?disjunction: conjunction (_OR conjunction)*
?conjunction: negation (_AND negation)*
?negation: _NOT negation                      -> negation
    | "(" disjunction ")"
    | term COMPARISON term                    -> comparison
    | term _BETWEEN term _AND term            -> between
    | term _NOT _BETWEEN term _AND term       -> not_between
    | term _LIKE term                         -> like
    | term _MATCH term                        -> match
?term: FIELD                                  -> field
    | PARAMETER                               -> parameter
    | literal
?literal: NUMBER                              -> number
    | STRING                                  -> string
    | (TRUE | FALSE)                          -> boolean

COMPARISON: "<=" | ">=" | "<>" | "!=" | "=" | "<" | ">"
PARAMETER: /%\d{1,2}/
NUMBER: /[-+]?(0[xX][0-9a-fA-F]+|(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)/
STRING: /['`][^']*'/
FIELD: /[A-Za-z_]\w*(\[\d+\])?(\.[A-Za-z_]\w*(\[\d+\])?)*/
_OR.2: /OR\b/i
_AND.2: /AND\b/i
_NOT.2: /NOT\b/i
_BETWEEN.2: /BETWEEN\b/i
_LIKE.2: /LIKE\b/i
_MATCH.2: /MATCH\b/i
TRUE.2: /TRUE\b/i
FALSE.2: /FALSE\b/i
%ignore /\s+/
"""
_PARSER = Lark(_GRAMMAR, parser="lalr", start=["disjunction", "literal"])

_COMPARISONS: dict[str, Callable[[Any, Any], bool]] = {
    "=": operator.eq,
    "<>": operator.ne,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_TERMINALS = {
    "COMPARISON": " ".join(_COMPARISONS),
    "PARAMETER": "a parameter (%0)",
    "NUMBER": "a number",
    "STRING": "a string in single quotes",
    "FIELD": "a field",
    "LPAR": "(",
    "RPAR": ")",
    "$END": "the end",
}


class ContentFilterError(RCLError, InvalidValueError):
    """A filter expression or its parameters cannot be used."""


def compile_filter(
    expression: str, parameters: Sequence[str], message_class: type
) -> Condition:
    """Return the predicate on messages that the expression describes.

    Args:
        expression: fields are named as in the message, ``header.stamp.sec``,
            ``ranges[0]``; keywords in any case; NOT binds before AND, AND before OR.
        parameters: values of ``%0``, ``%1``, …: numbers, TRUE, FALSE or quoted strings.
        message_class: type of the messages.

    A message whose sequence is shorter than an index of the expression does not pass.

    Raises:
        ContentFilterError: a syntax error, an unknown field, operands of different
            kinds, a malformed or missing parameter.
    """
    if len(expression) > MAX_LENGTH:
        raise ContentFilterError(
            f"filter of {len(expression)} characters; at most {MAX_LENGTH} allowed"
        )
    if len(re.findall(r"\(|\bNOT\b", expression, re.IGNORECASE)) > MAX_NESTING:
        raise ContentFilterError(
            f"filter has more than {MAX_NESTING} parentheses and NOTs"
        )
    try:
        tree = _PARSER.parse(expression, start="disjunction")
        condition = _Compiler(parameters, message_class).transform(tree)
    except UnexpectedInput as error:
        raise ContentFilterError(f"filter {expression!r}: {_explain(error)}") from None
    except VisitError as error:
        raise ContentFilterError(f"filter {expression!r}: {error.orig_exc}") from None

    def passes(message: Any) -> bool:
        try:
            return bool(condition(message))
        except IndexError:  # a sequence is shorter than the index
            return False

    return passes


def _explain(error: UnexpectedInput) -> str:
    found, allowed = "character", getattr(error, "allowed", None) or set()
    if isinstance(error, UnexpectedToken):
        found, allowed = f"{error.token.value!r}", error.accepts or error.expected
        if error.token.type == "$END":
            found = "end"
    names = sorted(_TERMINALS.get(each, each.strip("_")) for each in allowed)
    return f"unexpected {found} at column {error.column}; expected {', '.join(names)}"


GetValue = Callable[[Any], Any]
"""Returns the value of a term from a message."""


class _Term(NamedTuple):
    """A field or a constant; ``kind`` is number, string or bool."""

    kind: str
    get: GetValue
    text: str
    value: Any = None


@v_args(inline=True)
class _Compiler(Transformer[Token, Any]):
    """Turns the syntax tree into nested functions of the message."""

    def __init__(self, parameters: Sequence[str], message_class: type) -> None:
        super().__init__()
        self._parameters = parameters
        self._type_name = type_name(message_class)

    def disjunction(self, *conditions: Condition) -> Condition:
        return lambda m: any(holds(m) for holds in conditions)

    def conjunction(self, *conditions: Condition) -> Condition:
        return lambda m: all(holds(m) for holds in conditions)

    def negation(self, condition: Condition) -> Condition:
        return lambda m: not condition(m)

    def comparison(self, left: _Term, sign: Token, right: _Term) -> Condition:
        _check_kinds(left, right)
        compare, get_left, get_right = _COMPARISONS[sign], left.get, right.get
        return lambda m: compare(get_left(m), get_right(m))

    def between(self, term: _Term, low: _Term, high: _Term) -> Condition:
        _check_kinds(term, low)
        _check_kinds(term, high)
        return lambda m: low.get(m) <= term.get(m) <= high.get(m)

    def not_between(self, term: _Term, low: _Term, high: _Term) -> Condition:
        return self.negation(self.between(term, low, high))

    def like(self, term: _Term, pattern: _Term) -> Condition:
        return _pattern(term, pattern, _like_pattern)

    def match(self, term: _Term, pattern: _Term) -> Condition:
        return _pattern(term, pattern, str)

    def parameter(self, name: Token) -> _Term:
        number = int(name[1:])
        if number >= len(self._parameters):
            raise ValueError(f"{name}: only {len(self._parameters)} parameters given")
        text = self._parameters[number]
        try:
            tree = _PARSER.parse(text, start="literal")
        except UnexpectedInput:
            raise ValueError(
                f"{name} is {text!r}; allowed: a number, TRUE, FALSE, or a string in "
                "single quotes"
            ) from None
        term: _Term = self.transform(tree)
        return term

    def number(self, text: Token) -> _Term:
        is_integer = re.fullmatch(r"[-+]?(\d+|0[xX][0-9a-fA-F]+)", text)
        base = 16 if "x" in text.lower() else 10
        return _constant("number", text, int(text, base) if is_integer else float(text))

    def string(self, text: Token) -> _Term:
        return _constant("string", text, text[1:-1])

    def boolean(self, text: Token) -> _Term:
        return _constant("bool", text, text.upper() == "TRUE")

    def field(self, text: Token) -> _Term:
        path = parse_field_path(text, self._type_name)
        if not path.type.is_scalar or path.type.is_message:
            raise ValueError(f"{text} is a {path.type}, not a number, string or bool")
        base, get = path.type.base, path.of
        kind = {"string": "string", "wstring": "string", "bool": "bool"}
        if base == "byte":
            return _Term("number", lambda m: get(m)[0], text)
        return _Term(kind.get(base, "number"), get, text)


def _constant(kind: str, text: str, value: Any) -> _Term:
    return _Term(kind, lambda _: value, text, value)


def _check_kinds(left: _Term, right: _Term) -> None:
    if left.kind != right.kind:
        raise ValueError(
            f"{left.text} is a {left.kind}, {right.text} is a {right.kind}"
        )


def _pattern(term: _Term, pattern: _Term, regex: Callable[[str], str]) -> Condition:
    _check_kinds(term, pattern)
    if term.kind != "string" or pattern.value is None:
        raise ValueError("LIKE and MATCH compare a string field with a quoted string")
    try:
        matches = re.compile(regex(pattern.value), re.DOTALL).fullmatch
    except re.error as error:
        raise ValueError(f"pattern {pattern.text}: {error}") from None
    return lambda m: matches(term.get(m)) is not None


def _like_pattern(text: str) -> str:
    """Translate SQL's LIKE: ``%`` matches any characters, ``_`` one."""
    signs = {"%": ".*", "_": "."}
    return "".join(signs.get(c) or re.escape(c) for c in text)
