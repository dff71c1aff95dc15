"""Draw maps, paths and robots seen from above: shared by picture.py and gallery.py."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageColor, ImageDraw, ImageFont

from navette.geometry import Footprint, Pose2
from navette.msgs.nav_msgs.msg import OccupancyGrid
from navette.navigation.grids import grid_from_message

# The palette of the live view.
FREE, UNKNOWN, COST = "#ffffff", "#ece8e0", "#a9b0b8"
INK, QUIET, THREAD, LASER = "#1c2025", "#67707b", "#bf3e0a", "#11798c"

Points = NDArray[np.float64]


@dataclass(frozen=True)
class View:
    """Part of the map frame that a picture shows.

    Attributes:
        size: width and height, pixels.
        origin: pixel of the map's (0, 0).
        scale: pixels per metre.
    """

    size: tuple[int, int]
    origin: tuple[float, float]
    scale: float


class Canvas:
    """Image in metres, x to the right, y up; drawn larger, then averaged."""

    def __init__(self, view: View, *, finer: int = 3) -> None:
        self.view, self.finer = view, finer
        width, height = view.size
        self.image = Image.new("RGB", (width * finer, height * finer), UNKNOWN)

    def place(self, points: Iterable[Iterable[float]]) -> list[tuple[float, float]]:
        """Pixels of the enlarged image for points in metres."""
        (left, top), scale = self.view.origin, self.view.scale
        return [
            ((left + x * scale) * self.finer, (top - y * scale) * self.finer)
            for x, y in points
        ]

    def pixels(
        self, x: float, y: float, shape: Iterable[tuple[float, float]] = ((0, 0),)
    ) -> Points:
        """A shape in pixels around a pixel, converted to metres: (N, 2)."""
        offset = np.subtract((x, y), self.view.origin)
        return (np.array(list(shape), float) + offset) * (1, -1) / self.view.scale

    def paint_map(self, message: OccupancyGrid) -> None:
        """Replace the image by a map: unknown, free, shades of cost, obstacles."""
        cells, spec = grid_from_message(message)
        shades = np.linspace(rgb(FREE), rgb(COST), 101)
        shades = np.vstack([shades[:100], rgb(INK), rgb(UNKNOWN)]).astype(np.uint8)
        picture = Image.fromarray(shades[cells[::-1]])  # index -1 is unknown
        top_left = (spec.origin.x, spec.origin.y + spec.height * spec.resolution)
        x, y = self.place([top_left])[0]
        edge = spec.resolution * self.view.scale * self.finer
        self.image = picture.transform(
            self.image.size,
            Image.Transform.AFFINE,
            (1 / edge, 0, -x / edge, 0, 1 / edge, -y / edge),
            fillcolor=UNKNOWN,
        )

    def line(self, points: Points, colour: str, width: float) -> None:
        """A line with round ends; ``width`` in pixels."""
        corners = self.place(points)
        draw = ImageDraw.Draw(self.image)
        draw.line(corners, fill=colour, width=round(width * self.finer), joint="curve")
        for end in (corners[0], corners[-1]):
            draw.circle(end, width * self.finer / 2, fill=colour)

    def dashes(self, points: Points, colour: str, width: float) -> None:
        """A dashed line: nine pixels drawn, seven left out."""
        on, period = 9 / self.view.scale, 16 / self.view.scale
        length = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        for start in np.arange(period, length[-1], period):
            at = np.linspace(start, min(start + on, length[-1]), 5)
            dash = np.stack([np.interp(at, length, axis) for axis in points.T], axis=1)
            self.line(dash, colour, width)

    def polygon(self, points: Points, colour: str, opacity: float = 1.0) -> None:
        mask = Image.new("L", self.image.size)
        ImageDraw.Draw(mask).polygon(self.place(points), fill=round(255 * opacity))
        self.image.paste(Image.new("RGB", self.image.size, colour), mask=mask)

    def dots(self, points: Points, colour: str, radius: float) -> None:
        """Discs; ``radius`` in pixels."""
        draw = ImageDraw.Draw(self.image)
        for centre in self.place(points):
            draw.circle(centre, radius * self.finer, fill=colour)

    def goal(
        self, at: tuple[float, float], number: str, state: str, radius: float = 14
    ) -> None:
        """A numbered disc: filled if reached, dark outline if next, grey if later."""
        edge, fill, ink = {
            "reached": (THREAD, THREAD, FREE),
            "next": (INK, FREE, INK),
            "later": (QUIET, FREE, QUIET),
        }[state]
        self.dots([at], FREE, radius + 2)
        self.dots([at], edge, radius)
        self.dots([at], fill, radius - 2)
        font = ImageFont.load_default(round(radius + 1) * self.finer)
        draw = ImageDraw.Draw(self.image)
        draw.text(self.place([at])[0], number, font=font, fill=ink, anchor="mm")

    def robot(self, pose: Pose2, footprint: Footprint) -> None:
        """The footprint with an arrow towards the front."""
        body = np.array(footprint.vertices)
        front, half = 0.5 * body[:, 0].max(), 0.4 * body[:, 1].max()
        x = (front - half, front + half)
        nose = np.array([(x[1], 0.0), (x[0], half), (x[0], -half)])
        self.line(pose.apply(np.vstack([body, body[:1]])), FREE, 5)
        self.polygon(pose.apply(body), INK)
        self.polygon(pose.apply(nose), FREE)

    def text(self, at: tuple[float, float], words: str, size: int, colour: str) -> None:
        """Text that starts at a pixel, centred vertically."""
        draw = ImageDraw.Draw(self.image)
        font = ImageFont.load_default(size * self.finer)
        place = (at[0] * self.finer, at[1] * self.finer)
        draw.text(place, words, font=font, fill=colour, anchor="lm")

    def finished(self) -> Image.Image:
        """The image in its final size."""
        return self.image.reduce(self.finer)


def rgb(colour: str) -> Points:
    return np.array(ImageColor.getrgb(colour), float)
