"""Start and goal of an episode: given, or drawn where the robot fits."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.navigation.gym.route import Point, Route
from navette.navigation.gym.worlds import EpisodeWorld

_ROOM_M = 0.1  # from the robot at a drawn place to the nearest obstacle, at least
_PATH_ROOM_M = 0.05  # beside the path
_ATTEMPTS = 100


class Ends(NamedTuple):
    start: Point
    route: Route


def choose_ends(
    world: EpisodeWorld,
    start: Point | None,
    goal: Point | None,
    length_m: tuple[float, float],
    rng: np.random.Generator,
) -> Ends:
    """Return the ends of an episode with a path between them.

    Args:
        world: with the robot.
        start, goal: given ends (m); None = drawn.
        length_m: least and greatest length of the path to a drawn end.
        rng: source of the draw.

    Raises:
        InvalidValueError: no path between the ends, or no place for a drawn one.
    """
    for _ in range(1 if start or goal else _ATTEMPTS):
        if goal is None:
            at = start or _draw(world, _free(world, at_start=True), rng)
            found = _reachable(world, at, length_m)
            if found.any():
                return Ends(at, _route(world, _draw(world, found, rng)))
        elif start is None:
            found = _reachable(world, goal, length_m) & _free(world, at_start=True)
            if found.any():
                return Ends(_draw(world, found, rng), _route(world, goal))
        else:
            route = _route(world, goal)
            if np.isfinite(route.distance(start)):
                return Ends(start, route)
    raise InvalidValueError(
        f"start {start or 'drawn'}, goal {goal or 'drawn'}: no path between them for "
        f"this robot, of {length_m[0]:g} to {length_m[1]:g} m if one is drawn; choose "
        "other places, or another farthest_goal_m"
    )


def _route(world: EpisodeWorld, goal: Point) -> Route:
    return Route(world.space, goal, world.footprint.inscribed_radius + _PATH_ROOM_M)


def _free(world: EpisodeWorld, *, at_start: bool = False) -> NDArray[np.bool_]:
    """Cells (H, W) at which the robot stands clear with any heading."""
    around_m = world.footprint.circumscribed_radius + _ROOM_M
    room = world.space.start_room_m if at_start else world.space.room_m
    return np.asarray(room >= min(around_m, room.max()))


def _reachable(
    world: EpisodeWorld, end: Point, length_m: tuple[float, float]
) -> NDArray[np.bool_]:
    """Free cells (H, W) with a path of such a length to an end."""
    length = _route(world, end).length_m
    return np.asarray(_free(world) & (length >= length_m[0]) & (length <= length_m[1]))


def _draw(
    world: EpisodeWorld, cells: NDArray[np.bool_], rng: np.random.Generator
) -> Point:
    rows, columns = np.nonzero(cells)
    i = int(rng.integers(len(rows)))
    x, y = world.space.spec.centers_of(np.array([[rows[i], columns[i]]]))[0].tolist()
    return (x, y)
