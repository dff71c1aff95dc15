"""Random worlds with any start and any goal, for any robot: most goals can be reached.

Worlds are scaled with the body. Passages are wider and narrower than the body, and
goals lie in free space, inside obstacles, beside walls and outside of all walls.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from navette.geometry import Pose2
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.sim import Scene, World, footprint_of

ROBOTS = ("jackal", "husky", "turtlebot3_burger", "course", "mecanum", "racecar")
GOALS = ("free", "free", "free", "anywhere", "beside", "inside", "outside")
# Edge of a world in lengths of the body, and the least body that counts.
_EDGE, _LEAST_M = 14.0, 0.5
_ATTEMPTS = 10_000
# A start keeps this to every obstacle; one beside an obstacle less than the second.
_TOUCHING_M, _BESIDE_M = 0.04, 0.08

Points = NDArray[np.float64]
Rng = np.random.Generator


@cache
def body_of(robot: str) -> Points:
    """Return the footprint (N, 2) of a robot, base frame, m, counter-clockwise."""
    model = resolve_scene(RunOptions(world="empty", robot=robot)).scene.robot
    assert model is not None, "a resolved scene has a robot"
    return np.array(footprint_of(model))


@dataclass(frozen=True)
class RandomGoal:
    """One drive in a random world; poses in the map frame.

    Attributes:
        scene: the world.
        obstacles: convex outlines (N, 2) of all obstacles, counter-clockwise.
        body: outline (N, 2) of the robot, base frame, counter-clockwise.
        start: pose of the robot.
        goal: position (m).
        kinds: kinds of the world, the start and the goal.
    """

    scene: Scene
    obstacles: list[Points]
    body: Points
    start: Pose2
    goal: tuple[float, float]
    kinds: tuple[str, str, str]


@dataclass
class _Plot:
    """Boxes x, y, size x, size y, yaw and posts x, y, radius in a square, m."""

    edge: float
    boxes: list[tuple[float, float, float, float, float]]
    posts: list[tuple[float, float, float]]

    def add_wall(self, ends: Points, thickness: float) -> None:
        """Add a wall between two points (2, 2)."""
        (x0, y0), (x1, y1) = ends.tolist()
        length = math.hypot(x1 - x0, y1 - y0)
        if length > 0.02:
            yaw = math.atan2(y1 - y0, x1 - x0)
            self.boxes.append(((x0 + x1) / 2, (y0 + y1) / 2, length, thickness, yaw))

    def add_wall_with_door(
        self, ends: Points, thickness: float, door: tuple[float, float]
    ) -> None:
        """Add a wall with a door: its beginning along the wall, and its width."""
        along = ends[1] - ends[0]
        along = along / math.hypot(*along)
        first, last = ends[0] + door[0] * along, ends[0] + sum(door) * along
        self.add_wall(np.array([ends[0], first]), thickness)
        self.add_wall(np.array([last, ends[1]]), thickness)

    def turned(self, yaw: float) -> "_Plot":
        """Return the plot turned about its centre."""
        c, s = math.cos(yaw), math.sin(yaw)
        return _Plot(
            self.edge,
            [(c * x - s * y, s * x + c * y, a, b, t + yaw)
             for x, y, a, b, t in self.boxes],
            [(c * x - s * y, s * x + c * y, r) for x, y, r in self.posts],
        )  # fmt: skip

    def scene(self, name: str) -> Scene:
        world = World(name)
        for x, y, long, wide, yaw in self.boxes:
            world.add_box((x, y), (long, wide), yaw=yaw)
        for x, y, radius in self.posts:
            world.add_cylinder((x, y), radius)
        return world.scene()

    def outlines(self) -> list[Points]:
        """Return the outlines of boxes, and of posts as polygons around them."""
        unit = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
        found = []
        for x, y, long, wide, yaw in self.boxes:
            c, s = math.cos(yaw), math.sin(yaw)
            found.append(unit * (long, wide) @ np.array([[c, s], [-s, c]]) + (x, y))
        turn = np.linspace(0.0, math.tau, 24, endpoint=False)
        circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        for x, y, radius in self.posts:
            found.append(circle * radius / math.cos(math.pi / 24) + (x, y))
        return found


def random_goal(robot: str, seed: int) -> RandomGoal:
    """Return the drive of a robot and a seed; equal arguments give equal drives."""
    rng = np.random.default_rng([seed, sorted(ROBOTS).index(robot)])
    body = body_of(robot)
    length, width = np.ptp(body, axis=0).tolist()
    kind = str(rng.choice(sorted(_WORLDS)))
    edge = _EDGE * max(length, _LEAST_M)
    plot = _Plot(edge, [], [])
    _add_walls(plot)
    _WORLDS[kind](plot, rng, width)
    if rng.random() < 0.5:
        plot = plot.turned(rng.uniform(-math.pi, math.pi))
    outlines = plot.outlines()
    place = _Places(outlines, body, edge, rng)
    start, start_kind = place.start()
    goal, goal_kind = place.goal()
    kinds = kind, start_kind, goal_kind
    scene = plot.scene(f"{kind}-{robot}-{seed}")
    return RandomGoal(scene, outlines, body, start, goal, kinds)


@dataclass(frozen=True)
class _Places:
    """Draws a start and a goal among obstacles."""

    outlines: list[Points]
    body: Points
    edge: float
    rng: Rng

    def start(self) -> tuple[Pose2, str]:
        """Return a pose at which the body fits, and its kind."""
        is_beside = self.rng.random() < 0.3
        radius = float(np.hypot(*self.body.T).max())
        for _ in range(_ATTEMPTS):
            x, y = self._point()
            if is_beside and self._away((x, y)) > radius + _BESIDE_M:
                continue
            pose = Pose2(x, y, float(self.rng.uniform(-math.pi, math.pi)))
            if not self._fits(pose, _TOUCHING_M if is_beside else 0.15):
                continue
            if is_beside and self._fits(pose, _BESIDE_M):
                continue
            return pose, "beside" if is_beside else "free"
        raise AssertionError("no start with room for the body")

    def goal(self) -> tuple[tuple[float, float], str]:
        """Return a point and its kind."""
        kind = str(self.rng.choice(GOALS))
        inscribed = float(np.abs(self.body[:, 1]).max())
        for _ in range(_ATTEMPTS):
            point = self._point()
            if kind == "outside":
                angle = self.rng.uniform(-math.pi, math.pi)
                reach = self.edge * self.rng.uniform(0.8, 1.2)
                return (reach * math.cos(angle), reach * math.sin(angle)), kind
            away = self._away(point)
            if (
                kind == "anywhere"
                or (kind == "inside" and away < 0)
                or (kind == "beside" and 0 < away < inscribed)
                or (kind == "free" and away > inscribed)
            ):
                return point, kind
        return point, "anywhere"

    def _point(self) -> tuple[float, float]:
        x, y = self.rng.uniform(-self.edge / 2, self.edge / 2, 2).tolist()
        return x, y

    def _away(self, point: tuple[float, float]) -> float:
        """Return the signed distance of a point from the obstacles, or less."""
        return min(_beyond(outline, point) for outline in self.outlines)

    def _fits(self, pose: Pose2, margin_m: float) -> bool:
        corners = np.array(pose.apply(self.body))
        return all(_gap(corners, outline) > margin_m for outline in self.outlines)


def _beyond(outline: Points, point: tuple[float, float]) -> float:
    """Return how far a point is beyond an edge of a convex outline; < 0: inside."""
    edges = np.roll(outline, -1, axis=0) - outline
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1)
    normals /= np.hypot(*edges.T)[:, None]
    return float(((np.array(point) - outline) * normals).sum(axis=1).max())


def _gap(one: Points, other: Points) -> float:
    """Return a lower bound on the distance of convex outlines: along an edge normal."""
    best = -math.inf
    for mine, theirs in ((one, other), (other, one)):
        edges = np.roll(mine, -1, axis=0) - mine
        normals = np.stack([edges[:, 1], -edges[:, 0]], axis=1)
        lengths = np.hypot(*edges.T)
        normals = normals[lengths > 1e-9] / lengths[lengths > 1e-9, None]
        apart = (theirs @ normals.T).min(axis=0) - (mine @ normals.T).max(axis=0)
        best = max(best, float(apart.max()))
    return best


def _passage(rng: Rng, width: float, roomy: float) -> float:
    """Return the width of a passage: roomy, tight, or too narrow by a little."""
    kind = rng.random()
    if kind < 0.5:
        return width + float(rng.uniform(0.3, 0.3 + roomy))
    if kind < 0.8:
        return width + float(rng.uniform(0.12, 0.3))
    return max(0.0, width + float(rng.uniform(-0.15, 0.12)))


def _add_walls(plot: _Plot) -> None:
    half = plot.edge / 2
    corners = np.array([(-half, -half), (half, -half), (half, half), (-half, half)])
    for k in range(4):
        ends = np.array([corners[k], corners[(k + 1) % 4]])
        plot.add_wall(ends, 0.2)


def _rooms(plot: _Plot, rng: Rng, width: float) -> None:
    """A grid of rooms with doors, walls of any thickness, and a few boxes."""
    half, unit = plot.edge / 2, plot.edge / 3
    thickness = float(rng.uniform(0.06, 0.4))
    for line in (-half + unit, half - unit):
        for low in (-half, -half + unit, -half + 2 * unit):
            for swap in (False, True):
                ends = np.array([(line, low), (line, low + unit)])
                ends = ends[:, ::-1] if swap else ends
                gap = min(_passage(rng, width, unit / 4), 0.8 * unit)
                begin = float(rng.uniform(0.1 * unit, 0.9 * unit - gap))
                door = (begin, gap if rng.random() < 0.85 else 0.0)
                plot.add_wall_with_door(ends, thickness, door)
    _scatter(plot, rng, width, int(rng.integers(0, 8)))


def _maze(plot: _Plot, rng: Rng, width: float) -> None:
    """A maze by depth-first search, in cells of passages a little wider than needed."""
    pitch = width + float(rng.uniform(0.15, 0.8)) + 0.1
    cells = max(3, min(8, int(plot.edge / pitch)))
    pitch = plot.edge / cells
    half = plot.edge / 2
    seen, trail = {(0, 0)}, [(0, 0)]
    open_: set[tuple[tuple[int, int], ...]] = set()
    while trail:
        row, column = trail[-1]
        around = ((row + 1, column), (row - 1, column), (row, column + 1),
                  (row, column - 1))  # fmt: skip
        free = [c for c in around
                if min(c) >= 0 and max(c) < cells and c not in seen]  # fmt: skip
        if not free:
            trail.pop()
            continue
        after = free[int(rng.integers(len(free)))]
        open_.add(tuple(sorted(((row, column), after))))
        seen.add(after)
        trail.append(after)
    for row in range(cells):
        for column in range(cells):
            x, y = column * pitch - half, row * pitch - half
            for after, ends in (
                ((row, column + 1), [(x + pitch, y), (x + pitch, y + pitch)]),
                ((row + 1, column), [(x, y + pitch), (x + pitch, y + pitch)]),
            ):
                if max(after) >= cells:
                    continue
                if tuple(sorted(((row, column), after))) not in open_:
                    plot.add_wall(np.array(ends), 0.1)
                elif rng.random() < 0.15:
                    gap = min(_passage(rng, width, 0.3), pitch - 0.05)
                    begin = float(rng.uniform(0.0, pitch - gap))
                    plot.add_wall_with_door(np.array(ends), 0.1, (begin, gap))


def _office(plot: _Plot, rng: Rng, width: float) -> None:
    """A corridor with rooms on both sides, and desks."""
    half, rooms = plot.edge / 2, 4
    unit = plot.edge / rooms
    wide = min(_passage(rng, width, width) + 0.2, 0.3 * plot.edge)
    for side in (-1, 1):
        for room in range(rooms):
            low = -half + room * unit
            gap = min(_passage(rng, width, unit / 4), 0.8 * unit)
            begin = float(rng.uniform(0.1 * unit, 0.9 * unit - gap))
            y = side * wide / 2
            wall = np.array([(low, y), (low + unit, y)])
            plot.add_wall_with_door(wall, 0.1, (begin, gap))
            if room:
                plot.add_wall(np.array([(low, y), (low, side * half)]), 0.1)
    _scatter(plot, rng, width, int(rng.integers(4, 14)))


def _forest(plot: _Plot, rng: Rng, width: float) -> None:
    """Trunks at any distance from each other."""
    half = plot.edge / 2
    apart = width + float(rng.uniform(0.1, 0.6))
    count = int(rng.uniform(0.1, 0.4) * (plot.edge / apart) ** 2)
    for x, y in rng.uniform(-half, half, (count, 2)).tolist():
        plot.posts.append((x, y, float(rng.uniform(0.03, 0.15))))


def _clutter(plot: _Plot, rng: Rng, width: float) -> None:
    """Boxes of any heading, and posts."""
    _scatter(plot, rng, width, int(rng.integers(10, 40)))
    _forest(plot, rng, 2 * width)


def _scatter(plot: _Plot, rng: Rng, width: float, count: int) -> None:
    half = plot.edge / 2
    for x, y in rng.uniform(-half, half, (count, 2)).tolist():
        long, wide = (width * rng.uniform(0.3, 2.0, 2)).tolist()
        plot.boxes.append((x, y, long, wide, float(rng.uniform(0, math.pi))))


_WORLDS: dict[str, Callable[[_Plot, Rng, float], None]] = {
    "rooms": _rooms,
    "maze": _maze,
    "office": _office,
    "forest": _forest,
    "clutter": _clutter,
}
