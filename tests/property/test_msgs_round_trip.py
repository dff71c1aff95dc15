"""CDR round trips of every type; damaged bytes raise only DecodeError."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from navette.errors import DecodeError
from navette.msgs import (
    Message,
    copy_message,
    deserialize,
    from_dict,
    get_interface,
    interface_names,
    packages,
    serialize,
    to_dict,
)
from navette.msgs.interface import MessageSpec
from navette.msgs.registry import DEFINITIONS, KINDS, get_spec
from navette.runtime.testing.messages import random_message


def message_names() -> list[str]:
    """All messages of Navette, parts of services and actions too."""
    names = []
    for package in packages():
        if not (DEFINITIONS / package).is_dir():
            continue
        for kind in KINDS:
            for stem in interface_names(package, kind):
                spec = get_spec(f"{package}/{kind}/{stem}")
                parts = [spec] if isinstance(spec, MessageSpec) else spec.parts()
                names += [part.name for part in parts]
    return names


names = st.sampled_from(message_names())
seeds = st.integers(0, 2**32 - 1)


def drawn(name: str, seed: int) -> Message:
    return random_message(get_interface(name), np.random.default_rng(seed))


@given(name=names, seed=seeds)
@settings(max_examples=500)
def test_round_trip(name: str, seed: int) -> None:
    message = drawn(name, seed)
    data = serialize(message)
    assert len(data) > 4
    assert deserialize(data, type(message)) == message
    assert serialize(deserialize(data, type(message))) == data
    assert copy_message(message) == message
    assert from_dict(type(message), to_dict(message)) == message


@given(name=names, seed=seeds, cut=st.floats(0, 1))
@settings(max_examples=500)
def test_truncated_bytes(name: str, seed: int, cut: float) -> None:
    message = drawn(name, seed)
    data = serialize(message)
    try:
        decoded = deserialize(data[: int(cut * len(data))], type(message))
    except DecodeError:
        return
    assert cut == 1.0
    assert decoded == message


@given(
    name=names,
    seed=seeds,
    flips=st.lists(st.tuples(st.floats(0, 1), st.integers(0, 7)), min_size=1),
)
@settings(max_examples=1000)
def test_flipped_bits(name: str, seed: int, flips: list[tuple[float, int]]) -> None:
    message = drawn(name, seed)
    data = bytearray(serialize(message))
    for position, bit in flips:
        data[int(position * (len(data) - 1))] ^= 1 << bit
    try:
        decoded = deserialize(data, type(message))
    except DecodeError:
        return
    # An accepted message is valid: it can be serialised.
    serialize(decoded)


@given(name=names, data=st.binary(max_size=300))
@settings(max_examples=1000)
def test_any_bytes(name: str, data: bytes) -> None:
    for head in (b"\x00\x01\x00\x00", b"\x00\x00\x00\x00"):
        try:
            serialize(deserialize(head + data, get_interface(name)))
        except DecodeError:
            continue
