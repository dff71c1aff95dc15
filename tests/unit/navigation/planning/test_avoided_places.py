"""Plans avoid the place where the robot got stuck, while another path exists."""

import numpy as np

from navette.geometry import Pose2
from navette.navigation.grids import GridSpec
from navette.navigation.planning.avoided_places import AvoidedPlaces

SPEC = GridSpec(0.1, 60, 40, Pose2(0.0, 0.0, 0.0))
FREE = np.zeros(SPEC.shape, np.int8)
AHEAD = np.array([[1.0 + 0.1 * k, 2.0, 0.0] for k in range(40)])


def test_the_place_ahead_becomes_an_obstacle_beyond_the_body() -> None:
    places = AvoidedPlaces()
    assert not places.avoid()
    assert places.marked(FREE, SPEC) is FREE
    places.note_stuck(AHEAD, front_m=0.3)
    assert places.marked(FREE, SPEC) is FREE
    assert places.avoid()
    rows, columns = np.nonzero(places.marked(FREE, SPEC))
    centers = SPEC.centers_of(np.column_stack([rows, columns]))
    assert np.allclose(centers.mean(axis=0), (1.7, 2.0), atol=0.06)
    # From the front of the body on.
    assert centers[:, 0].min() > 1.0 + 0.3 - 0.1
    assert not FREE.any()


def test_places_belong_to_a_goal() -> None:
    places = AvoidedPlaces()
    assert not places.note_goal((5.0, 2.0))
    places.note_stuck(AHEAD, front_m=0.3)
    places.avoid()
    assert not places.note_goal((5.1, 2.0))
    assert places
    assert places.note_goal((5.0, -2.0))
    assert not places


def test_a_path_may_be_too_short_or_leave_the_map() -> None:
    places = AvoidedPlaces()
    places.note_stuck(AHEAD[:3], front_m=0.3)
    assert not places.avoid()
    places.note_stuck(AHEAD + np.array([4.5, 1.9, 0.0]), front_m=0.3)
    assert places.avoid()
    assert places.marked(FREE, SPEC).shape == FREE.shape
