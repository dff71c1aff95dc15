"""Copies share nothing with their original."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from navette.errors import MessageError
from navette.msgs import (
    Message,
    copy_message,
    deserialize,
    fields,
    get_interface,
    interface_names,
    packages,
    serialize,
)
from navette.msgs.geometry_msgs.msg import Point, Twist, Vector3
from navette.msgs.sensor_msgs.msg import JointState, LaserScan
from navette.msgs.std_msgs.msg import ColorRGBA
from navette.msgs.visualization_msgs.msg import Marker
from navette.runtime.testing.messages import random_message

MESSAGES = [
    f"{package}/msg/{name}"
    for package in packages()
    for name in interface_names(package, "msg")
]


def mutable_parts(message: Message) -> Iterator[Any]:
    """All mutable objects inside a message."""
    yield message
    for field in fields(message):
        value = getattr(message, field.name)
        for part in value if isinstance(value, list) else (value,):
            if isinstance(part, Message):
                yield from mutable_parts(part)
        is_filled_array = isinstance(value, np.ndarray) and value.size
        if isinstance(value, list) or is_filled_array:
            yield value


@pytest.mark.parametrize("name", MESSAGES)
def test_a_copy_is_equal_and_independent(name: str) -> None:
    message = random_message(get_interface(name), np.random.default_rng(7))
    copied = copy_message(message)
    assert type(copied) is type(message)
    assert copied == message
    mine = {id(part) for part in mutable_parts(message)}
    assert mine.isdisjoint(id(part) for part in mutable_parts(copied))


def test_the_error_names_the_invalid_list_element() -> None:
    marker = Marker(points=[Point()])
    marker.points.append("here")  # type: ignore[arg-type]
    with pytest.raises(MessageError, match=r"Marker\.points\[1\]: 'here' is str"):
        copy_message(marker)


def test_only_messages_are_copied() -> None:
    with pytest.raises(MessageError, match="not a message class"):
        copy_message(3)  # type: ignore[type-var]


def test_subclasses_are_copied() -> None:
    class Command(Twist):
        """A user's subclass."""

    command = Command(linear=Vector3(x=1.0))
    assert type(copy_message(command)) is Command
    assert copy_message(JointState(name=["a"])).name == ["a"]


def test_a_copy_equals_a_serialised_message() -> None:
    scan = LaserScan(angle_min=0.1, range_max=30.3, ranges=[0.1])
    copied = copy_message(scan)
    assert copied == deserialize(serialize(scan), LaserScan)
    assert copied.angle_min == float(np.float32(0.1)) != 0.1
    assert scan.angle_min == 0.1
    marker = Marker(colors=[ColorRGBA(r=0.3)])
    assert copy_message(marker).colors[0].r == float(np.float32(0.3))


@pytest.mark.parametrize("value", [float("inf"), float("-inf"), float("nan"), 1e-45])
def test_infinity_and_nan_are_copied(value: float) -> None:
    copied = copy_message(LaserScan(range_max=value))
    assert np.array_equal(copied.range_max, np.float32(value), equal_nan=True)
