"""Range readings of a cone."""

import math

import numpy as np
import pytest

from navette.navigation.costmap.layers.range_grid import RangeWindow, sensor_model

HALF = math.radians(7.5)


def window() -> RangeWindow:
    made = RangeWindow(6.0, 0.05, phi=1.2)
    made.move_to(0.0, 0.0)
    return made


def test_a_reading_marks_its_arc_and_nothing_else() -> None:
    made = window()
    for _ in range(8):
        made.update((0.0, 0.0, 0.0), 1.0, HALF)
    found = made.obstacles(0.8)
    assert len(found)
    distance = np.hypot(*found.T)
    bearing = np.arctan2(found[:, 1], found[:, 0])
    assert np.abs(distance - 1.0).max() <= 0.05 + 1e-9
    assert np.abs(bearing).max() <= HALF


def test_free_readings_clear_what_was_marked() -> None:
    made = window()
    for _ in range(8):
        made.update((0.0, 0.0, 0.5), 0.8, HALF)
    assert len(made.obstacles(0.8))
    for _ in range(20):
        made.update((0.0, 0.0, 0.5), 4.0, HALF, is_free=True)
    assert not len(made.obstacles(0.8))


def test_the_sensor_model_is_continuous_and_most_certain_at_the_reading() -> None:
    distance = np.linspace(0.05, 2.0, 4000)
    model = sensor_model(
        1.0, np.zeros(len(distance)), distance, phi=1.2, resolution=0.05
    )
    assert np.abs(np.diff(model)).max() < 0.02
    assert distance[model.argmax()] == pytest.approx(1.0, abs=0.01)
    assert model[distance < 0.85].max() < 0.5
    assert model[distance > 1.06] == pytest.approx(0.5)
    edge = sensor_model(1.0, np.ones(1), np.ones(1), phi=1.2, resolution=0.05)
    assert edge == pytest.approx(0.5)


def test_probabilities_move_with_the_window() -> None:
    made = window()
    for _ in range(8):
        made.update((0.0, 0.0, 0.0), 1.0, HALF)
    before = {tuple(np.round(p, 6)) for p in made.obstacles(0.8)}
    made.move_to(0.7, -0.4)
    assert {tuple(np.round(p, 6)) for p in made.obstacles(0.8)} == before
    made.move_to(50.0, 0.0)
    assert not len(made.obstacles(0.8))
