"""The simulated robot without navigation, for programs that drive it."""

from pathlib import Path

from navette.geometry import Pose2
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.runtime import Context, get_default_context
from navette.sim import Scene
from navette.sim.node import SimNode


def simulate_robot(
    world: str | Path | Scene = "empty",
    robot: str | Path | None = None,
    *,
    start: Pose2 | None = None,
    context: Context | None = None,
) -> SimNode:
    """Return one robot in one world as a node, to spin with your own nodes.

    The node subscribes to /cmd_vel and publishes /lidar, /odom/filtered, /tf, … at the
    context's time, under the robot's own names if it has some. ``world``, ``robot`` and
    ``start`` are as in ``navette sim``.

    Raises:
        NavetteError: invalid name or file, named in the text.
    """
    context = context or get_default_context()
    made = world if isinstance(world, Scene) else None
    options = RunOptions(
        world=str(world) if made is None else "empty",
        robot=None if robot is None else str(robot),
        start=start,
    )
    resolved = resolve_scene(options, made)
    resolved.override_parameters(context.overrides)
    context.init_if_needed()
    resolved.rename_topics(context)
    return SimNode(resolved.scene, start=start, context=context)
