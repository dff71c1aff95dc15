"""A picture of an episode from above."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from navette.geometry import Pose2
from navette.navigation.gym.route import Point
from navette.navigation.gym.worlds import EpisodeWorld

EDGE_PX = 600
"""Longer edge of the picture."""

_FLOOR, _OBSTACLE = (246, 246, 242), (74, 84, 96)
_ACTOR = (150, 90, 160)
_BEAMS, _TRACK = (250, 206, 140), (46, 120, 190)
_GOAL, _ROBOT = (40, 160, 80), (200, 70, 50)


def draw_episode(
    world: EpisodeWorld,
    goal: Point,
    track: Sequence[Pose2],
    beams: NDArray[np.float64],
    tolerance_m: float,
) -> NDArray[np.uint8]:
    """Return (H, W, 3): obstacles, actors, beams, driven track, goal and robot.

    Args:
        world: with the robot.
        goal: (x, y), m.
        track: poses since the start.
        beams: (N, 2) ends of the beams in the world, m.
        tolerance_m: radius of the goal.
    """
    spec = world.space.spec
    scale = EDGE_PX / max(spec.width, spec.height)
    size = (max(1, round(spec.width * scale)), max(1, round(spec.height * scale)))
    colours = np.where(
        world.space.occupied[::-1, :, None] > 0, _OBSTACLE, _FLOOR
    ).astype(np.uint8)
    picture = Image.fromarray(colours).resize(size)
    draw = ImageDraw.Draw(picture)

    def pixels(points: Any) -> list[tuple[float, float]]:
        x, y = (np.asarray(points) - spec.origin[:2]).T * scale / spec.resolution
        return list(zip(x.tolist(), (size[1] - y).tolist(), strict=True))

    for actor in world.simulator.outlines(actors=True):
        draw.polygon(pixels(actor), fill=_ACTOR)
    at = track[-1]
    centre = pixels([at[:2]])[0]
    for end in pixels(beams):
        draw.line([centre, end], fill=_BEAMS)
    draw.line(pixels([pose[:2] for pose in track]), fill=_TRACK, width=3)
    (x, y), radius = pixels([goal])[0], tolerance_m * scale / spec.resolution
    draw.ellipse(
        [x - radius, y - radius, x + radius, y + radius], outline=_GOAL, width=3
    )
    draw.polygon(pixels(at.apply(np.array(world.footprint.vertices))), fill=_ROBOT)
    return np.asarray(picture)
