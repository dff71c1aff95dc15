"""The simulated robot alone, for programs that drive it themselves."""

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
    """One robot in one world as a node, without navigation; spin it with your own.

    It takes /cmd_vel and gives /lidar, /odom/filtered, /tf, … at the context's time;
    what ``world``, ``robot`` and ``start`` mean is as in ``navette sim``.

    Raises:
        NavetteError: a name or a file is wrong; says which.
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
    return SimNode(resolved.scene, start=start, context=context)
