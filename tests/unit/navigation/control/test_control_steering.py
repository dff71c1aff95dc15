"""Progress along a piece, and both steering methods."""

import math

import numpy as np
import pytest

from navette.geometry import Pose2
from navette.navigation.control.cross_track_pid import CrossTrackPid
from navette.navigation.control.params import ControlParams
from navette.navigation.control.path_pieces import DrivePiece, sample_piece
from navette.navigation.control.piece_progress import PathPoint, PieceProgress
from navette.navigation.control.pure_pursuit import PurePursuit

PURSUIT = PurePursuit(ControlParams())


def pid(kp: float, ki: float, kd: float) -> CrossTrackPid:
    params = ControlParams(pid_kp_per_m2=kp, pid_ki_per_m3=ki, pid_kd_per_m=kd)
    return CrossTrackPid(params)


def straight(direction: int = 1) -> DrivePiece:
    return sample_piece(np.array([[0.0, 0.0], [10.0, 0.0]]), direction)


def figure_eight() -> np.ndarray:
    t = np.linspace(0, math.tau, 400)
    return np.stack((4 * np.sin(t), 2 * np.sin(2 * t)), axis=1)


def test_progress_gives_signed_errors() -> None:
    at = PieceProgress(straight(), 2.0).update(Pose2(1.02, 0.3, 0.2))
    assert at.s == pytest.approx(1.02)
    assert at.cross_track == pytest.approx(0.3)
    assert at.heading_error == pytest.approx(0.2)


def test_progress_in_reverse_uses_the_direction_of_travel() -> None:
    at = PieceProgress(straight(-1), 2.0).update(Pose2(1.0, -0.1, math.pi + 0.1))
    assert at.cross_track == pytest.approx(-0.1)
    assert at.heading_error == pytest.approx(0.1)


def test_progress_never_jumps_across_a_loop() -> None:
    points = figure_eight()
    progress = PieceProgress(sample_piece(points, 1), 0.5)
    last = 0.0
    for x, y in points[::5]:
        at = progress.update(Pose2(float(x), float(y), 0.0))
        assert -1e-3 <= at.s - last < 0.6
        last = at.s
    assert last > 15.0


def test_pure_pursuit_drives_the_circle_through_the_carrot() -> None:
    pose = Pose2(2.0, 0.2, 0.0)
    at = PieceProgress(straight(), 3.0).update(pose)
    kappa = PURSUIT.curvature(straight(), at, pose, 0.5)
    # The carrot is 1 m ahead and 0.2 m to the right.
    assert kappa == pytest.approx(2 * -0.2 / (1 + 0.04))


def test_pure_pursuit_holds_an_arc_it_is_on() -> None:
    phi = np.linspace(0, math.pi, 300)
    piece = sample_piece(np.stack((2 * np.sin(phi), 2 - 2 * np.cos(phi)), axis=1), 1)
    pose = Pose2(2 * math.sin(1.0), 2 - 2 * math.cos(1.0), 1.0)
    at = PieceProgress(piece, 4.0).update(pose)
    assert PURSUIT.curvature(piece, at, pose, 0.5) == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("steering", [PURSUIT, pid(2.0, 0.2, 2.5)])
@pytest.mark.parametrize("direction", [1, -1])
def test_both_steer_back_to_the_path(
    steering: PurePursuit | CrossTrackPid, direction: int
) -> None:
    yaw = 0.0 if direction > 0 else math.pi
    pose = Pose2(2.0, 0.2, yaw)
    piece = straight(direction)
    at = PieceProgress(piece, 3.0).update(pose)
    kappa = steering.curvature(piece, at, pose, direction * 0.5)
    # Left of the path the travel must turn right: v κ < 0.
    assert direction * kappa < 0


def test_the_lookahead_shrinks_before_a_bend_and_grows_with_speed() -> None:
    corner = np.array([[0.0, 0.0], [5.0, 0.0], [7.0, 2.0]])
    piece = sample_piece(corner, 1)
    far, near = PathPoint(0, 0.0, 0.0, 0.0), PathPoint(97, piece.s[97], 0.0, 0.0)
    assert PURSUIT.carrot_distance(piece, far, 0.5) == pytest.approx(1.0, abs=0.06)
    assert PURSUIT.carrot_distance(piece, near, 0.5) < 0.5
    fast = PurePursuit(ControlParams(lookahead_time_s=1.0))
    assert fast.carrot_distance(piece, far, 2.0) == pytest.approx(2.0, abs=0.06)


def test_near_the_end_the_carrot_lies_straight_beyond_it() -> None:
    piece = straight()
    at = PathPoint(195, 9.75, 0.0, 0.0)
    assert PURSUIT.carrot_distance(piece, at, 0.5) == 1.0
    assert piece.point_at(10.75) == pytest.approx((10.75, 0.0))


def test_the_integral_learns_a_constant_offset_and_can_be_reset() -> None:
    steering = pid(0.0, 1.0, 0.0)
    piece = straight()
    kappas = [
        steering.curvature(piece, PathPoint(i, i * 0.05, 0.1, 0.0), Pose2(0, 0, 0), 0.5)
        for i in range(100)
    ]
    assert kappas[-1] == pytest.approx(-0.1 * 4.95)
    steering.reset()
    first = steering.curvature(piece, PathPoint(0, 0.0, 0.1, 0.0), Pose2(0, 0, 0), 0.5)
    assert first == 0.0
