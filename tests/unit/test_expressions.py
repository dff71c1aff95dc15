"""Expressions of launch files and filters: what they can, what they refuse."""

from dataclasses import dataclass

import pytest

from navette.expressions import Expression, ExpressionError, evaluate


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1 + 2 * 3 ** 2", 19),
        ("'a' in 'cab' and not False", True),
        ("[1, 2, 3][-1] if 2 > 1 >= 1 else 0", 3),
        ("{'a': 1}.get('b', (1,)[0])", 1),
        ("'A,b'.lower().split(',')[1:]", ["b"]),
        ("max(1, len('abc')) // 2", 1),
        ("str(round(math.pi, 2)) + 'x'", "3.14x"),
        ("-1 != +1 or 1/0", True),
        ("true", True),
        ("sorted({3, 1})", [1, 3]),
        ("[x * y for x in (1, 2, 3) if x > 1 for y in (10, 100)]", [20, 200, 30, 300]),
        ("any(x < 0 for x in (1, -1))", True),
        ("sum({x % 2 for x in (1, 2, 3)})", 1),
    ],
)
def test_expressions_calculate(text: str, value: object) -> None:
    assert evaluate(text) == value


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("__import__('os')", "unknown name '__import__'"),
        ("().__class__", "not allowed"),
        ("'{0.__class__}'.format(1)", "not allowed"),
        ("'%1000000000d' % 1", "'%' on text"),
        ("{x: 1 for x in (1,)}", "DictComp"),
        ("[a for a, b in ((1, 2),)]", "one simple name"),
        ("sum(x for x in [y for y in (1, 2)]) + x", "'x' has no value here"),
        ("sum([[1], [2]], [])", "adds numbers"),
        ("round(7, -10 ** 9)", "digits"),
        ("prod((1, 2))", "unknown name 'prod'"),
        ("[1 for a in 'x' * 9999 for b in 'x' * 9999]", "items"),
        ("[1 for a in 'x' * 9999 for b in 'x' * 9999 if a != b]", "steps"),
        ("lambda: 1", "Lambda"),
        ("9 ** 9 ** 9", "bits"),
        ("'a' * 10 ** 9", "items"),
        ("('a' * 9000).replace('a', 'b' * 9000)", "items"),
        ("1 / 0", "ZeroDivisionError"),
        ("1 +", "invalid syntax"),
        ("(" * 300 + ")" * 300, "nested|parentheses"),
        ("1" * 20_000, "at most 10000"),
        ("[1][5]", "IndexError"),
        ("1 << 99999999", "LShift is not allowed"),
    ],
)
def test_expressions_reach_nothing_and_stay_small(text: str, reason: str) -> None:
    with pytest.raises(ExpressionError, match=reason):
        evaluate(text)


@dataclass
class Point:
    x: float = 1.5
    secret: str = "no"


def fields(owner: object) -> tuple[str, ...]:
    return ("x",) if isinstance(owner, Point) else ()


def test_names_and_fields_are_those_given() -> None:
    expression = Expression("m.x > limit", names=("m", "limit"), fields=fields)
    assert expression.value(m=Point(), limit=1) is True
    assert expression.value(m=Point(x=0.5), limit=1) is False


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("m.secret", "'m.secret' is not allowed; of Point: x"),
        ("m.__class__", "not allowed"),
        ("m.x.real", "not allowed; of float"),
        ("m()", "cannot be called"),
    ],
)
def test_fields_that_are_not_given_are_out_of_reach(text: str, reason: str) -> None:
    with pytest.raises(ExpressionError, match=reason):
        Expression(text, names=("m",), fields=fields).value(m=Point())


def test_an_unknown_name_is_found_before_there_is_a_value() -> None:
    with pytest.raises(ExpressionError, match=r"unknown name 'msg'.*known: m, math"):
        Expression("msg.x > 1", names=("m",))


def test_a_hint_says_what_to_do_instead() -> None:
    with pytest.raises(ExpressionError, match=r"Lambda.*; use a node"):
        evaluate("lambda: 1", "use a node")


def test_loops_leave_names_as_they_were() -> None:
    expression = Expression("sum(m for m in (1, 2)) + m", names=("m",))
    assert expression.value(m=10) == 13
