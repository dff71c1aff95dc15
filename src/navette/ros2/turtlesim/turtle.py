"""A turtle: its motion on the canvas, and what its pen draws.

The canvas is 500 × 500 pixels at 45 pixels per metre with its origin at the lower left,
as turtlesim's.
"""

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

PIXELS = 500
PIXELS_PER_M = 45.0
SIDE_M = (PIXELS - 1) / PIXELS_PER_M
COMMAND_TIMEOUT_S = 1.0
_TURN_RADPS = 1.0
_TURNED_RAD = 0.02

Rgb = tuple[int, int, int]


@dataclass
class Pen:
    """Colour and width (pixels) of a turtle's line."""

    colour: Rgb = (0xB3, 0xB8, 0xFF)
    width_px: int = 3
    is_off: bool = False


@dataclass
class Stroke:
    """A line of one colour; points in m."""

    colour: Rgb
    width_m: float
    points: list[tuple[float, float]]


class Canvas:
    """What was drawn: strokes for viewers, pixels for the turtles' colour sensors."""

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        self.strokes: list[Stroke] = []
        self._pixels: npt.NDArray[np.uint8] = np.full((PIXELS, PIXELS, 3), 255, "u1")

    def colour_at(self, x: float, y: float) -> Rgb:
        """Return the colour under a point (m); white where nothing is drawn."""
        column, row = self._pixel(x), self._pixel(y)
        r, g, b = self._pixels[row, column]
        return int(r), int(g), int(b)

    def paint(
        self, start: tuple[float, float], end: tuple[float, float], pen: Pen
    ) -> None:
        """Colour the pixels of a line."""
        steps = math.ceil(math.dist(start, end) * PIXELS_PER_M) + 1
        half = pen.width_px // 2
        for part in np.linspace(0.0, 1.0, steps):
            column = self._pixel(start[0] + part * (end[0] - start[0]))
            row = self._pixel(start[1] + part * (end[1] - start[1]))
            rows = slice(max(row - half, 0), row + half + 1)
            self._pixels[rows, max(column - half, 0) : column + half + 1] = pen.colour

    @staticmethod
    def _pixel(metres: float) -> int:
        return min(max(round(metres * PIXELS_PER_M), 0), PIXELS - 1)


@dataclass
class Turtle:
    """State of a turtle: m, rad, m/s, rad/s."""

    name: str
    x: float
    y: float
    theta: float
    pen: Pen = field(default_factory=Pen)
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Forward, to the left, and turn rate."""
    command_age_s: float = 0.0
    hit_wall: bool = False
    _stroke: Stroke | None = None

    @property
    def speed(self) -> float:
        return math.hypot(self.velocity[0], self.velocity[1])

    def command(self, forward: float, left: float, turn: float) -> None:
        """Set the velocity, which holds for a second."""
        self.velocity = forward, left, turn
        self.command_age_s = 0.0

    def set_pen(self, pen: Pen) -> None:
        self.pen, self._stroke = pen, None

    def forget_line(self) -> None:
        """Begin a new line with the next motion: the canvas was cleared."""
        self._stroke = None

    def turn_towards(self, theta: float) -> float:
        """Command the turn to a heading; return what remains, 0 if it is reached."""
        remaining = normalized(theta - self.theta)
        if abs(remaining) < _TURNED_RAD:
            self.command(0.0, 0.0, 0.0)
            return 0.0
        self.command(0.0, 0.0, math.copysign(_TURN_RADPS, remaining))
        return remaining

    def teleport(self, x: float, y: float, theta: float, canvas: Canvas) -> None:
        """Move at once; the pen draws the way."""
        start = self.x, self.y
        self.theta = theta
        self._move_to(x, y)
        self._draw_from(start, canvas)

    def step(self, dt: float, canvas: Canvas) -> None:
        """Move for ``dt`` s; walls stop the turtle."""
        self.command_age_s += dt
        if self.command_age_s > COMMAND_TIMEOUT_S:
            self.velocity = (0.0, 0.0, 0.0)
        forward, left, turn = self.velocity
        start = self.x, self.y
        self.theta = normalized(self.theta + turn * dt)
        c, s = math.cos(self.theta), math.sin(self.theta)
        self._move_to(
            self.x + (c * forward - s * left) * dt,
            self.y + (s * forward + c * left) * dt,
        )
        self._draw_from(start, canvas)

    def _move_to(self, x: float, y: float) -> None:
        self.x, self.y = min(max(x, 0.0), SIDE_M), min(max(y, 0.0), SIDE_M)
        self.hit_wall = (self.x, self.y) != (x, y)

    def _draw_from(self, start: tuple[float, float], canvas: Canvas) -> None:
        end = self.x, self.y
        if self.pen.is_off or start == end:
            return
        canvas.paint(start, end, self.pen)
        if self._stroke is None:
            width_m = self.pen.width_px / PIXELS_PER_M
            self._stroke = Stroke(self.pen.colour, width_m, [start])
            canvas.strokes.append(self._stroke)
        points = self._stroke.points
        if len(points) > 1 and _on_line(points[-2], points[-1], end):
            points[-1] = end
        else:
            points.append(end)


def normalized(angle: float) -> float:
    """Return the angle in [−π, π)."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def _on_line(
    start: tuple[float, float], middle: tuple[float, float], end: tuple[float, float]
) -> bool:
    """Whether a line goes straight on at its middle."""
    ax, ay = middle[0] - start[0], middle[1] - start[1]
    bx, by = end[0] - middle[0], end[1] - middle[1]
    return abs(ax * by - ay * bx) < 1e-9 and ax * bx + ay * by > 0.0
