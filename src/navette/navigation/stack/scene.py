"""World, robot, and the robot's parameters of a run."""

from dataclasses import dataclass, replace
from pathlib import Path

from navette.navigation.stack.options import RunOptions
from navette.navigation.worlds import load_scene
from navette.runtime import Context
from navette.runtime.names import RemapRule
from navette.runtime.overrides import ParameterOverrides
from navette.sim import (
    Robot,
    Scene,
    derive_parameters,
    identify_robot,
    load_robot,
    robot_names,
)
from navette.sim.mounting import mount_of, with_sensors

DEFAULT_ROBOT = "jackal"


@dataclass(frozen=True)
class ResolvedScene:
    """A world with its robot and its parameters: derived ones, then those of a file."""

    scene: Scene
    robot_name: str
    params_file: Path | None
    derived: dict[str, dict[str, object]]
    topic_names: dict[str, str]
    parameters: dict[str, dict[str, object]]

    def rename_topics(self, context: Context) -> None:
        """Give the nodes that are created from now on the robot's names of topics.

        Remapping rules of the user apply first.
        """
        context.arguments.remaps += map(RemapRule.parse, self.remappings)

    @property
    def remappings(self) -> list[str]:
        """Rules ``FROM:=TO`` from the stack's names of topics to the robot's."""
        return [f"{ours}:={its}" for ours, its in self.topic_names.items()]

    def override_parameters(self, overrides: ParameterOverrides) -> None:
        """Add the robot's parameters for every node of the stack."""
        for node, values in self.derived.items():
            overrides.add(node, values, f"derived from robot {self.robot_name}")
        for node, values in self.parameters.items():
            overrides.add(node, values, f"parameters of robot {self.robot_name}")
        if self.params_file is not None:
            overrides.add_file(self.params_file)
        if "costmap" in self.derived:  # the obstacle layer places what sensors saw
            of_sim = overrides.for_node("/sim")
            for name in ("map_frame", "base_frame"):
                if name in of_sim:
                    given = of_sim[name]
                    overrides.add("costmap", {name: given.value}, given.origin)


def resolve_scene(options: RunOptions, scene: Scene | None = None) -> ResolvedScene:
    """Load the world and robot of the options; ``scene`` replaces the world.

    The robot is the first of: the one in the options, the world's own, the built-in one
    with the name of the built-in world, the default. A world's own robot that equals a
    built-in one gets its parameters. Parameters without a file are derived from the
    robot's shape and drive.

    Raises:
        UnknownNameError: unknown world or robot; the text lists the known ones.
        FileFormatError: invalid file; names file and line.
    """
    if scene is None:
        scene = load_scene(options.world)
    robot = _choose_robot(options, scene)
    is_own = scene.robot is robot.model
    if options.sensors:
        model = with_sensors(robot.model, map(mount_of, options.sensors))
        robot = replace(robot, model=model)
    if is_own:
        models = (robot.model if m is scene.robot else m for m in scene.models)
        scene = replace(scene, models=tuple(models))
    else:
        scene = scene.with_robot(robot.model)
    derived = derive_parameters(robot.model)
    return ResolvedScene(
        scene,
        robot.name,
        robot.params_file,
        derived,
        robot.topic_names,
        robot.parameters,
    )


def _choose_robot(options: RunOptions, scene: Scene) -> Robot:
    if options.robot is not None:
        return load_robot(options.robot)
    if scene.robot is None:
        namesake = options.world in robot_names()
        return load_robot(options.world if namesake else DEFAULT_ROBOT)
    return identify_robot(scene.robot) or Robot(scene.robot.name, scene.robot)
