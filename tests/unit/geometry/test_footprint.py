import math

import numpy as np
import pytest

from navette.errors import InvalidValueError
from navette.geometry import Footprint

BOX = Footprint(((-0.5, -0.7), (1.5, -0.7), (1.5, 0.7), (-0.5, 0.7)))


def test_radii_of_a_box_about_an_axle_at_its_rear() -> None:
    assert BOX.inscribed_radius == 0.5
    assert BOX.circumscribed_radius == pytest.approx(math.hypot(1.5, 0.7))


def test_contains_points_inside_the_outline_only() -> None:
    points = np.array([(1.4, -0.6), (1.6, 0.0), (0.0, 0.8)])
    assert BOX.contains(points).tolist() == [True, False, False]
    assert not BOX.contains(points, depth_m=0.15).any()
    assert BOX.contains(points, depth_m=0.05).tolist() == [True, False, False]


def test_samples_lie_on_the_outline_at_most_the_spacing_apart() -> None:
    points = BOX.samples(0.1)
    on_side = np.isclose(np.abs(points[:, 1]), 0.7)
    on_end = np.isclose(points[:, 0], -0.5) | np.isclose(points[:, 0], 1.5)
    assert np.all(on_side | on_end)
    gaps = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1)
    assert gaps.max() <= 0.1 + 1e-12


def test_from_flat_reads_coordinate_pairs() -> None:
    assert Footprint.from_flat((1.0, 0.0, -1.0, 1.0, -1.0, -1.0)).vertices == (
        (1.0, 0.0),
        (-1.0, 1.0),
        (-1.0, -1.0),
    )


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ((1.0, 0.0, -1.0), "pairs"),
        ((1.0, 0.0, -1.0, 1.0), "at least 3"),
        ((1.0, 0.0, math.nan, 1.0, -1.0, -1.0), "finite"),
        ((1e300, 0.0, -1.0, 1.0, -1.0, -1.0), "within 100 m"),
        ((1.0, 1.0, 2.0, 1.0, 2.0, 2.0), "origin"),
    ],
)
def test_errors_name_the_problem(values: tuple[float, ...], reason: str) -> None:
    with pytest.raises(InvalidValueError, match=reason):
        Footprint.from_flat(values)
