"""The environment ``navette/Navigation-v0``: drive a robot to a goal by its lidar."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError, ParameterError
from navette.geometry import Pose2
from navette.navigation.gym.drawing import draw_episode
from navette.navigation.gym.ends import choose_ends
from navette.navigation.gym.observation import Observation, Observer
from navette.navigation.gym.params import NavigationEnvParams
from navette.navigation.gym.route import Point
from navette.navigation.gym.worlds import NodeParameters, WorldSource
from navette.sim import Scene, Simulator
from navette.sim.scene import MecanumDrive
from navette.sim.sensor_specs import LidarSensor
from navette.sim.sensor_topics import sensors_of

_OPTIONS = ("start", "goal", "world_seed")


class NavigationEnv(gymnasium.Env[Observation, NDArray[np.float32]]):
    """Reach a goal without touching anything, in the simulator and without nodes.

    Observation (``Dict``, float32):
        ``ranges`` (beams,): lidar ranges (m) from the sensor's first to its last beam;
        the largest range where nothing is hit, 0 where something is too close.
        ``goal`` (2,): x, y (m) of the goal in the robot's frame.
        ``velocity`` (2,): forward speed (m/s) and turn rate (rad/s); (3,) with the
        speed to the left if the drive moves sideways.

    Action (``Box(-1, 1, (2,))``): speed and turn rate as shares of the robot's largest
    ones; negative speeds are shares of the largest speed in reverse. A drive that moves
    sideways has a third component, to the left.

    Reward of a step: ``progress_reward`` · metres by which the shortest path to the
    goal shortened − ``time_penalty`` · ``step_s``, + ``goal_reward`` on arrival,
    − ``contact_penalty`` for a contact.

    Info: ``outcome`` is ``driving``, ``reached`` or ``contact`` (terminated), or
    ``timed_out`` (truncated); ``distance_m`` along the shortest path to the goal,
    ``pose`` (x, y, yaw), ``time_s``, ``contact_with``, and ``world_seed`` (−1 in a
    world that is not generated).

    Args:
        world: built-in name, file, :class:`~navette.sim.Scene`, a kind of generated
            world such as ``barn-like`` (drawn for each episode) or ``barn-like:SEED``.
        robot: built-in name or file; None = the world's own, or as ``navette sim``.
        start: pose (x, y, yaw) or place (x, y); None = that of the generated world, or
            drawn.
        goal: (x, y), m; None = that of the generated world, or drawn.
        parameters: node name → parameter → value, over those of the robot, such as
            ``{"sim": {"lidar_noise_m": 0.02}}``.
        render_mode: ``rgb_array`` or None.
        values: fields of :class:`NavigationEnvParams`.

    Raises:
        NavetteError: invalid world, robot or parameter; the text names it.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - Gymnasium declares it so
        "render_modes": ["rgb_array"],
        "render_fps": 10,
    }

    def __init__(
        self,
        world: str | Path | Scene = "barn-like",
        robot: str | Path | None = None,
        *,
        start: tuple[float, ...] | None = None,
        goal: Point | None = None,
        parameters: NodeParameters | None = None,
        render_mode: str | None = None,
        **values: Any,
    ) -> None:
        self.params = NavigationEnvParams.from_dict(values)
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise InvalidValueError(
                f"render_mode {render_mode!r}: expected rgb_array or None"
            )
        self.render_mode = render_mode
        self._ends = _checked({"start": start, "goal": goal})
        self._source = WorldSource(
            world,
            robot,
            parameters or {},
            kept=self.params.worlds,
            first=self.params.first_world,
        )
        # Every world has the same robot, hence every episode the same spaces.
        first = self._source.select(np.random.default_rng(0), None)
        self.observer = _observer_of(first.simulator, self.params)
        self.observation_space = self.observer.observation_space()
        self.action_space = self.observer.action_space()
        self._steps = _steps_per_action(first.simulator, self.params)
        self._distance_m = math.inf

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: of worlds, starts, goals and noise of this and later episodes.
            options: for this episode: ``start`` (x, y, yaw) or (x, y), ``goal`` (x, y),
                ``world_seed``.

        Raises:
            InvalidValueError: an unknown option, a start in an obstacle, or no path
                from start to goal.
        """
        super().reset(seed=seed)
        chosen = {**self._ends, **_checked(options or {})}
        self._world = self._source.select(self.np_random, chosen.get("world_seed"))
        self._place(chosen["start"], chosen["goal"])
        self._time_s, self._outcome = 0.0, "driving"
        self._track = [self._position()]
        return self._observe(), self._info()

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Drive for ``step_s`` with a command."""
        p, simulator = self.params, self._world.simulator
        simulator.command(*self.observer.command(action))
        simulator.step(self._steps)
        self._time_s = simulator.now_ns / 1e9
        before_m, self._distance_m = self._distance_m, self._measure()
        self._outcome = self._judge()
        reward = p.progress_reward * (before_m - self._distance_m)
        reward -= p.time_penalty * p.step_s
        reward += p.goal_reward * (self._outcome == "reached")
        reward -= p.contact_penalty * (self._outcome == "contact")
        self._track.append(self._position())
        terminated = self._outcome in ("reached", "contact")
        truncated = self._outcome == "timed_out"
        return self._observe(), reward, terminated, truncated, self._info()

    def render(self) -> NDArray[np.uint8] | None:
        """Return a picture (H, W, 3) of the episode from above."""
        if self.render_mode is None:
            return None
        scan = self._scan
        hit = np.isfinite(scan.ranges)
        angles = scan.angle_min + scan.angle_increment * np.flatnonzero(hit)
        ends = scan.ranges[hit, None] * np.stack([np.cos(angles), np.sin(angles)], 1)
        map_T_scan = self._position() @ self.observer.base_T_scan
        return draw_episode(
            self._world,
            self._route.goal,
            self._track,
            map_T_scan.apply(ends.astype(np.float64)),
            self.params.tolerance_m,
        )

    def _place(self, start: Any, goal: Any) -> None:
        """Put the robot at the start; measure the shortest path to the goal."""
        world, rng, p = self._world, self.np_random, self.params
        if world.start is not None and not p.random_ends:
            start, goal = start or world.start, goal or world.goal
        ends = choose_ends(
            world,
            None if start is None else (start[0], start[1]),
            goal,
            (2 * p.tolerance_m, p.farthest_goal_m),
            rng,
        )
        yaw = rng.uniform(-math.pi, math.pi)
        if start is not None and len(start) == 3:
            yaw = start[2]
        world.simulator.reset(
            start=Pose2(*ends.start, yaw), seed=int(rng.integers(1 << 31))
        )
        self._route = ends.route
        self._distance_m = ends.route.distance(ends.start)

    def _measure(self) -> float:
        """Return the length of the shortest path to the goal; the last one if none."""
        x, y, _ = self._position()
        length_m = self._route.distance((x, y))
        return length_m if math.isfinite(length_m) else self._distance_m

    def _judge(self) -> str:
        simulator = self._world.simulator
        x, y, _ = self._position()
        if simulator.contacts.count:
            return "contact"
        if math.dist((x, y), self._route.goal) <= self.params.tolerance_m:
            return "reached"
        return "timed_out" if self._time_s >= self.params.limit_s else "driving"

    def _position(self) -> Pose2:
        return self._world.simulator.pose().to_pose2()

    def _observe(self) -> Observation:
        simulator = self._world.simulator
        self._scan = simulator.scan()
        if not simulator.params.believes_truth:
            wheels = simulator.wheel_odometry()
            pose, motion = wheels.pose, wheels.motion()
            velocity = (motion.speed, motion.yaw_rate, motion.side)
        else:
            pose, true = self._position(), simulator.motion()
            velocity = (true.linear[0], true.angular[2], true.linear[1])
        goal = self._route.goal
        if self.params.lookahead_m:
            at = self._position()
            goal = self._route.ahead((at.x, at.y), self.params.lookahead_m)
        seen = velocity[: self.observer.size]
        return self.observer.observe(self._scan.ranges, pose, goal, seen)

    def _info(self) -> dict[str, Any]:
        contacts = self._world.simulator.contacts.episodes
        seed = self._source.current_seed
        return {
            "outcome": self._outcome,
            "distance_m": self._distance_m,
            "pose": np.array(self._position()),
            "time_s": self._time_s,
            "contact_with": contacts[0].obstacle if contacts else "",
            "world_seed": -1 if seed is None else seed,
        }


def _checked(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of a reset.

    Raises:
        InvalidValueError: an unknown option or a malformed value.
    """
    unknown = sorted(set(options) - set(_OPTIONS))
    if unknown:
        raise InvalidValueError(
            f"unknown reset option {unknown[0]!r}; known: {', '.join(_OPTIONS)}"
        )
    checked = dict(options)
    if checked.get("start") is not None:
        checked["start"] = _numbers("start", checked["start"], (2, 3))
    if checked.get("goal") is not None:
        checked["goal"] = _numbers("goal", checked["goal"], (2,))
    seed = checked.get("world_seed")
    if seed is not None and (not isinstance(seed, (int, np.integer)) or seed < 0):
        raise InvalidValueError(f"world_seed {seed!r}: expected a whole number >= 0")
    return checked


def _numbers(name: str, value: Any, lengths: tuple[int, ...]) -> tuple[float, ...]:
    try:
        numbers = tuple(map(float, value))
    except (TypeError, ValueError):
        numbers = ()
    if len(numbers) not in lengths or not all(map(math.isfinite, numbers)):
        form = " or ".join({2: "(x, y)", 3: "(x, y, yaw)"}[n] for n in lengths)
        raise InvalidValueError(f"{name} {value!r}: expected {form}, finite numbers")
    return numbers


def _observer_of(simulator: Simulator, params: NavigationEnvParams) -> Observer:
    """Return the observer of a robot.

    Raises:
        InvalidValueError: the robot has no lidar, or too few beams.
    """
    if not simulator.lidars:
        raise InvalidValueError("the robot has no laser scanner: nothing to observe")
    link, sensor = next(sensors_of(simulator.compiled.robot.model, LidarSensor))
    limits = simulator.params
    moves_sideways = isinstance(simulator.compiled.robot.drive, MecanumDrive)
    if params.beams > sensor.samples:
        raise ParameterError(
            f"parameter 'beams': {params.beams} is not allowed; the lidar has "
            f"{sensor.samples}"
        )
    return Observer(
        beams=params.beams or sensor.samples,
        angle_min=sensor.angle_min,
        angle_max=sensor.angle_max,
        range_max_m=sensor.range_max,
        base_T_scan=(simulator.link_in_base(link) @ sensor.link_T_sensor).to_pose2(),
        forward_mps=limits.max_speed_mps,
        reverse_mps=limits.max_reverse_speed_mps,
        turn_radps=limits.max_yaw_rate_radps,
        side_mps=limits.max_side_speed_mps if moves_sideways else 0.0,
    )


def _steps_per_action(simulator: Simulator, params: NavigationEnvParams) -> int:
    """Return the physics steps of one action.

    Raises:
        ParameterError: a step that is not a whole number of physics steps, or longer
            than the robot obeys one command.
    """
    limits = simulator.params
    steps = params.step_s / limits.timestep_s
    if abs(steps - round(steps)) > 1e-6:
        raise ParameterError(
            f"parameter 'step_s': {params.step_s!r} is not allowed; expected a whole "
            f"number of physics steps of {limits.timestep_s:g} s"
        )
    if 0 < limits.command_timeout_s < params.step_s:
        raise ParameterError(
            f"parameter 'step_s': {params.step_s!r} is not allowed; the robot stops "
            f"{limits.command_timeout_s:g} s after a command (command_timeout_s)"
        )
    return round(steps)
