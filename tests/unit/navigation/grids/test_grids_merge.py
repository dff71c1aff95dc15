import math

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.geometry import Pose2
from navette.navigation.grids import GridSpec, accumulate, merge, placed

MAP = GridSpec(0.1, 140, 120, Pose2(-7.0, -6.0, 0.0))


def unknown() -> np.ndarray:
    return np.full(MAP.shape, -1, np.int8)


def pulled(target: np.ndarray, source: np.ndarray, spec: GridSpec) -> np.ndarray:
    """Plain Python: the source cell under each target cell's centre, -1 outside."""
    found = np.full(target.shape, -1, np.int8)
    for row in range(MAP.height):
        for column in range(MAP.width):
            cell = spec.cell_of(*MAP.center_of(row, column))
            if spec.contains(*cell):
                found[row, column] = source[cell]
    return found


def poses() -> list[Pose2]:
    rng = np.random.default_rng(6)
    turned = [Pose2(*rng.uniform((-6, -5, -3), (6, 5, 3))) for _ in range(6)]
    straight = [Pose2(0.013, 0.021, k * math.pi / 2) for k in range(-1, 3)]
    return [*turned, *straight, Pose2(-9.0, -8.0, 0.4), Pose2(90.0, 0.0, 1.0)]


def without_lethal(shape: tuple[int, int]) -> np.ndarray:
    return np.random.default_rng(7).integers(-1, 100, shape).astype(np.int8)


@pytest.mark.parametrize("resolution", [0.05, 0.1, 0.17])
@pytest.mark.parametrize("pose", poses())
def test_every_cell_takes_the_source_cell_at_its_centre(pose, resolution) -> None:
    source = without_lethal((41, 53))
    spec = placed(GridSpec(resolution, 53, 41, Pose2(-2.0, -1.0, 0.0)), pose)
    expected = pulled(unknown(), source, spec)
    target = unknown()
    merge(target, MAP, source, spec)
    np.testing.assert_array_equal(target, expected)
    before = without_lethal(MAP.shape)
    target = before.copy()
    merge(target, MAP, source, spec)
    np.testing.assert_array_equal(target, np.where(expected >= 0, expected, before))
    target = before.copy()
    merge(target, MAP, source, spec, "max")
    np.testing.assert_array_equal(target, np.maximum(expected, before))


def test_a_coarse_source_leaves_no_holes() -> None:
    source = np.full((20, 20), 100, np.int8)
    spec = placed(GridSpec(0.4, 20, 20, Pose2(-4.0, -4.0, 0.0)), Pose2(0, 0, 0.5))
    target = unknown()
    merge(target, MAP, source, spec)
    row, column = np.mgrid[0 : MAP.height, 0 : MAP.width]
    x, y = (column + 0.5) * 0.1 - 7.0, (row + 0.5) * 0.1 - 6.0
    inside = np.hypot(x, y) < 3.9
    assert (target[inside] == 100).all()


@pytest.mark.parametrize("resolution", [0.05, 0.08, 0.1])
def test_each_lethal_cell_survives_once_at_any_rotation(resolution) -> None:
    for yaw in np.linspace(-3.1, 3.1, 63):
        source = np.zeros((30, 30), np.int8)
        cells = [(3, 4), (15, 15), (28, 11), (9, 25)]
        for cell in cells:
            source[cell] = 100
        spec = placed(GridSpec(resolution, 30, 30), Pose2(0.3, -0.2, float(yaw)))
        target = unknown()
        merge(target, MAP, source, spec)
        expected = {MAP.cell_of(*spec.center_of(*cell)) for cell in cells}
        assert {(r, c) for r, c in np.argwhere(target == 100).tolist()} == expected


def test_lethal_cells_do_not_grow_with_repeated_merging() -> None:
    source = np.zeros((60, 60), np.int8)
    source[30, 10:50] = 100
    grid = GridSpec(0.1, 60, 60, Pose2(-3.0, -3.0, 0.0))
    target = unknown()
    for yaw in np.linspace(0.0, 0.0005, 50):
        merge(target, MAP, source, placed(grid, Pose2(0.0, 0.0, 0.3 + float(yaw))))
    assert (target == 100).sum() <= 40


def test_overwrite_ignores_unknown_source_cells() -> None:
    target = unknown()
    target[:] = 100
    source = np.array([[0, -1], [50, 100]], np.int8)
    merge(target, MAP, source, GridSpec(0.1, 2, 2, Pose2(0.0, 0.0, 0.0)))
    assert target[60:62, 70:72].tolist() == [[0, 100], [50, 100]]
    assert (target == 100).sum() == target.size - 2


def test_log_odds_add_up_and_stay_within_the_limit() -> None:
    field = np.full(MAP.shape, np.nan, np.float32)
    source = np.array([[0, -1], [50, 100]], np.int8)
    spec = GridSpec(0.1, 2, 2, Pose2(0.0, 0.0, 0.0))
    for _ in range(3):
        accumulate(field, MAP, source, spec, hit=0.8, miss=-0.5, limit=2.0)
    window = field[60:62, 70:72]
    np.testing.assert_allclose(window, [[-1.5, np.nan], [-1.5, 2.0]])
    assert np.isnan(field).sum() == field.size - 3


def test_log_odds_of_a_hit_at_any_rotation() -> None:
    for yaw in np.linspace(-3.0, 3.0, 31):
        source = np.zeros((30, 30), np.int8)
        source[[0, 15, 29], [0, 12, 29]] = 100
        spec = placed(GridSpec(0.1, 30, 30), Pose2(0.3, -0.2, float(yaw)))
        field = np.full(MAP.shape, np.nan, np.float32)
        accumulate(field, MAP, source, spec, hit=0.8, miss=-0.5, limit=2.0)
        assert (field > 0).sum() == 3
        np.testing.assert_allclose(field[field > 0], 0.8, rtol=1e-6)


def test_log_odds_of_a_coarse_source() -> None:
    field = np.full(MAP.shape, np.nan, np.float32)
    spec = GridSpec(0.4, 1, 1, Pose2(0.0, 0.0, 0.0))
    source = np.array([[100]], np.int8)
    accumulate(field, MAP, source, spec, hit=0.8, miss=-0.5, limit=2.0)
    np.testing.assert_allclose(field[60:64, 70:74], 0.8)
    assert np.isfinite(field).sum() == 16


def test_bad_input_is_named() -> None:
    source, spec = np.zeros((2, 2), np.int8), GridSpec(0.1, 2, 2)
    with pytest.raises(InvalidValueError, match="merge mode 'min'; allowed"):
        merge(unknown(), MAP, source, spec, "min")
    with pytest.raises(InvalidValueError, match="target: int8"):
        merge(unknown()[:5], MAP, source, spec)
    with pytest.raises(InvalidValueError, match="source: shape"):
        merge(unknown(), MAP, source[:1], spec)
    with pytest.raises(InvalidValueError, match="hit -1"):
        accumulate(
            np.zeros(MAP.shape, np.float32),
            MAP,
            source,
            spec,
            hit=-1,
            miss=-0.5,
            limit=2.0,
        )


def test_far_from_the_sensor_lethal_cells_are_kept() -> None:
    source = np.zeros((100, 100), np.int8)
    spec = placed(GridSpec(0.1, 100, 100, Pose2(-5.0, -5.0, 0.0)), Pose2(1, 0, 0.7))
    target = np.full(MAP.shape, 100, np.int8)
    merge(target, MAP, source, spec, sensor=(1.0, 0.5), erase_within_m=2.0)
    covered = pulled(target, source, spec) == 0
    row, column = np.mgrid[0 : MAP.height, 0 : MAP.width]
    x, y = (column + 0.5) * 0.1 - 7.0, (row + 0.5) * 0.1 - 6.0
    distance = np.hypot(x - 1.0, y - 0.5)
    assert (target[covered & (distance < 1.999)] == 0).all()
    assert (target[distance > 2.001] == 100).all()


def test_far_from_the_sensor_other_cells_are_overwritten() -> None:
    source = np.array([[0, 50], [-1, 100]], np.int8)
    spec = GridSpec(0.1, 2, 2, Pose2(3.0, 3.0, 0.0))
    target = np.full(MAP.shape, 70, np.int8)
    merge(target, MAP, source, spec, sensor=(0.0, 0.0), erase_within_m=0.0)
    assert target[90:92, 100:102].tolist() == [[0, 50], [70, 100]]


@pytest.mark.parametrize("yaw", [0.0, math.pi / 2, math.pi, -math.pi / 2])
def test_a_wall_has_no_gaps_where_centres_lie_on_borders(yaw) -> None:
    source = np.zeros((61, 61), np.int8)
    source[:, 40] = 100
    spec = placed(GridSpec(0.1, 61, 61, Pose2(-3.05, -3.05, 0.0)), Pose2(0, 0, yaw))
    target = unknown()
    merge(target, MAP, source, spec)
    assert (target == 100).sum() == 61
    assert (
        max((target == 100).sum(axis=0).max(), (target == 100).sum(axis=1).max()) == 61
    )
