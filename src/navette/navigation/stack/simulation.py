"""A run of the simulated robot with its navigation, from options to summary."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from navette.errors import CallbackError, NetworkError, ParameterError
from navette.msgs.topics import CLOCK, SLAM_MAP, STATIC_MAP
from navette.navigation.planning.params import PlannerParams
from navette.navigation.stack.localization import localization_nodes
from navette.navigation.stack.localization_params import localization_parameters
from navette.navigation.stack.methods import method_parameters
from navette.navigation.stack.monitor import MonitorNode, OnProgress, RunProgress
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.pose_error import PoseErrorNode
from navette.navigation.stack.programs import MakeNode
from navette.navigation.stack.reservation import reserve
from navette.navigation.stack.scene import ResolvedScene, resolve_scene
from navette.navigation.stack.stack import NavigationStack
from navette.navigation.stack.stage_classes import node_class
from navette.navigation.stack.summary import RunSummary
from navette.runtime import (
    Context,
    ContextClock,
    Executor,
    LoggingSeverity,
    Node,
    PacedClock,
    Stopwatch,
    VirtualClock,
)
from navette.runtime.overrides import ParameterOverrides
from navette.sim import Scene
from navette.sim.node import SimNode
from navette.sim.sensor_topics import has_bumper
from navette.transports import EndpointKind
from navette.viewer.node import ViewerNode
from navette.viewer.params import ViewerParams

if TYPE_CHECKING:
    from navette.bags.node import RecorderNode

HALT_NS = 1_000_000_000
"""Simulated time for the robot to brake after a node raised."""


# Options that name a file → node, its parameter, and the option of the command line.
_FILES = {
    "tree": ("missions", "default_nav_to_pose_bt_xml", "--tree"),
    "known_map": ("map_memory", "map_file", "--map"),
    "keepout": ("zones", "keepout_file", "--keepout"),
    "speed_zones": ("zones", "speed_file", "--speed-zones"),
}


class Simulation:
    """One robot in one world with the whole stack, in this process.

    Args:
        options: world, robot, goals, recording, speed.
        on_change: receives the progress of the run.
        scene: a world made in Python (:class:`navette.sim.World`) instead of that of
            the options.
        parameters: node → parameter → value, over those of the robot.
        replacements: nodes of the user instead of the stack's; see
            :meth:`NavigationStack.create`.
        clock: instead of simulated time at the speed of the options.

    Raises:
        NavetteError: invalid name, file, parameter or option, named in the text.
    """

    def __init__(
        self,
        options: RunOptions,
        *,
        on_change: OnProgress = lambda progress: None,
        scene: Scene | None = None,
        parameters: Mapping[str, Mapping[str, object]] | None = None,
        replacements: Mapping[str, MakeNode] | None = None,
        clock: ContextClock | None = None,
    ) -> None:
        self.options = options
        self._parameters = parameters or {}
        self._replacements = replacements or {}
        self.resolved = resolve_scene(options, scene)
        overrides = self._overrides(self.resolved)
        clock = clock or _clock(options.speed)
        self._stopwatch = Stopwatch()
        # Taken before the first node exists: a run that cannot have its port or name
        # must not be noticed by another one.
        self._reserved = reserve(options, overrides, clock)
        self.context = Context(
            clock=clock, transport=self._reserved.transport, run=self._reserved.run
        )
        self.context.overrides.sets += overrides.sets
        try:
            self.context.init(args=[], console_level=LoggingSeverity.WARN)
            self._check_alone()
            self.resolved.rename_topics(self.context)
            self._create_nodes(on_change)
        except BaseException:
            self.close()
            raise

    def _check_alone(self) -> None:
        """Check that no other simulator runs on the network that this run shares.

        Raises:
            NetworkError: it publishes the time, and its robot would follow the same
                commands.
        """
        kind = EndpointKind.PUBLISHER
        for clock in self.context.graph.endpoints(CLOCK.name, kind=kind):
            domain = self.context.get_domain_id()
            raise NetworkError(
                f"{clock.node_full_name} publishes {CLOCK.name} in domain {domain} "
                "already, and its robot would follow this run's commands; end it, "
                "choose another domain (ROS_DOMAIN_ID), or start without --share"
            )

    def _overrides(self, resolved: ResolvedScene) -> ParameterOverrides:
        """Return the robot's parameters, the options, the user's files: last wins."""
        overrides = ParameterOverrides()
        resolved.override_parameters(overrides)
        goals = [value for goal in self.options.goals for value in goal]
        overrides.add("sim", {"seed": self.options.seed}, "--seed")
        if goals:
            overrides.add("missions", {"goals_m": goals}, "--goal")
        for field, (node, parameter, option) in _FILES.items():
            file = getattr(self.options, field)
            if file is not None:
                overrides.add(node, {parameter: str(file)}, option)
        if self.options.record is not None:
            images = {"images": self.options.record_images}
            overrides.add("recorder", images, "--record-images")
        if not self.options.headless:
            overrides.add("viewer", {"port": self.options.port}, "--port")
            overrides.add("viewer", _access(self.options), "--host")
        for node, value in method_parameters(self.options.methods).items():
            overrides.add(node, dict(value), "chosen method")
        for node, values in self._parameters.items():
            overrides.add(node, dict(values), "parameters of the run")
        for path in self.options.params_files:
            overrides.add_file(path)
        for node, given in self.options.parameters.items():
            overrides.add(node, dict(given), "-p")
        return overrides

    def _create_nodes(self, on_change: OnProgress) -> None:
        options, context = self.options, self.context
        self.recorder = self._recorder()
        self.sim = SimNode(self.resolved.scene, start=options.start, context=context)
        # Before the missions, so that it reports the last goal before they end the run.
        self.pose_error = PoseErrorNode(self.sim, context=context)

        def note(progress: RunProgress) -> None:
            if progress.state == "reached" and progress.goal is not None:
                self.pose_error.note_reached(progress.goal)
            on_change(progress)

        self.monitor = MonitorNode(context=context, on_change=note)
        self._add_localization()
        located_by = localization_nodes(self.sim.params)
        self.stack = NavigationStack.create(context, self._replacements, located_by)
        self.stack.missions.on_timed_out = self.monitor.on_timed_out
        frames = {
            name: getattr(self.sim.params, name) for name in ("map_frame", "base_frame")
        }
        if has_bumper(self.sim.simulator.compiled.robot.model):
            self._add_node("reflex", frames)
        if options.keepout is not None or options.speed_zones is not None:
            self._add_node("zones", frames)
        self.viewer = (
            None
            if options.headless
            else ViewerNode(context=context, listeners=self._reserved.listeners)
        )
        self._check_map()
        map_topic = self._given_map_topic()
        if map_topic is not None:
            self.pose_error.check_map(map_topic)
        self._drop_overrides_of_replaced()
        context.check_overrides()
        self.executor = Executor(context=context)
        for node in context.nodes:
            self.executor.add_node(node)
        if options.ends_with_goals:
            self.stack.missions.on_done = self.stop

    def _recorder(self) -> "RecorderNode | None":
        options = self.options
        if options.record is None:
            return None
        from navette.bags.node import RecorderNode  # 40 ms, as all of bags

        return RecorderNode(
            options.record, overwrite=options.overwrite, context=self.context
        )

    def _add_node(self, name: str, frames: Mapping[str, str]) -> None:
        """Create a node outside of the stack, with the frames of the robot."""
        self._add_below(name, frames, "frames of the robot")
        kind: Callable[..., Node] = node_class(name)
        kind(context=self.context)

    def _check_map(self) -> None:
        """Check that amcl has a map: from a file, or from a node of a shared network.

        Raises:
            ParameterError: the run is private, and no file is given.
        """
        if self.sim.params.locator != "amcl" or self.options.share:
            return
        # A map memory of the user's may get its map from anywhere.
        if _value_of(self.stack.map_memory, "map_file") == "":
            raise ParameterError(
                f"localization {self.sim.params.localization!r} needs a map; give one "
                "with --map FILE.yaml (navette slam and navette map save write them)"
            )

    def _given_map_topic(self) -> str | None:
        """Return the topic of the given map that locates the robot; None: none does."""
        node = self.stack.localization[-1]
        if self.sim.params.locator == "amcl":
            topic = _value_of(node, "map_topic")
            return STATIC_MAP.name if topic is None else str(topic)
        return SLAM_MAP.name if _value_of(node, "known_map") else None

    def _add_localization(self) -> None:
        """Add the parameters of the localization nodes, below all others."""
        start = self.sim.simulator.pose().to_pose2()
        params = self.sim.params
        found = localization_parameters(params, start, self.resolved.scene.origin)
        for name in localization_nodes(params):
            if name in found:
                origin = f"localization {params.localization}"
                self._add_below(name, found[name], origin)

    def _add_below(self, node: str, values: Mapping[str, Any], origin: str) -> None:
        """Add parameters that all others override."""
        derived = ParameterOverrides()
        derived.add(node, values, origin)
        overrides = self.context.overrides
        overrides.sets = [*derived.sets, *overrides.sets]

    def _drop_overrides_of_replaced(self) -> None:
        """Drop the robot's parameters for nodes that are replaced."""
        overrides, present = self.context.overrides, self.context.nodes
        names = {node.get_fully_qualified_name() for node in present}
        # A robot's file has parameters of the localizer, which slam and amcl replace.
        gone = {f"/{name}" for name in (*self._replacements, "localizer")} - names
        overrides.sets = [
            each
            for each in overrides.sets
            if not (each.names_a_node and any(map(each.matches, gone)))
            or any(map(each.matches, names))
        ]

    def run(self) -> None:
        """Run until the goals are done (headless), the time limit, or :meth:`stop`.

        Raises:
            CallbackError: a node raised; names node, topic and stamp. The robot was
                stopped first.
        """
        self._stopwatch = Stopwatch()
        limit = self.options.max_time_s
        try:
            if limit is None:
                self.executor.spin()
            else:
                self.executor.spin_until(round(limit * 1e9))
        except CallbackError as error:
            self._halt(error)
            raise

    def _halt(self, error: CallbackError) -> None:
        """Stop the robot: a zero command, and time to brake.

        Only simulator, recorder and viewer continue; other nodes may depend on the
        failed one.
        """
        self.stack.arbiter.destroy_node()
        watchers = (self.sim, self.recorder, self.viewer)
        for node in self.executor.get_nodes():
            if node not in watchers:
                self.executor.remove_node(node)
        if error.node != self.sim.get_fully_qualified_name():
            self.executor.spin_for(HALT_NS)

    def stop(self) -> None:
        """Stop :meth:`run` after the present callback; callable from any thread."""
        self.executor.stop()

    def progress(self) -> RunProgress:
        """Return the present progress."""
        return replace(
            self.monitor.progress, sim_time_s=self.context.clock.now_ns / 1e9
        )

    def real_time_factor(self) -> float:
        """Return the simulated seconds per second of the run so far."""
        wall_s = self._stopwatch.elapsed_s
        return self.context.clock.now_ns / 1e9 / wall_s if wall_s > 0 else 0.0

    def summary(self) -> RunSummary:
        """Return the result so far; goals that have not ended are ``unfinished``."""
        clearance = self.sim.simulator.min_clearance.distance
        tolerance = _value_of(self.stack.planner, "goal_tolerance_m")
        return RunSummary(
            goals=tuple(self.stack.missions.all_outcomes),
            contacts=self.sim.simulator.contacts.count,
            min_clearance_m=clearance if math.isfinite(clearance) else None,
            sim_time_s=self.context.clock.now_ns / 1e9,
            wall_time_s=self._stopwatch.elapsed_s,
            real_time_factor=self.real_time_factor(),
            seed=self.options.seed,
            pose_error_m=self.pose_error.error(),
            true_goal_distance_m=self.pose_error.goal_distance(),
            goal_tolerance_m=(
                PlannerParams().goal_tolerance_m if tolerance is None else tolerance
            ),
        )

    def close(self) -> None:
        """Stop all nodes and threads and close the files; idempotent."""
        self.context.try_shutdown()
        self._reserved.close()


def _value_of(node: Node, parameter: str) -> Any:
    """Return a parameter's value; None: the node, which may be the user's, has none."""
    if not node.has_parameter(parameter):
        return None
    return node.get_parameter(parameter).value


def _clock(speed: float) -> ContextClock:
    return VirtualClock() if math.isinf(speed) else PacedClock(speed)


def _access(options: RunOptions) -> dict[str, Any]:
    """Return the viewer's parameters that the options set."""
    given: dict[str, Any] = {"host": options.host}
    if options.unencrypted:
        given["allow_unencrypted"] = True
    if options.origins:
        given["allowed_origins"] = [*ViewerParams().allowed_origins, *options.origins]
    return given
