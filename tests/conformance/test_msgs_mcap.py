"""Bytes and definition texts, decoded by mcap-ros2-support."""

import math
from typing import Any

import numpy as np
import pytest
from mcap_ros2._dynamic import generate_dynamic

from navette.msgs import (
    definition_text,
    get_interface,
    interface_names,
    packages,
    serialize,
    to_dict,
)
from navette.msgs.interface import MessageSpec, short_name
from navette.msgs.registry import DEFINITIONS, get_message_spec
from navette.runtime.testing.messages import random_message

# mcap-ros2-support has no wstring, and reads a char as text, not as a byte.
FAULTS = ("wstring", "char")


def is_read_rightly(spec: MessageSpec) -> bool:
    """Whether the peer supports the types of all fields, nested ones too."""

    return all(
        is_read_rightly(get_message_spec(field.type.base))
        if field.type.is_message
        else field.type.base not in FAULTS
        for field in spec.fields
    )


NAMES = [
    name
    for package in packages()
    if (DEFINITIONS / package).is_dir()
    for stem in interface_names(package, "msg")
    if is_read_rightly(get_message_spec(name := f"{package}/msg/{stem}"))
]


def plain(value: Any) -> Any:
    """Convert a message of the peer as to_dict does."""
    if hasattr(value, "__slots__"):
        return {name: plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, bytes | bytearray):
        return list(value)
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def same(mine: Any, theirs: Any) -> bool:
    if isinstance(mine, dict):
        return all(same(value, theirs[name]) for name, value in mine.items())
    if isinstance(mine, list):
        return len(mine) == len(theirs) and all(map(same, mine, theirs))
    if isinstance(mine, float):
        return math.isclose(mine, theirs, rel_tol=1e-6)
    return bool(mine == theirs)


@pytest.mark.parametrize("name", NAMES)
def test_decoded_values_are_equal(name: str) -> None:
    decode = generate_dynamic(short_name(name), definition_text(name))
    rng = np.random.default_rng(len(name))
    for _ in range(3):
        message = random_message(get_interface(name), rng)
        theirs = decode[short_name(name)](serialize(message))
        assert same(to_dict(message), plain(theirs))
