"""Parameters of a node: declaring, setting, describing, callbacks, events."""

from typing import Any

import pytest

from navette.errors import ParameterError
from navette.msgs.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from navette.runtime import Context, Node, Parameter, VirtualClock
from navette.runtime.exceptions import (
    InvalidParameterException,
    InvalidParameterValueException,
    ParameterAlreadyDeclaredException,
    ParameterImmutableException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from navette.runtime.parameter import parameter_value_to_python
from navette.runtime.testing import GraphHarness

T = Parameter.Type


@pytest.fixture
def node() -> Node:
    return Node("n", context=Context(clock=VirtualClock()))


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (None, T.NOT_SET),
        (True, T.BOOL),
        (3, T.INTEGER),
        (3.0, T.DOUBLE),
        ("x", T.STRING),
        ([b"\x01"], T.BYTE_ARRAY),
        ([True], T.BOOL_ARRAY),
        ([1, 2], T.INTEGER_ARRAY),
        ([1.0], T.DOUBLE_ARRAY),
        (["a"], T.STRING_ARRAY),
        ([], T.BYTE_ARRAY),
    ],
)
def test_type_of_a_value_and_back_through_messages(value: Any, kind: T) -> None:
    parameter: Parameter[Any] = Parameter("p", value=value)
    assert parameter.type_ is kind
    assert kind.check(value)
    assert Parameter.from_parameter_msg(parameter.to_parameter_msg()) == parameter
    assert parameter_value_to_python(parameter.get_parameter_value()) == value


@pytest.mark.parametrize("value", [{}, [1, "a"], object(), [1, 2.0], [[1]]])
def test_values_without_a_parameter_type(value: Any) -> None:
    with pytest.raises(TypeError, match="has no parameter type"):
        Parameter("p", value=value)


def test_type_and_value_must_agree() -> None:
    with pytest.raises(ValueError, match="not of type INTEGER"):
        Parameter("p", T.INTEGER, 1.5)
    with pytest.raises(ValueError, match="not of type INTEGER"):
        Parameter("p", T.INTEGER, True)
    with pytest.raises(TypeError, match=r"Parameter\.Type"):
        Parameter("p", "INTEGER", 1)  # type: ignore[arg-type]


def test_declare_and_get(node: Node) -> None:
    assert node.declare_parameter("speed", 0.5).value == 0.5
    assert node.get_parameter("speed").value == 0.5
    assert node.get_parameter("speed").type_ is T.DOUBLE
    assert node.has_parameter("speed")
    assert not node.has_parameter("other")
    assert node.get_parameter_types(["speed"]) == [T.DOUBLE]


def test_declare_several_below_a_namespace(node: Node) -> None:
    declared = node.declare_parameters(
        "pid", [("p", 1.0), ("i", T.DOUBLE), ("on", True, ParameterDescriptor())]
    )
    assert [p.name for p in declared] == ["pid.p", "pid.i", "pid.on"]
    by_prefix = node.get_parameters_by_prefix("pid")
    assert {n: p.value for n, p in by_prefix.items()} == {
        "p": 1.0,
        "i": None,
        "on": True,
    }


def test_declared_type_without_a_value_cannot_be_read(node: Node) -> None:
    node.declare_parameter("x", T.DOUBLE)
    with pytest.raises(ParameterUninitializedException):
        node.get_parameter("x")
    assert node.get_parameter_or("x", Parameter("x", value=1.0)).value == 1.0
    node.set_parameters([Parameter("x", value=2.0)])
    assert node.get_parameter("x").value == 2.0


def test_name_only_declares_any_type(node: Node) -> None:
    node.declare_parameter("x")
    assert node.get_parameter("x").value is None
    for value in (1, "one", [1.0]):
        assert node.set_parameters([Parameter("x", value=value)])[0].successful


def test_invalid_declarations(node: Node) -> None:
    node.declare_parameter("x", 1)
    with pytest.raises(ParameterAlreadyDeclaredException):
        node.declare_parameter("x", 1)
    with pytest.raises(InvalidParameterException):
        node.declare_parameter("", 1)
    with pytest.raises(ParameterError, match="NOT_SET"):
        node.declare_parameter("y", T.NOT_SET)
    with pytest.raises(ParameterError, match="needs a default"):
        node.declare_parameter("y", None, ParameterDescriptor())
    with pytest.raises(TypeError, match="parameter tuple"):
        node.declare_parameters("", [("a", 1, ParameterDescriptor(), 4)])


def test_unknown_parameter_lists_the_known_ones(node: Node) -> None:
    node.declare_parameter("speed", 1.0)
    with pytest.raises(ParameterNotDeclaredException, match=r"/n.*speed.*: sped"):
        node.get_parameter("sped")
    with pytest.raises(ParameterNotDeclaredException):
        node.set_parameters([Parameter("sped", value=1.0)])
    with pytest.raises(TypeError, match="expected a Parameter"):
        node.set_parameters(["speed"])  # type: ignore[list-item]


def test_undeclare(node: Node) -> None:
    node.declare_parameter("x", 1)
    node.undeclare_parameter("x")
    assert not node.has_parameter("x")
    node.declare_parameter("fixed", 1, ParameterDescriptor(read_only=True))
    with pytest.raises(ParameterImmutableException):
        node.undeclare_parameter("fixed")
    with pytest.raises(ParameterNotDeclaredException):
        node.undeclare_parameter("x")


def test_undeclared_parameters_may_be_allowed() -> None:
    node = Node(
        "n", context=Context(clock=VirtualClock()), allow_undeclared_parameters=True
    )
    assert node.get_parameter("x").type_ is T.NOT_SET
    assert node.set_parameters([Parameter("x", value=1)])[0].successful
    assert node.get_parameter("x").value == 1
    # Setting it to NOT_SET takes it away again.
    assert node.set_parameters([Parameter("x", T.NOT_SET)])[0].successful
    assert not node.has_parameter("x")
    assert node._node_known_parameters() is None
    with pytest.raises(ParameterNotDeclaredException):
        node.undeclare_parameter("x")


def test_overrides_take_precedence_over_defaults() -> None:
    node = Node(
        "n",
        context=Context(clock=VirtualClock()),
        parameter_overrides=[Parameter("x", value=5)],
    )
    assert node.declare_parameter("x", 1).value == 5
    assert node.declare_parameter("y", 1).value == 1


def test_ignore_override() -> None:
    node = Node(
        "n",
        context=Context(clock=VirtualClock()),
        parameter_overrides=[Parameter("x", value=5)],
    )
    assert node.declare_parameter("x", 1, ignore_override=True).value == 1


def test_declared_automatically_from_overrides() -> None:
    node = Node(
        "n",
        context=Context(clock=VirtualClock()),
        parameter_overrides=[Parameter("x", value=5)],
        automatically_declare_parameters_from_overrides=True,
    )
    assert node.get_parameter("x").value == 5


def test_an_int_is_converted_to_a_double(node: Node) -> None:
    node.declare_parameter("x", 1.5)
    node.declare_parameter("xs", [1.5])
    assert node.set_parameters([Parameter("x", value=2)])[0].successful
    assert node.set_parameters([Parameter("xs", value=[1, 2])])[0].successful
    assert isinstance(node.get_parameter("x").value, float)
    assert node.get_parameter("xs").value == [1.0, 2.0]


@pytest.mark.parametrize(
    ("default", "value"),
    [(1, 1.0), (1.0, True), (1.0, "1"), (True, 1), ("a", 1), ([1], [1.5]), ([1], 1)],
)
def test_a_wrong_type_is_rejected(node: Node, default: Any, value: Any) -> None:
    node.declare_parameter("x", default)
    result = node.set_parameters([Parameter("x", value=value)])[0]
    assert not result.successful
    assert "'x'" in result.reason
    assert "expected" in result.reason
    assert node.get_parameter("x").value == default


def test_an_empty_list_is_accepted_for_any_array(node: Node) -> None:
    node.declare_parameter("x", [1.5])
    assert node.set_parameters([Parameter("x", value=[])])[0].successful
    assert node.get_parameter("x").type_ is T.DOUBLE_ARRAY


def test_ranges_and_steps(node: Node) -> None:
    node.declare_parameter(
        "i",
        4,
        ParameterDescriptor(
            integer_range=[IntegerRange(from_value=0, to_value=10, step=2)]
        ),
    )
    span = FloatingPointRange(from_value=-1.0, to_value=1.0, step=0.25)
    node.declare_parameter("d", 0.0, ParameterDescriptor(floating_point_range=[span]))

    def accepts(name: str, value: Any) -> bool:
        return bool(node.set_parameters([Parameter(name, value=value)])[0].successful)

    assert [accepts("i", v) for v in (0, 10, 6, 7, -2, 11)] == [
        True,
        True,
        True,
        False,
        False,
        False,
    ]
    assert [accepts("d", v) for v in (-1.0, 1.0, 0.25, 0.3, 1.1)] == [
        True,
        True,
        True,
        False,
        False,
    ]


def test_a_default_outside_the_range_is_rejected(node: Node) -> None:
    bounds = [IntegerRange(from_value=0, to_value=10)]
    with pytest.raises(InvalidParameterValueException, match=r"out of range 0 … 10"):
        node.declare_parameter("i", 11, ParameterDescriptor(integer_range=bounds))
    assert not node.has_parameter("i")


def test_read_only(node: Node) -> None:
    node.declare_parameter("x", 1, ParameterDescriptor(read_only=True))
    result = node.set_parameters([Parameter("x", value=2)])[0]
    assert not result.successful
    assert "read-only" in result.reason


def test_describe_and_replace_the_descriptor(node: Node) -> None:
    node.declare_parameter("x", 1, ParameterDescriptor(description="how many"))
    descriptor = node.describe_parameter("x")
    assert (descriptor.name, descriptor.description, descriptor.type) == (
        "x",
        "how many",
        int(T.INTEGER),
    )
    bounds = [IntegerRange(from_value=5, to_value=10)]
    with pytest.raises(InvalidParameterValueException):
        node.set_descriptor("x", ParameterDescriptor(integer_range=bounds))
    assert node.describe_parameters(["x"])[0].description == "how many"
    value = node.set_descriptor(
        "x",
        ParameterDescriptor(integer_range=bounds),
        Parameter("x", value=7).get_parameter_value(),
    )
    assert value.integer_value == 7
    assert node.get_parameter("x").value == 7


def test_one_descriptor_for_two_parameters(node: Node) -> None:
    descriptor = ParameterDescriptor(description="shared")
    node.declare_parameter("a", 1, descriptor)
    node.declare_parameter("b", "x", descriptor)
    assert node.describe_parameter("a").type == int(T.INTEGER)
    assert node.describe_parameter("b").type == int(T.STRING)


def test_list_parameters(node: Node) -> None:
    for name in ("a", "b.c", "b.d.e", "b.d.f.g"):
        node.declare_parameter(name, 1)

    def names(prefixes: list[str], depth: int) -> list[str]:
        listed = node.list_parameters(prefixes, depth).names
        own = ("use_sim_time", "start_type_description_service")
        return [name for name in listed if name not in own]

    assert names([], 0) == ["a", "b.c", "b.d.e", "b.d.f.g"]
    assert names([], 1) == ["a"]
    assert names(["b"], 0) == ["b.c", "b.d.e", "b.d.f.g"]
    assert names(["b"], 1) == ["b.c"]
    assert names(["b.d", "a"], 2) == ["a", "b.d.e", "b.d.f.g"]
    assert node.list_parameters(["b"], 0).prefixes == ["b", "b.d", "b.d.f"]
    with pytest.raises(ValueError, match="depth"):
        node.list_parameters([], -1)


def test_one_by_one_or_all_or_none(node: Node) -> None:
    node.declare_parameters("", [("a", 1), ("b", 1)])
    mixed = [Parameter("a", value=2), Parameter("b", value="two")]
    assert not node.set_parameters_atomically(mixed).successful
    assert node.get_parameter("a").value == 1
    assert [r.successful for r in node.set_parameters(mixed)] == [True, False]
    assert node.get_parameter("a").value == 2


def test_the_on_set_callback_can_reject(node: Node) -> None:
    def refuse(parameters: list[Parameter[Any]]) -> SetParametersResult:
        bad = any(p.name == "x" and p.value > 5 for p in parameters)
        return SetParametersResult(successful=not bad, reason="too big" if bad else "")

    node.add_on_set_parameters_callback(refuse)
    with pytest.raises(InvalidParameterValueException, match="too big"):
        node.declare_parameter("x", 9)
    node.declare_parameter("x", 1)
    assert node.set_parameters([Parameter("x", value=6)])[0].reason == "too big"
    node.remove_on_set_parameters_callback(refuse)
    assert node.set_parameters([Parameter("x", value=6)])[0].successful


def test_the_on_set_callback_can_reject_without_a_reason(node: Node) -> None:
    node.declare_parameter("x", 1)
    node.add_on_set_parameters_callback(lambda _: SetParametersResult(successful=False))
    assert not node.set_parameters([Parameter("x", value=6)])[0].successful
    with pytest.raises(InvalidParameterValueException):
        node.declare_parameter("y", 1)
    assert not node.has_parameter("y")


def test_the_pre_set_callback_can_change_and_the_post_set_callback_runs_after(
    node: Node,
) -> None:
    seen: list[Any] = []

    def double(parameters: list[Parameter[Any]]) -> list[Parameter[Any]]:
        return [Parameter(p.name, value=p.value * 2) for p in parameters]

    def note(parameters: list[Parameter[Any]]) -> None:
        seen.extend((p.name, p.value) for p in parameters)

    node.declare_parameter("x", 1)
    node.add_pre_set_parameters_callback(double)
    node.add_post_set_parameters_callback(note)
    node.set_parameters([Parameter("x", value=4)])
    node.remove_pre_set_parameters_callback(double)
    node.set_parameters([Parameter("x", value=4)])
    node.remove_post_set_parameters_callback(note)
    node.set_parameters([Parameter("x", value=5)])
    assert seen == [("x", 8), ("x", 4)]


def test_events_contain_the_changes(graph: GraphHarness) -> None:
    events = graph.collect("/parameter_events", "rcl_interfaces/msg/ParameterEvent")
    graph.run_for(1.0)
    node = graph.add(Node("n", context=graph.context, allow_undeclared_parameters=True))
    graph.run_for(0)
    events.clear()
    node.declare_parameter("x", 1)
    node.set_parameters([Parameter("x", value=2)])
    node.set_parameters([Parameter("dyn", value=1)])
    node.set_parameters([Parameter("dyn", T.NOT_SET)])
    graph.run_for(0)
    names = [
        (
            [p.name for p in e.new_parameters],
            [p.value.integer_value for p in e.changed_parameters],
            [p.name for p in e.deleted_parameters],
        )
        for e in events.messages
    ]
    assert names == [
        (["x"], [], []),
        ([], [2], []),
        (["dyn"], [], []),
        ([], [], ["dyn"]),
    ]
    assert events.last.node == "/n"
    assert events.last.stamp.sec == 1


def test_the_error_of_a_callback_without_result_names_it(node: Node) -> None:
    node.declare_parameter("speed", 1.0)

    def check(parameters: list[Parameter]) -> None:
        pass

    node.add_on_set_parameters_callback(check)  # type: ignore[arg-type]
    with pytest.raises(AttributeError, match=r"check at .* returned None, expected"):
        node.set_parameters([Parameter("speed", value=2.0)])
    assert node.get_parameter("speed").value == 1.0


def test_programs_read_the_private_table_of_parameters(node: Node) -> None:
    node.declare_parameter("speed", 1.5)
    assert node._parameters["speed"].value == 1.5  # type: ignore[attr-defined]
    assert "speed" in node._descriptors  # type: ignore[attr-defined]
    node._parameters = "a node's own"  # type: ignore[attr-defined]
    assert node._parameters == "a node's own"  # type: ignore[attr-defined]
    assert node.get_parameter("speed").value == 1.5
