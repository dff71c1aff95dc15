"""Poses that the robot is predicted to pass on its way back to the path."""

import math

import numpy as np
import pytest

from navette.navigation.control.path_pieces import sample_piece
from navette.navigation.control.piece_progress import PathPoint
from navette.navigation.control.predicted_motion import PredictedMotion

STRAIGHT = np.array([[0.0, 0.0], [10.0, 0.0]])
MERGE_M = 1.0


def predicted(at: PathPoint, direction: int = 1) -> np.ndarray:
    piece = sample_piece(STRAIGHT, direction)
    return PredictedMotion(piece).poses(at, 3.0, MERGE_M)


def test_on_the_path_the_robot_follows_it() -> None:
    poses = predicted(PathPoint(20, 1.0, 0.0, 0.0))
    assert poses[0, 0] == pytest.approx(1.05)
    assert poses[-1, 0] == pytest.approx(4.0, abs=0.051)
    assert np.abs(poses[:, 1:]).max() == 0.0


@pytest.mark.parametrize(("offset", "heading"), [(0.2, 0.0), (0.0, 0.3), (-0.1, 0.2)])
def test_the_offset_continues_along_the_heading_and_vanishes(
    offset: float, heading: float
) -> None:
    poses = predicted(PathPoint(20, 1.0, offset, heading))
    first = offset + 0.05 * math.tan(heading)
    assert poses[0, 1] == pytest.approx(first, abs=0.02)
    assert poses[0, 2] == pytest.approx(heading, abs=0.12)
    assert np.abs(poses[poses[:, 0] > 2.0, 1:]).max() < 1e-9
    slope = np.diff(poses[:, 1]) / np.diff(poses[:, 0])
    middle = (poses[1:, 2] + poses[:-1, 2]) / 2
    np.testing.assert_allclose(np.tan(middle), slope, atol=0.01)


def test_in_reverse_the_body_faces_backwards() -> None:
    poses = predicted(PathPoint(20, 1.0, 0.0, 0.0), direction=-1)
    assert np.cos(poses[:, 2]).max() == pytest.approx(-1.0)


def test_at_the_end_one_pose_is_left() -> None:
    poses = predicted(PathPoint(199, 10.0, 0.05, 0.0))
    assert len(poses) == 1
    assert poses[0, 0] == pytest.approx(10.0)
