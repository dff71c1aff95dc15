"""Base of the stages: inputs, outputs, parameters and status."""

from dataclasses import dataclass
from typing import Any

import pytest

from navette.errors import CallbackError, ParameterError, UnknownNameError
from navette.msgs.std_msgs.msg import String
from navette.params import Params, param
from navette.runtime import (
    Input,
    Node,
    Output,
    Parameter,
    StageNode,
    StatusReporter,
    status_output,
)
from navette.runtime.stage.params import declare_params
from navette.runtime.testing import GraphHarness


@dataclass(frozen=True, kw_only=True)
class EchoParams(Params):
    """A field of every type."""

    gain: float = param(1.0, "how much", unit="m", at_least=0.0, at_most=3.0)
    times: int = param(2, "how often", at_least=1, at_most=9)
    limit: float = param(5.0, "open above", above=0.0)
    mode: str = param("plain", "which way", choices=("plain", "loud"))
    on: bool = param(True, "whether")
    corners: tuple[float, ...] = param((), "x1, y1, …")
    low: float = param(0.0, "below high")
    high: float = param(1.0, "above low")

    def check(self) -> None:
        if self.low >= self.high:
            raise ParameterError(f"low {self.low} must be below high {self.high}")


class Echo(StageNode):
    """Publishes its input."""

    PARAMS = EchoParams
    INPUTS = (
        Input(
            topic="in",
            type="std_msgs/msg/String",
            role="what to repeat",
            callback="on_text",
            timeout_s=0.5,
        ),
        Input(
            topic="/map",
            type="std_msgs/msg/String",
            role="latched",
            callback="on_map",
            depth=1,
            latched=True,
        ),
    )
    OUTPUTS = (
        Output(topic="out", type="std_msgs/msg/String", role="repeated", latched=True),
        status_output("/echo/status"),
    )

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("echo", **kwargs)
        self.maps: list[String] = []
        self.changes: list[tuple[Any, Any]] = []

    def on_text(self, message: String) -> None:
        if message.data == "raise":
            raise ValueError("requested")
        self.publish("out", String(data=message.data * self.params.times))

    def on_map(self, message: String) -> None:
        self.maps.append(message)

    def on_params_changed(self, old: Any) -> None:
        self.changes.append((old.times, self.params.times))


def harness(*args: str) -> tuple[GraphHarness, Echo]:
    graph = GraphHarness(args=["--ros-args", *args] if args else [])
    return graph, graph.add(Echo(context=graph.context))


def test_inputs_and_outputs_are_connected() -> None:
    graph, _ = harness()
    graph.publish("/map", String(data="early"), latched=True)
    out = graph.collect("out", String)
    graph.publish("in", String(data="ab"))
    graph.run_for(0)
    assert out.last.data == "abab"


def test_a_latched_input_receives_earlier_messages() -> None:
    graph = GraphHarness()
    message = String(data="early")
    graph.publish("/map", message, latched=True)
    node = graph.add(Echo(context=graph.context))
    graph.run_for(0)
    assert node.maps == [message]


def test_inputs_are_shared_copies_of_the_publishers_message() -> None:
    graph, node = harness()
    second = graph.add(_Second(context=graph.context))
    message = String(data="one")
    graph.publish("/map", message, latched=True)
    message.data = "edited"
    graph.run_for(0)
    assert node.maps[0].data == "one"
    assert node.maps[0] is second.maps[0]


class _Second(Echo):
    def __init__(self, **kwargs: Any) -> None:
        super().__init__(cli_args=["-r", "__node:=second"], **kwargs)


def test_staleness_by_arrival() -> None:
    graph, node = harness()
    assert node.is_stale("in")
    graph.publish("in", String())
    graph.run_for(0.5)
    assert not node.is_stale("in")
    graph.run_for(0.1)
    assert node.is_stale("in")
    assert node.is_stale("/map")
    graph.publish("/map", String(), latched=True)
    graph.run_for(100.0)
    assert not node.is_stale("/map")  # no timeout: once there, it stays good
    with pytest.raises(UnknownNameError, match=r"input 'x'; known: /map, in"):
        node.is_stale("x")


def test_the_error_of_an_unknown_output_lists_the_known_ones() -> None:
    graph, node = harness()
    with pytest.raises(
        UnknownNameError, match="output 'outt'; known: /echo/status, out"
    ):
        node.publish("outt", String())
    assert not node.has_listeners("out")
    graph.collect("out", String)
    assert node.has_listeners("out")


def test_remapped_topics_keep_their_declared_names() -> None:
    graph, node = harness("-r", "in:=/elsewhere", "-r", "out:=/result")
    out = graph.collect("/result", String)
    graph.publish("/elsewhere", String(data="x"))
    graph.run_for(0)
    assert out.last.data == "xx"
    assert not node.is_stale("in")


def test_an_exception_in_a_callback_names_the_stage_and_the_topic() -> None:
    graph, _ = harness()
    graph.publish("in", String(data="raise"))
    with pytest.raises(CallbackError, match=r"node /echo: callback of topic /in"):
        graph.run_for(0)


def test_given_parameters_become_the_dataclass() -> None:
    _, node = harness("-p", "echo:gain:=2", "-p", "echo:corners:=[1, 2.5]")
    assert node.params == EchoParams(gain=2.0, corners=(1.0, 2.5))
    assert node.get_parameter("mode").value == "plain"


def test_descriptors_have_text_range_and_choices() -> None:
    _, node = harness()
    gain = node.describe_parameter("gain")
    assert gain.description == "how much [m]"
    assert gain.floating_point_range[0].to_value == 3.0
    assert node.describe_parameter("times").integer_range[0].from_value == 1
    assert (
        "one of plain, loud" in node.describe_parameter("mode").additional_constraints
    )
    limit = node.describe_parameter("limit")
    assert (limit.additional_constraints, len(limit.floating_point_range)) == ("> 0", 0)


@pytest.mark.parametrize(
    ("argument", "reason"),
    [
        ("echo:gain:=7", r"'gain'.*out of range 0 … 3.*command line"),
        ("echo:mode:=fast", r"'mode'.*'fast'.*one of plain, loud"),
        ("echo:times:=1.5", r"'times'.*DOUBLE.*INTEGER"),
        (
            "echo:tmes:=1",
            r"command line -p echo:tmes.*/echo.*'tmes'; did you mean 'times'\? \(all",
        ),
        ("echo:low:=2.0", r"/echo: low 2.0 must be below high"),
    ],
)
def test_wrong_given_values_are_errors(argument: str, reason: str) -> None:
    with pytest.raises(ParameterError, match=reason):
        harness("-p", argument)


def test_a_failed_stage_leaves_nothing_in_the_graph() -> None:
    graph = GraphHarness(args=["--ros-args", "-p", "echo:gain:=7"])
    before = graph.context.graph.endpoints()
    with pytest.raises(ParameterError):
        Echo(context=graph.context)
    assert graph.context.graph.endpoints() == before
    assert graph.context.nodes == [graph.node]


def test_unknown_values_for_all_nodes_are_ignored() -> None:
    _, node = harness("-p", "something:=1")
    assert node.params == EchoParams()


def test_changes_are_checked_and_reported() -> None:
    _, node = harness()

    def outcome(name: str, value: Any) -> str:
        return str(node.set_parameters([Parameter(name, value=value)])[0].reason)

    assert outcome("times", 3) == ""
    assert node.params.times == 3
    assert node.changes == [(2, 3)]
    assert "one of plain, loud" in outcome("mode", "fast")
    assert "must be below" in outcome("low", 4.0)
    assert "> 0" in outcome("limit", 0.0)
    assert outcome("corners", [1.0, 2.0]) == ""
    assert node.params.corners == (1.0, 2.0)
    assert outcome("use_sim_time", True) == ""
    assert len(node.changes) == 2
    both = [Parameter("low", value=4.0), Parameter("high", value=5.0)]
    assert node.set_parameters_atomically(both).successful


def test_declare_params_on_any_node() -> None:
    graph = GraphHarness(args=["--ros-args", "-p", "times:=4"])
    node = Node("plain", context=graph.context)
    assert declare_params(node, EchoParams) == EchoParams(times=4)


def test_status_on_change_and_then_twice_a_second() -> None:
    graph, node = harness()
    status = StatusReporter(node, "/echo/status")
    seen = graph.collect("/echo/status", "diagnostic_msgs/msg/DiagnosticStatus")
    graph.run_for(0.6)
    assert seen.count == 0
    status.report("planning", distance_left_m=1.5, goal_id=3)
    status.report("planning", distance_left_m=1.25, goal_id=3)
    graph.run_for(0.0)
    assert seen.count == 1
    graph.run_for(1.0)
    assert seen.count == 3
    assert [(v.key, v.value) for v in seen.last.values] == [
        ("distance_left_m", "1.250"),
        ("goal_id", "3"),
    ]
    status.report("no_path", StatusReporter.ERROR)
    graph.run_for(0.0)
    assert (seen.last.name, seen.last.message, seen.last.level) == (
        "echo",
        "no_path",
        StatusReporter.ERROR,
    )
    assert status.state == "no_path"
    late = graph.collect(
        "/echo/status", "diagnostic_msgs/msg/DiagnosticStatus", latched=True
    )
    graph.run_for(0.0)
    assert late.last.message == "no_path"


def test_a_node_with_an_invalid_parameter_is_removed() -> None:
    graph = GraphHarness()
    graph.context.overrides.add("echo", {"gain": 9.0}, "test")
    with pytest.raises(ParameterError, match="gain"):
        Echo(context=graph.context)
    assert [node.get_name() for node in graph.context.nodes] == ["harness"]
