"""Draw the README's picture, a moment of the demo: ``python docs/picture.py``.

Everything in the picture comes from topics; the same seed gives the same picture.
"""

import math
from pathlib import Path

import numpy as np
from canvas import COST, INK, LASER, QUIET, THREAD, UNKNOWN, Canvas, Points, View
from PIL import Image

from navette import (
    Buffer,
    Context,
    DurabilityPolicy,
    Node,
    QoSProfile,
    TransformListener,
)
from navette.geometry import Footprint, Pose2, yaw_of
from navette.msgs.geometry_msgs.msg import Pose
from navette.msgs.nav_msgs.msg import OccupancyGrid, Odometry
from navette.msgs.nav_msgs.msg import Path as PathMessage
from navette.msgs.sensor_msgs.msg import LaserScan
from navette.navigation.stack import RunOptions, demo_goals
from navette.navigation.stack.simulation import Simulation

PICTURE = Path(__file__).parent / "images" / "drive.png"
MOMENT_S = 39.5
SEED = 1
VIEW = View(size=(1600, 1000), origin=(1100, 500), scale=46)
LEFT = 60  # left edge of the text, pixels


class Photographer(Node):
    """Stores the newest message of everything that the picture shows."""

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
        """Scanner position (2,) and beam ends (N, 2) in the map frame."""
        scan = self.scan
        map_T_scan = self.frames.lookup("map", scan.header.frame_id, 0).to_pose2()
        return np.array(map_T_scan[:2]), map_T_scan.apply(beam_ends(scan))

    def path_ahead(self) -> Points:
        """The rest of the path, starting at the robot: (N, 2)."""
        points = np.array([planar(pose.pose)[:2] for pose in self.path.poses])
        return rest_of(points, self.pose)


def planar(pose: Pose) -> Pose2:
    q = pose.orientation
    return Pose2(pose.position.x, pose.position.y, yaw_of((q.x, q.y, q.z, q.w)))


def beam_ends(scan: LaserScan) -> Points:
    """Ends of the beams in the scanner's frame; of free beams at the largest range."""
    ranges = np.minimum(scan.ranges, scan.range_max)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    return np.stack([ranges * np.cos(angles), ranges * np.sin(angles)], axis=1)


def rest_of(path: Points, pose: Pose2) -> Points:
    """The path (N, 2) from the robot's position on."""
    nearest = np.hypot(*(path - pose[:2]).T).argmin()
    return np.vstack([pose[:2], path[nearest + 1 :]])


def paint_drive(canvas: Canvas, seen: Photographer, reached: int) -> None:
    """Draw the map and everything that moves on it."""
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
    """Draw the headline."""
    half = [(x, 9 * math.cos(math.pi * x / 40)) for x in range(-20, 21)]
    shuttle = [*half, *((x, -y) for x, y in reversed(half))]
    canvas.polygon(canvas.pixels(LEFT + 20, 84, shuttle), THREAD)
    canvas.line(canvas.pixels(LEFT + 20, 84, [(-6, 0), (6, 0)]), UNKNOWN, 4)
    canvas.text((LEFT + 54, 84), "Navette", 26, INK)
    ahead = np.hypot(*np.diff(seen.path_ahead(), axis=0).T).sum()
    detail = f"{ahead:.1f} m left at {seen.speed_mps:.1f} m/s, {MOMENT_S:.0f} s elapsed"
    canvas.text((LEFT, 190), f"Driving to goal {reached + 1}", 50, INK)
    canvas.text((LEFT, 246), detail, 21, QUIET)
    canvas.text((LEFT, 278), "in an arena without a map", 21, QUIET)


LEGEND = (
    "robot",
    "driven path",
    "planned path",
    "laser hits now",
    "obstacle and cost around it",
    "goal: reached, next, later",
    "2 m",
)


def paint_legend(canvas: Canvas, footprint: Footprint) -> None:
    """Draw each mark with its meaning, one per line."""
    pixels = canvas.pixels
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
    ruler = [(0, -6), (0, 0), (2 * VIEW.scale, 0), (2 * VIEW.scale, -6)]
    canvas.line(pixels(LEFT, scale + 3, ruler), QUIET, 1.5)


def take(moment_s: float) -> Image.Image:
    """Drive until ``moment_s`` and draw what is known then."""
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
    canvas = Canvas(VIEW)
    paint_drive(canvas, seen, reached)
    canvas.robot(seen.pose, footprint)
    paint_words(canvas, seen, reached)
    paint_legend(canvas, footprint)
    return canvas.finished()


if __name__ == "__main__":
    take(MOMENT_S).save(PICTURE, optimize=True)
