"""Cells that neither map nor scan has seen, and the area where the robot starts."""

import math

import numpy as np
import pytest

from navette.geometry import Footprint, Pose2
from navette.navigation.grids import (
    UNKNOWN,
    GridSpec,
    Layer,
    StartArea,
    unseen_mask,
    unseen_points,
)

# Its corners swing out by 0.0702 m beyond its back when it turns in place.
BODY = Footprint(((0.25, 0.2), (-0.25, 0.2), (-0.25, -0.2), (0.25, -0.2)))
HAND_M = 0.1702
SPEC = GridSpec(0.1, 40, 40, Pose2(-2.0, -2.0, 0.0))
HERE = Pose2(0.0, 0.0, 0.0)


def start(at: Pose2 = HERE) -> StartArea:
    return StartArea.of(BODY, at, HAND_M)


def seen_ahead(spec: GridSpec = SPEC) -> Layer:
    """All cells with x > 0 of the grid's frame are free, the others unseen."""
    cells = np.full(spec.shape, UNKNOWN, np.int8)
    cells[:, spec.width // 2 :] = 0
    return Layer(cells, spec)


def test_unseen_cells_begin_where_the_start_area_ends() -> None:
    points = unseen_points((seen_ahead(),), start(), HERE, 1.0)
    assert (points[:, 0] < 0).all()
    behind = points[np.abs(points[:, 1]) < 0.2]
    nearest = behind[:, 0].max()
    assert nearest == pytest.approx(-0.35, abs=0.02)
    assert np.hypot(points[:, 0], points[:, 1]).max() <= 1.1


def test_either_layer_shows_a_cell() -> None:
    scan = seen_ahead(GridSpec(0.07, 60, 60, Pose2(2.1, 2.1, math.pi)))
    assert len(unseen_points((seen_ahead(),), start(), HERE, 1.0)) > 100
    assert len(unseen_points((seen_ahead(), scan), start(), HERE, 1.0)) == 0


def test_space_outside_the_map_is_unseen() -> None:
    small = seen_ahead(GridSpec(0.1, 4, 4, Pose2(-0.2, -0.2, 0.0)))
    points = unseen_points((small,), start(), HERE, 1.0)
    assert (points[:, 0] > 0.4).any()
    far = np.hypot(points[:, 0], points[:, 1]) > 0.6
    area = 0.1**2 * far.sum()
    assert area == pytest.approx(math.pi * (1 - 0.6**2), abs=0.1)


@pytest.mark.parametrize("yaw", [0.0, 0.5, 2.0])
def test_the_start_area_stays_where_the_robot_was_put_down(yaw: float) -> None:
    at = Pose2(-1.0, 0.3, yaw)
    points = unseen_points((seen_ahead(),), start(at), at, 1.0)
    inside = at.inverse().apply(points[:, :2])
    away = np.maximum(np.abs(inside) - (0.25, 0.2), 0.0)
    assert np.hypot(*away.T).min() > 0.0999


def test_the_mask_leaves_out_the_start_area() -> None:
    mask = unseen_mask(seen_ahead(), start())
    assert mask[:, 20:].sum() == 0
    assert mask[20, 0:16].all()
    assert not mask[20, 17:].any()
