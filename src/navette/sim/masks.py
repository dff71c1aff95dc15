# SPDX-License-Identifier: Apache-2.0
"""Collision and visibility as MuJoCo's bit masks and geometry groups.

Collision masks: ground (1) and obstacles (2) never collide with each other; free bodies
(4) and the robot collide with both and with one another. Geometry groups: 0 visible and
solid, 1 visible only, 2 solid only; 3, 4, 5 the same for the robot, which is invisible
to its own sensors.
"""

from navette.sim.scene import Geometry

GROUND, OBSTACLE, FREE = 1, 2, 4
SEEN_SOLID, SEEN, SOLID = 0, 1, 2
ROBOT_GROUP = 3  # added to the three above


def group_of(geometry: Geometry) -> int:
    if geometry.collides:
        return SEEN_SOLID if geometry.visible else SOLID
    return SEEN
