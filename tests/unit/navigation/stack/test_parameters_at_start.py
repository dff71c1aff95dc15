"""Extreme parameters on the command line: each stage refuses them before it starts."""

from dataclasses import fields
from typing import Any

import pytest

from navette.errors import ParameterError
from navette.navigation.stack.stage_classes import node_classes
from navette.params import Params
from navette.runtime import Context, VirtualClock
from navette.sim import World, load_robot
from navette.sim.node import SimNode

_NUMBERS = (".nan", ".inf", "-.inf", "1e308", "-1e308", "1e20")
_INTEGERS = ("9223372036854775807", "-9223372036854775808", "1.5")
_OTHERS = {float: _NUMBERS, int: _INTEGERS, bool: ("7", "perhaps"), str: ()}


#: Without an input the filter has another error.
NEEDED = {"ekf": ("-p", "odom0:=/odom")}
#: Any seed is allowed.
ANY = {
    "seed": ("-9223372036854775808", "1.5"),
    "random_seed": ("-9223372036854775808", "1.5"),
}


def values_of(params: type[Params], name: str) -> tuple[str, ...]:
    default = getattr(params(), name)
    if isinstance(default, tuple):
        return tuple(f"[{each}]" for each in _NUMBERS)
    return ANY.get(name) or _OTHERS[type(default)]


def make(name: str, node_class: Any, context: Context) -> None:
    if node_class is SimNode:
        robot = load_robot("turtlebot3_burger").model
        SimNode(World("room").add_robot(robot).scene(), context=context)
    else:
        node_class(context=context)


@pytest.mark.parametrize(
    ("name", "node_class"), node_classes(), ids=[name for name, _ in node_classes()]
)
def test_extreme_parameters_are_refused_at_the_start(
    name: str, node_class: Any
) -> None:
    params = node_class.PARAMS
    for field in fields(params):
        for value in values_of(params, field.name):
            given = f"{name}:{field.name}:={value}"
            context = Context(clock=VirtualClock())
            context.init(["--ros-args", "-p", given, *NEEDED.get(name, ())])
            with pytest.raises(ParameterError) as caught:
                make(name, node_class, context)
            assert list(context.nodes) == []
            context.shutdown()
            text = str(caught.value)
            assert field.name in text, given
            number = value.strip("[]").lstrip("-.").rstrip("]")
            assert number[:4].lower() in text.lower().replace("e+", "e"), text
            assert any(
                word in text for word in ("must be", "expected", "out of range")
            ), text
