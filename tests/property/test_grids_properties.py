"""Properties of the grid kernels on random grids, against plain definitions."""

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from navette.geometry import Pose2
from navette.navigation.grids import (
    LETHAL,
    GridSpec,
    MapComparison,
    beam_directions,
    cost_table,
    distance_field,
    inflate,
    merge,
    placed,
    trace_beams,
)

shapes = st.tuples(st.integers(1, 24), st.integers(1, 90))
occupancy = shapes.flatmap(
    lambda shape: arrays(np.uint8, shape, elements=st.sampled_from([0] * 9 + [1]))
)
costs = st.sampled_from([-1] * 3 + [0] * 5 + [1, 50, 99, 100])
cost_grids = shapes.flatmap(lambda shape: arrays(np.int8, shape, elements=costs))
poses = st.builds(
    Pose2, st.floats(-4, 4), st.floats(-4, 4), st.floats(-math.pi, math.pi)
)


def brute_force(occupied: np.ndarray, radius: int) -> np.ndarray:
    """Least squared distance to an obstacle, clipped to the square of the radius."""
    rows, columns = np.indices(occupied.shape)
    least = np.full(occupied.shape, radius**2)
    for row, column in np.argwhere(occupied):
        least = np.minimum(least, (rows - row) ** 2 + (columns - column) ** 2)
    return least


@given(occupancy, st.floats(0.01, 3.0), st.integers(0, 40))
def test_distance_is_the_least_over_all_obstacles(occupied, resolution, radius) -> None:
    field = distance_field(occupied, resolution, radius * resolution)
    exact = resolution * np.sqrt(brute_force(occupied, radius))
    np.testing.assert_allclose(field, exact, rtol=1e-5)


@given(occupancy, st.integers(0, 20))
def test_distance_is_invariant_under_transposition_and_flips(occupied, radius) -> None:
    found = distance_field(occupied, 1.0, radius)
    np.testing.assert_array_equal(distance_field(occupied.T, 1.0, radius), found.T)
    flipped = np.ascontiguousarray(occupied[::-1, ::-1])
    np.testing.assert_array_equal(
        distance_field(flipped, 1.0, radius), found[::-1, ::-1]
    )


@given(occupancy, st.floats(0.01, 3.0), st.floats(0.02, 1.0))
def test_distance_is_1_lipschitz_and_clipped(
    occupied, max_distance, resolution
) -> None:
    field = distance_field(occupied, resolution, max_distance)
    assert field.max() <= max_distance * (1 + 1e-6)
    for axis in (0, 1):
        assert (np.abs(np.diff(field, axis=axis)) <= resolution * (1 + 1e-5)).all()


@given(cost_grids, st.floats(0.0, 2.0), st.sampled_from(["linear", "exponential"]))
def test_inflation_only_raises_and_is_idempotent(cost, radius, method) -> None:
    table = cost_table(method, inflation_radius_m=radius, resolution=0.1)
    once = inflate(cost, table)
    assert (once >= cost).all()
    np.testing.assert_array_equal(once == LETHAL, cost == LETHAL)
    np.testing.assert_array_equal(inflate(once, table), once)
    kept = inflate(cost, table, raise_unknown=False)
    np.testing.assert_array_equal(kept == -1, cost == -1)
    np.testing.assert_array_equal(kept[cost >= 0], once[cost >= 0])


readings = st.one_of(
    st.floats(0.0, 6.0, width=32),
    st.sampled_from([math.inf, math.nan, -math.inf, 0.0, -1.0]),
)


@given(st.lists(readings, max_size=60), poses)
def test_beams_mark_their_hits_and_nothing_beyond(values, origin) -> None:
    spec = GridSpec(0.1, 61, 53, origin)
    sensor = spec.center_of(26, 30)
    cost = np.full(spec.shape, -1, np.int8)
    ranges = np.array(values, np.float32)
    directions = beam_directions(-1.0, 0.11, len(values))
    hits = trace_beams(
        cost, spec, sensor, directions, ranges, range_min=0.2, range_max=5.0
    )
    valid = (ranges > 0.2) & (ranges < 5.0)
    assert hits <= valid.sum()
    assert ((cost == LETHAL).sum() > 0) == (hits > 0)
    assert set(np.unique(cost)) <= {-1, 0, LETHAL}
    reach = np.nanmax(np.where(ranges > 0.2, np.minimum(ranges, 5.0), 0.0), initial=0.0)
    rows, columns = np.nonzero(cost >= 0)
    assert (np.hypot(rows - 26, columns - 30) <= reach / 0.1 + 1.5).all()


@given(cost_grids, poses, st.sampled_from([0.05, 0.1, 0.2]))
def test_merging_is_idempotent(source, pose, resolution) -> None:
    spec = placed(GridSpec(resolution, source.shape[1], source.shape[0]), pose)
    target_spec = GridSpec(0.1, 60, 50, Pose2(-3.0, -2.5, 0.2))
    for mode in ("overwrite", "max"):
        once = np.full(target_spec.shape, -1, np.int8)
        merge(once, target_spec, source, spec, mode)
        twice = once.copy()
        merge(twice, target_spec, source, spec, mode)
        np.testing.assert_array_equal(once, twice)


@given(cost_grids, poses)
def test_each_lethal_cell_is_merged_into_one_cell(source, pose) -> None:
    spec = placed(GridSpec(0.1, source.shape[1], source.shape[0]), pose)
    target_spec = GridSpec(0.1, 300, 300, Pose2(-15.0, -15.0, 0.0))
    target = np.full(target_spec.shape, -1, np.int8)
    merge(target, target_spec, source, spec)
    count = int((source == LETHAL).sum())
    arrived = np.argwhere(target == LETHAL)
    assert len(arrived) <= count
    assert (len(arrived) > 0) == (count > 0)
    if count:
        sent = spec.centers_of(np.argwhere(source == LETHAL))
        gaps = sent[:, None] - target_spec.centers_of(arrived)[None]
        distances = np.hypot(gaps[..., 0], gaps[..., 1])
        assert distances.min(axis=1).max() <= 0.1 * math.sqrt(0.5) + 1e-6
        assert distances.min(axis=0).max() <= 0.1 * math.sqrt(0.5) + 1e-6


@given(cost_grids, poses)
def test_a_merged_grid_does_not_contradict_the_map(source, pose) -> None:
    spec = placed(GridSpec(0.1, source.shape[1], source.shape[0]), pose)
    target_spec = GridSpec(0.1, 300, 300, Pose2(-15.0, -15.0, 0.0))
    target = np.full(target_spec.shape, -1, np.int8)
    merge(target, target_spec, source, spec)
    compared = MapComparison(target, target_spec, source, spec, (pose.x, pose.y), 20.0)
    assert compared.count_appeared() == 0
    assert compared.count_vanished() == 0
