"""Stages whose methods have parameters of their own."""

from dataclasses import dataclass
from typing import Any

import pytest

from navette.errors import ParameterError
from navette.params import Params, param
from navette.params.plugins import MethodRegistry
from navette.runtime import Parameter, StageNode
from navette.runtime.testing import GraphHarness

HORNS = MethodRegistry("horn", "navette.test_horns", {"sound": ()})


@HORNS.register("plain")
class PlainHorn:
    def sound(self) -> str:
        return "a"


@HORNS.register("loud")
@dataclass
class LoudHorn:
    volume_db: float = param(90.0, "volume", at_least=0.0, at_most=120.0)
    pitch_hz: float = 1.0

    def sound(self) -> str:
        return "A"


@dataclass(frozen=True, kw_only=True)
class HornParams(Params):
    method: str = param("plain", "how it sounds", choices=HORNS)
    pitch_hz: float = param(440.0, "pitch", unit="Hz", above=0.0)


class HornNode(StageNode):
    PARAMS = HornParams

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("horn", **kwargs)
        self.changes: list[str] = []

    def on_params_changed(self, old: HornParams) -> None:
        self.changes.append(self.params.method)


def given(**values: Any) -> list[Parameter[Any]]:
    return [Parameter(name, value=value) for name, value in values.items()]


def test_the_fields_of_the_method_are_parameters_of_the_node() -> None:
    with GraphHarness() as graph:
        node = HornNode(
            context=graph.context,
            parameter_overrides=given(method="loud", volume_db=60.0),
        )
        assert node.params.volume_db == 60.0
        descriptor = node.describe_parameter("volume_db")
        assert descriptor.floating_point_range[0].to_value == 120.0
        [refused] = node.set_parameters(given(volume_db=130.0))
        assert not refused.successful
        [accepted] = node.set_parameters(given(volume_db=70.0))
        assert accepted.successful
        method = HORNS.load(node.params.method).make(node.params)
        assert (method.volume_db, method.pitch_hz) == (70.0, 440.0)


def test_another_method_brings_its_parameters_and_takes_the_old_ones_away() -> None:
    with GraphHarness() as graph:
        node = HornNode(context=graph.context)
        assert not node.has_parameter("volume_db")
        [result] = node.set_parameters(given(method="loud"))
        assert result.successful, result.reason
        assert node.get_parameter("volume_db").value == 90.0
        [result] = node.set_parameters(given(method="plain"))
        assert result.successful, result.reason
        assert not node.has_parameter("volume_db")
        assert node.changes == ["loud", "plain"]


@pytest.mark.parametrize("place", ["/etc/hosts.py", "os:system", "silent"])
def test_a_file_or_module_cannot_be_chosen_while_the_node_runs(place: str) -> None:
    with GraphHarness() as graph:
        node = HornNode(context=graph.context)
        [result] = node.set_parameters(given(method=place))
        assert not result.successful
        assert "not a registered method" in result.reason
        assert "known: plain, loud" in result.reason
        assert node.params.method == "plain"


def test_unknown_parameters_list_those_of_the_method() -> None:
    match = r"no parameter 'volume'; did you mean 'volume_db'\?; known: .*method"
    with GraphHarness() as graph, pytest.raises(ParameterError, match=match):
        HornNode(
            context=graph.context,
            parameter_overrides=given(method="loud", volume=60.0),
        )
