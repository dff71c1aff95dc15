"""Parameters of other processes: read, described, set, refused, dropped."""

import math
from types import SimpleNamespace
from typing import Any

import pytest
from remote_fakes import World, encoded

from navette.msgs.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from navette.viewer.frames import WireParameter
from navette.viewer.parameters import ParameterText
from navette.viewer.remote_parameters import RemoteParameters

ID = bytes(16)


class Far(World):
    """A node ``/far`` with two parameters, and the viewer's cache of them."""

    def __init__(self) -> None:
        super().__init__()
        self.have = {"speed": 1.0, "method": "a"}
        self.refusal = ""
        self.changed: list[WireParameter] = []
        self.texts: list[ParameterText] = []
        self.remote = RemoteParameters(
            self,  # type: ignore[arg-type]
            bridge=self.bridge,
            graph=self,
            service_calls=self.service_calls,
            clock=self.clock,
        )
        self.answers = {
            "/far/list_parameters": self.on_list,
            "/far/get_parameters": self.on_get,
            "/far/describe_parameters": self.on_describe,
            "/far/set_parameters": self.on_set,
        }
        self.remote.set_nodes({"/far": ID})

    def parameters_changed(self, parameters: list[WireParameter]) -> None:
        self.changed += parameters

    def set_parameter_texts(self, texts: list[ParameterText]) -> None:
        self.texts += texts

    def on_list(self, _request: Any) -> Any:
        return SimpleNamespace(result=SimpleNamespace(names=list(self.have)))

    def on_get(self, request: Any) -> Any:
        values = [encoded(name, self.have[name]).value for name in request.names]
        return SimpleNamespace(values=values)

    def on_describe(self, request: Any) -> Any:
        bounds = FloatingPointRange(from_value=0.0, to_value=2.0)
        speed = ParameterDescriptor(description="how fast [m/s]")
        speed.floating_point_range = [bounds]
        method = ParameterDescriptor(additional_constraints="one of a, b")
        known = {"speed": speed, "method": method}
        return SimpleNamespace(descriptors=[known[name] for name in request.names])

    def on_set(self, request: Any) -> Any:
        result = SetParametersResult(successful=not self.refusal, reason=self.refusal)
        return SimpleNamespace(results=[result])

    def set(self, name: str, value: Any, kind: str | None = None) -> list[str]:
        reasons: list[str] = []
        self.remote.set(WireParameter(name, value, kind), reasons.append)
        return reasons


@pytest.fixture
def far() -> Far:
    return Far()


def test_values_and_texts_are_read_once(far: Far) -> None:
    done: list[bool] = []
    far.remote.fetch(lambda: done.append(True))
    assert done == [True]
    assert far.remote.values["/far.speed"] == WireParameter(
        "/far.speed", 1.0, "float64"
    )
    assert [wire.value for wire in far.changed] == [1.0, "a"]
    assert far.texts[0] == ParameterText(
        "/far.speed", "how fast [m/s]", low=0.0, high=2.0
    )
    assert far.texts[1].allowed == "one of a, b"
    assert len(far.asked()) == 3
    far.remote.fetch()
    assert far.asked() == []


def test_concurrent_requests_share_one_call(far: Far) -> None:
    answer = far.answers.pop("/far/list_parameters")
    done: list[int] = []
    for number in (1, 2):
        far.remote.fetch(lambda number=number: done.append(number))  # type: ignore[misc]
    (call,) = far.calls
    assert done == []
    call.future.set_result(answer(None))
    assert done == [1, 2]


def test_a_frozen_node_times_out_and_is_called_again_later(far: Far) -> None:
    del far.answers["/far/list_parameters"]
    done: list[bool] = []
    far.remote.fetch(lambda: done.append(True))
    far.clock.now_s += 2.1
    far.service_calls.expire()
    assert done == [True]
    far.asked()
    far.remote.fetch()
    assert far.asked() == []
    far.clock.now_s += 3.0
    far.remote.fetch()
    assert far.asked() == ["/far/list_parameters"]


def test_a_set_value_takes_the_type_of_the_parameter(far: Far) -> None:
    assert far.set("/far.speed", 2) == [""]  # read first, to know the kind
    request = far.calls[-1].request
    (message,) = request.parameters
    assert (message.name, message.value.double_value) == ("speed", 2.0)
    assert far.remote.values["/far.speed"].value == 2.0


def test_a_refusal_has_the_reason_of_the_node(far: Far) -> None:
    far.refusal = "too fast"
    assert far.set("/far.speed", 9.0) == ["too fast"]
    assert far.remote.values["/far.speed"].value == 1.0
    del far.answers["/far/set_parameters"]
    reasons = far.set("/far.speed", 1.5)
    far.clock.now_s += 2.1
    far.service_calls.expire()
    assert reasons == ["node /far: no response in 2 s"]
    assert "not a number" in far.set("/far.speed", "fast", "float64")[0]


def test_parameters_of_a_node_that_left_are_dropped(far: Far) -> None:
    far.remote.fetch()
    far.changed.clear()
    far.remote.set_nodes({})
    assert {(wire.name, wire.value) for wire in far.changed} == {
        ("/far.speed", None),
        ("/far.method", None),
    }
    assert not far.remote.values
    assert not far.remote.serves("/far")


def test_a_restarted_node_of_the_same_name_is_read_again(far: Far) -> None:
    far.remote.fetch()
    far.have = {"speed": 0.5}
    far.remote.set_nodes({"/far": b"another one's id"})
    far.remote.fetch()
    assert {n: w.value for n, w in far.remote.values.items()} == {"/far.speed": 0.5}


def test_a_request_to_a_node_that_leaves_fails(far: Far) -> None:
    del far.answers["/far/list_parameters"]
    reasons = far.set("/far.speed", 1.5)
    far.remote.set_nodes({})
    assert reasons == ["node /far left the graph"]


def test_parameter_events_of_unknown_nodes_are_kept(far: Far) -> None:
    far.remote.store("/player", [("rate", encoded("rate", 2.0).value)])
    assert far.remote.values["/player.rate"].value == 2.0
    far.remote.drop("/player", ["rate"])
    assert far.changed[-1] == WireParameter("/player.rate", None)
    assert "/player.rate" not in far.remote.values


@pytest.mark.parametrize(
    ("low", "high"), [(math.nan, 1.0), (0.0, math.inf), (2.0, 1.0), (1.0, 1.0)]
)
def test_an_invalid_range_is_omitted(low: float, high: float) -> None:
    bounds = FloatingPointRange(from_value=low, to_value=high)
    text = ParameterText.of("/a.b", ParameterDescriptor(floating_point_range=[bounds]))
    assert (text.low, text.high) == (None, None)


def test_a_range_of_whole_numbers_has_its_step() -> None:
    bounds = IntegerRange(from_value=0, to_value=10, step=5)
    descriptor = ParameterDescriptor(
        integer_range=[bounds], read_only=True, description="x" * 10_000
    )
    text = ParameterText.of("/a.b", descriptor)
    assert (text.low, text.high, text.step, text.read_only) == (0.0, 10.0, 5.0, True)
    assert len(text.meaning) == 500
