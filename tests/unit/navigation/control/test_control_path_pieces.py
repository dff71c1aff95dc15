"""A path of poses becomes pieces: forward, reverse, turns in place."""

import math

import numpy as np
import pytest
from control_plant import tangent_path

from navette.errors import InvalidValueError
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import (
    DrivePiece,
    Piece,
    TurnPiece,
    split_path,
)
from navette.navigation.control.polyline import (
    resample,
    round_corners,
    simplify,
    turn_angles,
)


def split(poses: np.ndarray) -> list[Piece]:
    return split_path(poses, ControlParams())


def kinds(pieces: list[Piece]) -> list[str]:
    return [
        "turn"
        if isinstance(p, TurnPiece)
        else {1: "forward", -1: "reverse"}[p.direction]
        for p in pieces
    ]


def test_a_straight_path_is_one_piece() -> None:
    [piece] = split(tangent_path(np.array([[0, 0], [3, 0.0]])))
    assert isinstance(piece, DrivePiece)
    assert piece.direction == 1
    assert piece.length == pytest.approx(3.0)
    assert max(map(abs, piece.curvature)) == 0.0


def test_a_heading_against_the_travel_means_reverse() -> None:
    assert kinds(split(tangent_path(np.array([[0, 0], [3, 1.0]]), reverse=True))) == [
        "reverse"
    ]


def test_a_cusp_separates_reverse_from_forward() -> None:
    back = tangent_path(np.array([[0, 0], [-2, 0.0]]), reverse=True)
    ahead = tangent_path(np.array([[-2, 0], [1, 0.0]]))
    assert kinds(split(np.concatenate((back, ahead)))) == ["reverse", "forward"]


def test_poses_at_one_position_are_a_turn_with_a_direction() -> None:
    ahead = tangent_path(np.array([[0, 0], [2, 0.0]]))
    turn = np.array([(2.0, 0.0, yaw) for yaw in np.linspace(0, -1.5 * math.pi, 12)])
    away = tangent_path(np.array([[2, 0], [2, 2.0]]))
    pieces = split(np.concatenate((ahead, turn, away)))
    assert kinds(pieces) == ["forward", "turn", "forward"]
    assert isinstance(pieces[1], TurnPiece)
    assert pieces[1].turn == pytest.approx(-1.5 * math.pi)
    assert pieces[1].yaw == pytest.approx(math.pi / 2)


@pytest.mark.parametrize("reverse", [False, True])
def test_a_sharp_corner_is_turned_in_place(reverse: bool) -> None:
    corner = np.array([[0, 0], [3, 0], [3, 3.0]])
    pieces = split(tangent_path(corner, reverse=reverse))
    way = "reverse" if reverse else "forward"
    assert kinds(pieces) == [way, "turn", way]
    assert isinstance(pieces[1], TurnPiece)
    assert pieces[1].turn == pytest.approx(math.pi / 2)
    assert pieces[1].yaw == pytest.approx(-math.pi / 2 if reverse else math.pi / 2)


def test_a_gentle_corner_is_rounded_within_the_tolerance() -> None:
    corner = np.array([[0, 0], [5, 0], [8, 2.0]])
    [piece] = split(tangent_path(corner))
    assert isinstance(piece, DrivePiece)
    away = min(math.hypot(x - 5, y) for x, y in zip(piece.x, piece.y, strict=True))
    assert 0.03 < away < 0.06
    # R = 0.05 / (1 / cos(θ/2) − 1) for θ = 33.7°.
    assert max(piece.curvature) == pytest.approx(1 / 1.11, rel=0.15)


def test_missing_headings_mean_forward() -> None:
    path = tangent_path(np.array([[0, 0], [0, 3], [-2, 6.0]]))
    path[:, 2] = 0.0
    assert set(kinds(split(path))) == {"forward"}


@pytest.mark.parametrize("diagonal", [False, True])
def test_a_staircase_of_cells_is_one_smooth_piece(diagonal: bool) -> None:
    cells = [(0.0, 0.0)]
    for k in range(60):
        x, y = cells[-1]
        if not diagonal:
            cells += [(x + 0.1, y), (x + 0.1, y + 0.1)]
        else:
            cells.append((x + 0.1, y + 0.1 * (k % 2)))
    [piece] = split(tangent_path(np.array(cells), spacing=0.2))
    assert isinstance(piece, DrivePiece)
    assert max(map(abs, piece.curvature)) < 0.1


def test_one_repeated_pose_has_no_pieces() -> None:
    assert split(np.array([[1.0, 2.0, 0.5]])) == []
    assert split(np.array([[1.0, 2.0, 0.5]] * 3)) == []


@pytest.mark.parametrize(
    "poses",
    [
        np.zeros((4, 2)),
        np.array([[0, 0, 0], [1, math.nan, 0]]),
        np.zeros(3),
        np.array([[0, 0, 0], [1e6, 0, 0.0]]),
        np.array([[1e300, 0, 0], [1e300, 1, 0.0]]),
    ],
)
def test_a_malformed_path_is_refused(poses: np.ndarray) -> None:
    with pytest.raises(InvalidValueError, match="path of"):
        split(poses)


def test_simplify_keeps_the_shape() -> None:
    line = np.array([[0, 0], [1, 0.005], [2, 0], [3, 0], [3, 1], [3, 2.0]])
    assert simplify(line, 0.01).tolist() == [[0, 0], [3, 0], [3, 2]]


def test_simplify_of_a_closed_loop_keeps_it() -> None:
    loop = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0.0]])
    assert simplify(loop, 0.01).tolist() == loop.tolist()


def test_rounding_takes_at_most_half_of_a_leg() -> None:
    zigzag = np.array([[0, 0], [0.2, 0], [0.2, 0.2], [0.4, 0.2]])
    rounded = round_corners(zigzag, 1.0)
    assert np.allclose(rounded[[0, -1]], zigzag[[0, -1]])
    legs = np.hypot(*np.diff(rounded, axis=0).T)
    assert np.max(np.abs(turn_angles(rounded[:-1][legs > 1e-9]))) < 0.2


def test_resampling_keeps_ends_and_spacing() -> None:
    xy, s = resample(np.array([[0, 0], [1, 0], [1, 1.02]]), 0.05)
    assert xy[0].tolist() == [0, 0]
    assert xy[-1].tolist() == [1, 1.02]
    assert np.all(np.diff(s) <= 0.05)
    assert s[-1] == pytest.approx(2.02)
