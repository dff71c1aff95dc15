"""Paints the README's picture, a moment of the demo: ``python docs/picture.py``.

All that is in the picture is what the topics said; the same seed gives the same one.
"""

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageColor, ImageDraw, ImageFont

from navette import (
    Buffer,
    Context,
    DurabilityPolicy,
    Node,
    QoSProfile,
    TransformListener,
)
from navette.geometry import Footprint, Pose2, yaw_of
from navette.grids import grid_from_message
from navette.msgs.geometry_msgs.msg import Pose
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.nav_msgs.msg import Path as PathMessage
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.stack import RunOptions, demo_goals
from navette.navigation.stack.simulation import Simulation

PICTURE = Path(__file__).parent / "images" / "drive.png"
MOMENT_S = 41.0
SEED = 1

# The palette of the live page.
FREE, UNKNOWN, COST = "#ffffff", "#ece8e0", "#a9b0b8"
INK, QUIET, THREAD, LASER = "#1c2025", "#67707b", "#c9430c", "#11798c"

WIDTH, HEIGHT = 1600, 1000
ORIGIN = 1100, 500  # where the map's (0, 0) is, pixels
SCALE = 46  # pixels per metre
LEFT = 60  # of the text, pixels
FINER = 3  # painted this much larger, then averaged: smooth edges

Points = NDArray[np.float64]


class Photographer(Node):
    """Remembers the newest of everything that the picture shows."""

    def __init__(self, context: Context) -> None:
        super().__init__("photographer", context=context)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.frames = Buffer(node=self)
        TransformListener(self.frames, self)
        self.trace: list[tuple[float, float]] = []
        self.create_subscription(OccupancyGrid, "/map", self.on_map, latched)
        self.create_subscription(PathMessage, "/path", self.on_path, 10)
        self.create_subscription(Odometry, "/ground_truth", self.on_truth, 10)
        self.create_subscription(LaserScan, "/lidar", self.on_scan, 10)

    def on_map(self, message: OccupancyGrid) -> None:
        self.map = message

    def on_path(self, message: PathMessage) -> None:
        self.path = message

    def on_scan(self, message: LaserScan) -> None:
        self.scan = message

    def on_truth(self, message: Odometry) -> None:
        self.pose = planar(message.pose.pose)
        self.speed_mps = message.twist.twist.linear.x
        self.trace.append(self.pose[:2])

    def laser_hits(self) -> tuple[Points, Points]:
        """The scanner's place and the beams' ends in the map frame: (2,), (N, 2)."""
        scan = self.scan
        map_T_scan = self.frames.lookup("map", scan.header.frame_id, 0).to_pose2()
        ranges = np.minimum(scan.ranges, scan.range_max)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        ends = np.stack([ranges * np.cos(angles), ranges * np.sin(angles)], axis=1)
        return np.array(map_T_scan[:2]), map_T_scan.apply(ends)

    def path_ahead(self) -> Points:
        """What is left of the path, from the robot on: (N, 2)."""
        points = np.array([planar(pose.pose)[:2] for pose in self.path.poses])
        nearest = np.hypot(*(points - self.pose[:2]).T).argmin()
        return np.vstack([self.pose[:2], points[nearest + 1 :]])


def planar(pose: Pose) -> Pose2:
    q = pose.orientation
    return Pose2(pose.position.x, pose.position.y, yaw_of((q.x, q.y, q.z, q.w)))


class Canvas:
    """Paints metres: x to the right, y up."""

    def __init__(self) -> None:
        self.image = Image.new("RGB", (WIDTH * FINER, HEIGHT * FINER), UNKNOWN)

    def place(self, points: Iterable[Iterable[float]]) -> list[tuple[float, float]]:
        left, top = ORIGIN
        return [
            ((left + x * SCALE) * FINER, (top - y * SCALE) * FINER) for x, y in points
        ]

    def paint_map(self, message: OccupancyGrid) -> None:
        """Unknown, free, obstacle; the cost between as a shade."""
        cells, spec = grid_from_message(message)
        shades = np.linspace(rgb(FREE), rgb(COST), 101)
        shades = np.vstack([shades[:100], rgb(INK), rgb(UNKNOWN)]).astype(np.uint8)
        picture = Image.fromarray(shades[cells[::-1]])  # -1 is the last one
        top_left = (spec.origin.x, spec.origin.y + spec.height * spec.resolution)
        (x, y), edge = self.place([top_left])[0], spec.resolution * SCALE * FINER
        self.image = picture.transform(
            self.image.size,
            Image.Transform.AFFINE,
            (1 / edge, 0, -x / edge, 0, 1 / edge, -y / edge),
            fillcolor=UNKNOWN,
        )

    def line(self, points: Points, colour: str, width: float) -> None:
        corners = self.place(points)
        draw = ImageDraw.Draw(self.image)
        draw.line(corners, fill=colour, width=round(width * FINER), joint="curve")
        for end in (corners[0], corners[-1]):
            draw.circle(end, width * FINER / 2, fill=colour)

    def dashes(self, points: Points, colour: str, width: float) -> None:
        """A dashed line: 0.2 m on, 0.16 m off."""
        way = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
        for start in np.arange(0.36, way[-1], 0.36):
            at = np.linspace(start, min(start + 0.2, way[-1]), 5)
            dash = np.stack([np.interp(at, way, axis) for axis in points.T], axis=1)
            self.line(dash, colour, width)

    def polygon(self, points: Points, colour: str, opacity: float = 1.0) -> None:
        mask = Image.new("L", self.image.size)
        ImageDraw.Draw(mask).polygon(self.place(points), fill=round(255 * opacity))
        self.image.paste(Image.new("RGB", self.image.size, colour), mask=mask)

    def dots(self, points: Points, colour: str, radius: float) -> None:
        draw = ImageDraw.Draw(self.image)
        for centre in self.place(points):
            draw.circle(centre, radius * FINER, fill=colour)

    def goal(self, at: tuple[float, float], number: str, state: str) -> None:
        """A numbered disc: filled once reached, dark while driven to, grey before."""
        edge, fill, ink = {
            "reached": (THREAD, THREAD, FREE),
            "next": (INK, FREE, INK),
            "later": (QUIET, FREE, QUIET),
        }[state]
        self.dots([at], FREE, 16)
        self.dots([at], edge, 14)
        self.dots([at], fill, 12)
        font = ImageFont.load_default(15 * FINER)
        draw = ImageDraw.Draw(self.image)
        draw.text(self.place([at])[0], number, font=font, fill=ink, anchor="mm")

    def robot(self, pose: Pose2, footprint: Footprint) -> None:
        body = np.array(footprint.vertices)
        nose = np.array([(0.16, 0.0), (-0.08, 0.11), (-0.08, -0.11)])
        for outline, colour in ((body * 1.35, FREE), (body, INK), (nose, FREE)):
            self.polygon(pose.apply(outline), colour)

    def text(self, at: tuple[float, float], words: str, size: int, colour: str) -> None:
        """Words that begin at a pixel, centred on its height."""
        draw = ImageDraw.Draw(self.image)
        font = ImageFont.load_default(size * FINER)
        place = (at[0] * FINER, at[1] * FINER)
        draw.text(place, words, font=font, fill=colour, anchor="lm")


def rgb(colour: str) -> Points:
    return np.array(ImageColor.getrgb(colour), float)


def paint_drive(canvas: Canvas, seen: Photographer, reached: int) -> None:
    """The map and all that moves on it."""
    scanner, ends = seen.laser_hits()
    canvas.paint_map(seen.map)
    canvas.polygon(np.vstack([scanner, ends]), LASER, opacity=0.08)
    canvas.dots(ends[np.isfinite(seen.scan.ranges)], LASER, 1.6)
    canvas.line(np.array(seen.trace), THREAD, 3)
    canvas.dashes(seen.path_ahead(), THREAD, 3)
    states = ["reached"] * reached + ["next"] + ["later"] * len(demo_goals())
    for number, (goal, state) in enumerate(zip(demo_goals(), states, strict=False), 1):
        canvas.goal(goal, str(number), state)


def paint_words(canvas: Canvas, seen: Photographer, reached: int) -> None:
    """What goes on."""
    half = [(x, 9 * math.cos(math.pi * x / 40)) for x in range(-20, 21)]
    shuttle = [*half, *((x, -y) for x, y in reversed(half))]
    canvas.polygon(pixels(LEFT + 20, 84, shuttle), THREAD)
    canvas.line(pixels(LEFT + 20, 84, [(-6, 0), (6, 0)]), UNKNOWN, 4)
    canvas.text((LEFT + 54, 84), "Navette", 26, INK)
    ahead = np.hypot(*np.diff(seen.path_ahead(), axis=0).T).sum()
    detail = (
        f"{ahead:.1f} m left at {seen.speed_mps:.1f} m/s, {MOMENT_S:.0f} s under way"
    )
    canvas.text((LEFT, 190), f"Driving to goal {reached + 1}", 50, INK)
    canvas.text((LEFT, 246), detail, 21, QUIET)
    canvas.text((LEFT, 278), "in an arena that it does not know", 21, QUIET)


LEGEND = (
    "the robot",
    "driven",
    "planned",
    "hit by the laser at this moment",
    "obstacle, and the cost around it",
    "goal: reached, next, later",
    "2 m",
)


def paint_legend(canvas: Canvas, footprint: Footprint) -> None:
    """What the marks mean, one a line."""
    rows = [644 + 40 * row for row in range(len(LEGEND))]
    for y, words in zip(rows, LEGEND, strict=True):
        canvas.text((LEFT + 120, y), words, 18, QUIET)
    robot, driven, planned, hit, obstacle, goal, scale = rows
    line = [(0, 0), (92, 0)]
    canvas.robot(Pose2(*pixels(LEFT + 46, robot)[0], 0.0), footprint)
    canvas.line(pixels(LEFT, driven, line), THREAD, 3)
    canvas.dashes(pixels(LEFT - 16, planned, [(0, 0), (108, 0)]), THREAD, 3)
    canvas.dots(pixels(LEFT, hit, [(4 * i, 0) for i in range(24)]), LASER, 1.6)
    for step in range(14):
        shade = [(0, step), (92, step), (92, step + 1), (0, step + 1)]
        canvas.polygon(pixels(LEFT, obstacle - 4, shade), COST, 1 - step / 14)
    canvas.line(pixels(LEFT, obstacle - 6, line), INK, 3)
    for number, state in enumerate(("reached", "next", "later")):
        canvas.goal(pixels(LEFT + 14 + 32 * number, goal)[0], str(number + 1), state)
    ruler = [(0, -6), (0, 0), (2 * SCALE, 0), (2 * SCALE, -6)]
    canvas.line(pixels(LEFT, scale + 3, ruler), QUIET, 1.5)


def pixels(
    x: float, y: float, shape: Iterable[tuple[float, float]] = ((0, 0),)
) -> Points:
    """A shape about a pixel, both in pixels, as points in metres: (N, 2)."""
    place = np.subtract((x, y), ORIGIN)
    return (np.array(list(shape), float) + place) * (1, -1) / SCALE


def take(moment_s: float) -> Image.Image:
    """Drive until then, and paint what is known."""
    options = RunOptions(
        robot="jackal",
        goals=demo_goals(),
        headless=True,
        speed=math.inf,
        seed=SEED,
        max_time_s=moment_s,
    )
    simulation = Simulation(options)
    seen = Photographer(simulation.context)
    simulation.executor.add_node(seen)
    simulation.run()
    reached = sum(g.result == "reached" for g in simulation.summary().goals)
    footprint = Footprint.from_flat(simulation.stack.control.params.footprint_m)
    simulation.close()
    canvas = Canvas()
    paint_drive(canvas, seen, reached)
    canvas.robot(seen.pose, footprint)
    paint_words(canvas, seen, reached)
    paint_legend(canvas, footprint)
    return canvas.image.reduce(FINER)


if __name__ == "__main__":
    take(MOMENT_S).save(PICTURE, optimize=True)
