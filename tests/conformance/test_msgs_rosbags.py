"""Bytes, hashes and definitions compared with rosbags."""

from array import array
from typing import Any

import numpy as np
import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from navette.msgs import (
    Message,
    definition_text,
    deserialize,
    fields,
    get_interface,
    serialize,
    type_hash,
)
from navette.msgs.interface import PLACEHOLDER, Field
from navette.runtime.testing.messages import random_message

STORE = get_typestore(Stores.ROS2_JAZZY)
NOT_OURS = ("rmw_dds_common", "rosbag2_interfaces")
SHARED = sorted(name for name in STORE.fielddefs if not name.startswith(NOT_OURS))
# rosbags hashes ``char`` as 13; ROS 2 hashes it as uint8, 3 (see the golden hashes).
WITH_CHAR = {"service_msgs/msg/ServiceEventInfo", "std_msgs/msg/Char"}


def as_rosbags(message: Message) -> Any:
    """Convert a message to rosbags' class."""
    values = {
        field.name: _value(field, getattr(message, field.name))
        for field in fields(message)
    }
    return STORE.types[message._type_name_](**(values or {PLACEHOLDER: 0}))


def _value(field: Field, value: Any) -> Any:
    if isinstance(value, bytes):
        return int.from_bytes(value, signed=True)  # it takes a byte for an int8
    if field.type.base in ("bool", "byte") and isinstance(value, list):
        octets = b"".join(value) if field.type.base == "byte" else bytes(value)
        return np.frombuffer(octets, "?" if field.type.base == "bool" else "i1")
    if isinstance(value, array):
        return np.asarray(value)
    if not field.type.is_message:
        return value
    return as_rosbags(value) if field.type.is_scalar else [*map(as_rosbags, value)]


@pytest.mark.parametrize("name", SHARED)
def test_bytes_are_identical(name: str) -> None:
    rng = np.random.default_rng(len(name))
    for _ in range(10):
        message = random_message(get_interface(name), rng)
        theirs = as_rosbags(message)
        assert serialize(message) == bytes(STORE.serialize_cdr(theirs, name))
        big_endian = STORE.serialize_cdr(theirs, name, little_endian=False)
        assert deserialize(bytes(big_endian), type(message)) == message


@pytest.mark.parametrize("name", SHARED)
def test_hashes_are_identical(name: str) -> None:
    assert (type_hash(name) == STORE.hash_rihs01(name)) != (name in WITH_CHAR)


@pytest.mark.parametrize("name", SHARED)
def test_definitions_are_identical(name: str) -> None:
    """rosbags reads its own fields and constants from Navette's text."""
    constants, defined = get_types_from_msg(definition_text(name), name)[name]
    known_constants, known_fields = STORE.fielddefs[name]
    # The placeholder member is not part of a definition text.
    named = [each for each in known_fields if each[0] != PLACEHOLDER]
    assert list(defined) == named
    assert sorted(map(repr, constants)) == sorted(map(repr, known_constants))
