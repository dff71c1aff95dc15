# SPDX-License-Identifier: Apache-2.0
"""Who touches whom and who is seen by whom, as MuJoCo's bit masks and groups.

Collision masks: ground (1) and obstacles (2) never meet each other; free bodies
(4) and the robot meet them and one another. Geometry groups tell sensors what to
see: 0 seen and solid, 1 only seen, 2 only solid; 3, 4, 5 the same for the robot,
which its own sensors do not see.
"""

from navette.sim.scene import Geometry

GROUND, OBSTACLE, FREE = 1, 2, 4
SEEN_SOLID, SEEN, SOLID = 0, 1, 2
ROBOT_GROUP = 3  # added to the three above


def group_of(geometry: Geometry) -> int:
    if geometry.collides:
        return SEEN_SOLID if geometry.visible else SOLID
    return SEEN
