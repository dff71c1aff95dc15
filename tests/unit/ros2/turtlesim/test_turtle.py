"""Turtles: motion, walls, pens and colours."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.ros2.turtlesim.turtle import SIDE_M, Canvas, Pen, Turtle, normalized

DT = 0.016


def turtle(x: float = 5.0, y: float = 5.0, theta: float = 0.0) -> Turtle:
    return Turtle("turtle1", x, y, theta)


def test_a_command_holds_for_a_second() -> None:
    it, canvas = turtle(), Canvas()
    it.command(2.0, 0.0, 0.0)
    for _ in range(200):
        it.step(DT, canvas)
    assert it.x == pytest.approx(7.0, abs=2.0 * DT)
    assert it.speed == 0.0


def test_an_arc() -> None:
    it, canvas = turtle(), Canvas()
    for _ in range(round(math.pi / DT)):
        it.command(1.0, 0.0, 1.0)
        it.step(DT, canvas)
    assert (it.x, it.y) == pytest.approx((5.0, 7.0), abs=0.03)
    assert abs(normalized(it.theta - math.pi)) < 0.02


def test_sideways() -> None:
    it, canvas = turtle(theta=math.pi / 2), Canvas()
    it.command(0.0, 1.0, 0.0)
    it.step(1.0, canvas)
    assert (it.x, it.y) == pytest.approx((4.0, 5.0))


@given(
    st.lists(
        st.tuples(st.floats(-9, 9), st.floats(-9, 9), st.floats(-9, 9)), max_size=9
    )
)
def test_walls_hold(commands: list[tuple[float, float, float]]) -> None:
    it, canvas = turtle(), Canvas()
    for command in commands:
        it.command(*command)
        for _ in range(30):
            it.step(DT, canvas)
            assert 0.0 <= it.x <= SIDE_M
            assert 0.0 <= it.y <= SIDE_M
            assert -math.pi <= it.theta < math.pi


def test_a_wall_is_noticed() -> None:
    it, canvas = turtle(x=SIDE_M), Canvas()
    it.command(1.0, 0.0, 0.0)
    it.step(DT, canvas)
    assert it.hit_wall
    it.command(-1.0, 0.0, 0.0)
    it.step(DT, canvas)
    assert not it.hit_wall


def test_a_straight_line_is_one_segment_of_the_pens_colour() -> None:
    it, canvas = turtle(x=1.0), Canvas()
    it.set_pen(Pen((10, 20, 30), 5))
    it.command(1.0, 0.0, 0.0)
    for _ in range(50):
        it.step(DT, canvas)
    (stroke,) = canvas.strokes
    assert stroke.points == [(1.0, 5.0), (pytest.approx(1.8), 5.0)]
    assert stroke.width_m == pytest.approx(5 / 45)
    assert canvas.colour_at(1.4, 5.0) == (10, 20, 30)
    assert canvas.colour_at(1.4, 5.0 + 4 / 45) == (255, 255, 255)
    canvas.clear()
    assert canvas.colour_at(1.4, 5.0) == (255, 255, 255)


def test_a_pen_that_is_off_draws_nothing() -> None:
    it, canvas = turtle(), Canvas()
    it.set_pen(Pen(is_off=True))
    it.teleport(1.0, 1.0, 0.0, canvas)
    it.set_pen(Pen())
    it.teleport(2.0, 1.0, 0.5, canvas)
    assert [stroke.points for stroke in canvas.strokes] == [[(1.0, 1.0), (2.0, 1.0)]]
    assert it.theta == 0.5


@given(st.floats(-math.pi, 3.1), st.floats(-math.pi, 3.1))
def test_it_turns_the_shorter_way(start: float, end: float) -> None:
    it, canvas = turtle(theta=start), Canvas()
    steps = 0
    while it.turn_towards(end) != 0.0:
        it.step(DT, canvas)
        steps += 1
        assert steps * DT <= math.pi + DT
    assert abs(normalized(it.theta - end)) < 0.02
