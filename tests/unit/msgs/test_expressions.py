"""Expressions of filters and launch files: values, refusals, bounds."""

import pytest

from navette.errors import DecodeError
from navette.msgs.diagnostic_msgs.msg import DiagnosticStatus
from navette.msgs.expressions import Expression, ExpressionError
from navette.msgs.geometry_msgs.msg import Point, PoseStamped


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
        ("[a + b for a, b in ((1, 2),)]", [3]),
        ("'a b'.replace(' ', '-') + ','.join(['c', 'd'])", "a-bc,d"),
        ("str(2 ** 10 * 2.5) + str(True)", "2560.0True"),
    ],
)
def test_expressions_have_pythons_values(text: str, value: object) -> None:
    assert Expression(text).value() == value


# Each level doubles the number of backslashes.
DOUBLING = "".join(
    f" for {new} in [str([{old}])]" for old, new in zip("abcde", "bcdef", strict=True)
)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("__import__('os')", "unknown name '__import__'"),
        ("().__class__", "not available"),
        ("max.__self__", "not available"),
        ("math.sqrt.__self__", "not available"),
        ("math.factorial(9)", "'factorial' of math is not available"),
        ("'{0.__class__}'.format(1)", "not available"),
        ("f'{1:999999999d}'", "JoinedStr"),
        ("'x'.center(10 ** 10)", "not available"),
        ("'%1000000000d' % 1", "'%' on text"),
        ("{x: 1 for x in (1,)}", "DictComp"),
        ("sum(x for x in [y for y in (1, 2)]) + x", "'x' is not defined"),
        ("sum([[1], [2]], [])", "adds numbers"),
        ("round(7, -10 ** 9)", "digits"),
        ("prod((1, 2))", "unknown name 'prod'"),
        ("[1 for a in 'x' * 9999 for b in 'x' * 9999]", "too many elements"),
        ("[1 for a in 'x' * 9999 for b in 'x' * 9999 if a != b]", "too many"),
        ("[1 for a in [1] if " + " + ".join("a" * 60) + "]", "of .* parts; at most"),
        ("[str([f]) for a in ['\\\\' * 9999]" + DOUBLING + "]", "items"),
        ("[c for a in [2**4000] for b in [a * a] for c in [b * b]]", "bits"),
        ("lambda: 1", "Lambda"),
        ("9 ** 9 ** 9", "bits"),
        ("'a' * 10 ** 9", "items"),
        ("('a' * 9000).replace('a', 'b' * 9000)", "items"),
        ("('a' * 9000).join(['b'] * 9000)", "items"),
        ("1 / 0", "ZeroDivisionError"),
        ("1 +", "invalid syntax"),
        ("(" * 300 + ")" * 300, "nested|parentheses"),
        ("1" * 20_000, "at most 10000"),
        ("x = 1", "invalid syntax"),
        ("(x := 1)", "NamedExpr"),
        ("[*(1, 2)]", "Starred"),
        ("[1][5]", "IndexError"),
        ("1 << 99999999", "LShift. is not allowed"),
    ],
)
def test_unsafe_and_unbounded_expressions_are_refused(text: str, reason: str) -> None:
    with pytest.raises(ExpressionError, match=reason):
        Expression(text).value()


def test_names_have_the_fields_and_constants_of_messages() -> None:
    expression = Expression("m.x > limit", names=("m", "limit"))
    assert expression.value({"m": Point(x=1.5), "limit": 1}) is True
    assert expression.value({"m": Point(x=0.5), "limit": 1}) is False
    nested = Expression("m.pose.position.x + len(m.header.frame_id)", names=("m",))
    assert nested.value({"m": PoseStamped()}) == 0
    constant = Expression("m.level == m.OK", names=("m",))
    assert constant.value({"m": DiagnosticStatus()}) is True


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("m.w", "'w' of Point is not available; available: x, y, z"),
        ("m.__class__", "not available"),
        ("m._spec_", "not available"),
        ("m.get_fields_and_field_types()", "not available"),
        ("m.x.real", "'real' of float is not available; available: is_integer"),
        ("m()", "Function 'm' not defined"),
    ],
)
def test_other_attributes_are_refused(text: str, reason: str) -> None:
    with pytest.raises(ExpressionError, match=reason):
        Expression(text, names=("m",)).value({"m": Point()})


def test_a_name_is_computed_only_when_it_is_needed() -> None:
    class Names(dict[str, object]):
        def __missing__(self, name: str) -> object:
            raise DecodeError(f"{name} is damaged")

    expression = Expression("topic == '/a' and m.x > 1", names=("topic", "m"))
    assert expression.value(Names(topic="/b")) is False
    with pytest.raises(DecodeError, match="m is damaged"):
        expression.value(Names(topic="/a"))
    with pytest.raises(DecodeError, match="topic is damaged"):
        expression.value(Names())


def test_an_unknown_name_is_reported_at_construction() -> None:
    with pytest.raises(ExpressionError, match=r"unknown name 'msg'.*known: m, math"):
        Expression("msg.x > 1", names=("m",))


def test_the_hint_is_part_of_the_error() -> None:
    with pytest.raises(ExpressionError, match=r"Lambda.*; use a node"):
        Expression("lambda: 1", hint="use a node")


def test_loop_variables_do_not_leak() -> None:
    expression = Expression("sum(m for m in (1, 2)) + m", names=("m",))
    assert expression.value({"m": 10}) == 13
