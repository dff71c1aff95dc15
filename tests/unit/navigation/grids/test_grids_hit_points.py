"""Clouds are found by their stamp, in every pass of a recording that repeats."""

import numpy as np

from navette.navigation.grids import HitPoints
from navette.navigation.grids.hit_points import points_to_message

KEPT = 16


def test_a_stamp_that_returns_is_the_newest() -> None:
    hits = HitPoints()
    for stamp_ns in (*range(KEPT), 0, 100):
        hits.receive(points_to_message(np.array([[stamp_ns, 1.0]]), "map", stamp_ns))
    assert hits.at(0) is not None
    assert hits.at(1) is None, "the oldest was dropped"
    newest = hits.at(100)
    assert newest is not None
    assert newest.tolist() == [[100.0, 1.0]]
