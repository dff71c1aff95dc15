"""The worlds of episodes: one fixed world, or generated ones."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from navette.errors import InvalidValueError
from navette.geometry import Footprint, Pose2
from navette.navigation.bench.dynabarn import GOAL
from navette.navigation.gym.route import FreeSpace, Point
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.scene import resolve_scene
from navette.navigation.worlds import moving_worlds
from navette.navigation.worlds.dynabarn import START
from navette.navigation.worlds.generated import KINDS
from navette.navigation.worlds.generators import generate
from navette.runtime.overrides import ParameterOverrides
from navette.sim import Scene, SimParams, Simulator

NodeParameters = Mapping[str, Mapping[str, Any]]

_FAR_AWAY = Pose2(1e4, 1e4, 0.0)


@dataclass(frozen=True)
class EpisodeWorld:
    """A compiled world with its robot.

    Attributes:
        simulator: reset for each episode.
        footprint: of the robot.
        start, goal: of a generated world; None in others.
    """

    simulator: Simulator
    footprint: Footprint
    start: Pose2 | None = None
    goal: Point | None = None

    @cached_property
    def space(self) -> FreeSpace:
        robot = self.simulator.compiled.robot.model.world_T_model.to_pose2()
        ends = [end[:2] for end in (robot, self.start, self.goal) if end is not None]
        # First needed before the first step: actors are where their scripts begin.
        actors = self.simulator.outlines(actors=True)
        return FreeSpace(self.simulator.outlines(), ends, actors)


class WorldSource:
    """Compiles the worlds of the episodes of one environment.

    Args:
        world: name of a built-in world, a file, a scene, ``KIND`` (generated worlds) or
            ``KIND:SEED`` (one of them).
        robot: built-in name or file; None = as ``navette sim`` chooses.
        parameters: node name → parameter → value, over those of the robot.
        kept: number of different generated worlds, kept in memory; 0 = none is kept.
        first: smallest seed of a generated world.
    """

    def __init__(
        self,
        world: str | Path | Scene,
        robot: str | Path | None,
        parameters: NodeParameters,
        *,
        kept: int,
        first: int,
    ) -> None:
        self._robot = None if robot is None else str(robot)
        self._parameters = parameters
        self._kept, self._first = kept, first
        self._worlds: dict[int, EpisodeWorld] = {}
        self._scene = world if isinstance(world, Scene) else None
        self._kind, _, seed = str(world).partition(":")
        self.is_generated = self._scene is None and self._kind in KINDS
        self._seed = int(seed) if self.is_generated and seed.isdigit() else None
        if self.is_generated and seed and self._seed is None:
            raise InvalidValueError(
                f"world {str(world)!r}: expected {self._kind}:SEED, SEED a whole number"
            )
        self._name = "empty" if self._scene is not None else str(world)
        self.current: EpisodeWorld | None = None
        self.current_seed: int | None = None

    def select(self, rng: np.random.Generator, seed: int | None) -> EpisodeWorld:
        """Return the world of the next episode: of a seed, or drawn.

        Raises:
            InvalidValueError: a seed for a world that is not generated.
            NavetteError: invalid world, robot or parameter.
        """
        if not self.is_generated:
            if seed is not None:
                raise InvalidValueError(
                    f"option world_seed {seed}: only generated worlds have one; "
                    f"kinds: {', '.join(KINDS)}"
                )
            self.current = self.current or self._compile(self._name, self._scene)
            return self.current
        if seed is None:
            seed = self._seed if self._seed is not None else self._draw(rng)
        self.current = self._worlds.get(seed)
        if self.current is None or seed != self.current_seed:
            self.current = self._worlds.get(seed) or self._generated(seed)
        self.current_seed = seed
        return self.current

    def _draw(self, rng: np.random.Generator) -> int:
        return self._first + int(rng.integers(self._kept or 1 << 30))

    def _generated(self, seed: int) -> EpisodeWorld:
        if self._kind == moving_worlds.KIND:
            scene = moving_worlds.moving_scene(seed)
            world = self._compile("empty", scene, START, GOAL)
        else:
            drawn = generate(self._kind, seed)
            world = self._compile("empty", drawn.scene, drawn.start, drawn.goal)
        if self._kept or self._seed is not None:
            self._worlds[seed] = world
        return world

    def _compile(
        self,
        name: str,
        scene: Scene | None,
        start: Pose2 | None = None,
        goal: Point | None = None,
    ) -> EpisodeWorld:
        resolved = resolve_scene(RunOptions(world=name, robot=self._robot), scene)
        overrides = ParameterOverrides()
        resolved.override_parameters(overrides)
        for node, values in self._parameters.items():
            overrides.add(node, values, "parameters of the environment")
        params = SimParams.from_dict(_values(overrides, "sim"))
        outline = _values(overrides, "control")["footprint_m"]
        # Each episode has its start; the world's own may lie in an obstacle.
        simulator = Simulator(resolved.scene, params, start=start or _FAR_AWAY)
        return EpisodeWorld(simulator, Footprint.from_flat(tuple(outline)), start, goal)


def _values(overrides: ParameterOverrides, node: str) -> dict[str, Any]:
    """Return the values given for a node by its name."""
    chosen = overrides.for_node(f"/{node}")
    return {name: each.value for name, each in chosen.items() if not each.is_for_all}
