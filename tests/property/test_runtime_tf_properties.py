"""Transforms: group axioms over random trees, interpolation between samples."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.geometry import Transform3, quaternion_from_rpy
from navette.runtime.tf.buffer_core import BufferCore

S = 1_000_000_000
coordinate = st.floats(-10, 10)
angle = st.floats(-3.0, 3.0)
transforms = st.builds(
    lambda t, r: Transform3(t, quaternion_from_rpy(*r)),
    st.tuples(coordinate, coordinate, coordinate),
    st.tuples(angle, st.floats(-1.5, 1.5), angle),
)


def matrix(transform: Transform3) -> np.ndarray:
    """4×4 homogeneous matrix, independent of the class's own products."""
    x, y, z, w = transform.rotation
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    result = np.eye(4)
    result[:3, :3] = rotation
    result[:3, 3] = transform.translation
    return result


@st.composite
def trees(draw: st.DrawFn) -> tuple[BufferCore, dict[str, np.ndarray]]:
    """A random tree of frames and, for each, the matrix root_T_frame."""
    core = BufferCore(10 * S)
    root_T: dict[str, np.ndarray] = {"f0": np.eye(4)}
    for index in range(1, draw(st.integers(2, 8))):
        parent = f"f{draw(st.integers(0, index - 1))}"
        transform = draw(transforms)
        is_static = draw(st.booleans())
        core.set(parent, f"f{index}", S, transform, is_static=is_static)
        root_T[f"f{index}"] = root_T[parent] @ matrix(transform)
    return core, root_T


@given(trees(), st.data())
def test_chains_equal_products_of_matrices(
    tree: tuple[BufferCore, dict[str, np.ndarray]], data: st.DataObject
) -> None:
    core, root_T = tree
    frames = sorted(root_T)
    a, b, c = (data.draw(st.sampled_from(frames)) for _ in range(3))
    a_T_b = matrix(core.lookup(a, b, S)[0])
    assert a_T_b == pytest.approx(np.linalg.inv(root_T[a]) @ root_T[b], abs=1e-6)
    b_T_c = matrix(core.lookup(b, c, S)[0])
    a_T_c = matrix(core.lookup(a, c, S)[0])
    assert a_T_b @ b_T_c == pytest.approx(a_T_c, abs=1e-6)
    b_T_a = matrix(core.lookup(b, a, S)[0])
    assert a_T_b @ b_T_a == pytest.approx(np.eye(4), abs=1e-6)


@given(transforms, transforms, st.integers(1, S - 1))
def test_interpolation_lies_between_its_ends(
    start: Transform3, end: Transform3, offset_ns: int
) -> None:
    core = BufferCore(10 * S)
    core.set("a", "b", S, start, is_static=False)
    core.set("a", "b", 2 * S, end, is_static=False)
    fraction = offset_ns / S
    found = core.lookup("a", "b", S + offset_ns)[0]
    expected = [
        (1 - fraction) * p + fraction * q
        for p, q in zip(start.translation, end.translation, strict=True)
    ]
    assert found.translation == pytest.approx(expected, abs=1e-9)
    assert math.hypot(*found.rotation) == pytest.approx(1.0)

    def turn(p: Transform3, q: Transform3) -> float:
        dot = abs(sum(m * n for m, n in zip(p.rotation, q.rotation, strict=True)))
        return 2 * math.acos(min(1.0, dot))

    whole = turn(start, end)
    assert turn(start, found) == pytest.approx(fraction * whole, abs=1e-5)
    assert turn(found, end) == pytest.approx((1 - fraction) * whole, abs=1e-5)


@given(st.lists(st.integers(1, 1000), min_size=1, max_size=40, unique=True))
def test_the_order_of_arrival_does_not_matter(stamps: list[int]) -> None:
    in_order, shuffled = BufferCore(10 * S), BufferCore(10 * S)
    for core, order in ((in_order, sorted(stamps)), (shuffled, stamps)):
        for stamp in order:
            sample = Transform3((float(stamp), 0, 0), (0, 0, 0, 1))
            core.set("a", "b", stamp, sample, is_static=False)
    for stamp in range(min(stamps), max(stamps) + 1, 7):
        assert in_order.lookup("a", "b", stamp) == shuffled.lookup("a", "b", stamp)
