"""Run one trial in this process, in virtual time."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from navette.errors import InvalidValueError
from navette.navigation.bench.cpu import CpuMeter
from navette.navigation.bench.losses import detour_loss, lost_seconds
from navette.navigation.bench.observer import TrialObserver
from navette.navigation.bench.trial import Trial, TrialResult, barn_score
from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.programs import MakeNode
from navette.navigation.stack.simulation import Simulation
from navette.runtime import Stopwatch

NodeLoader = Callable[[Mapping[str, str]], Mapping[str, MakeNode]]
"""Loads the user's node classes: node of the stack → class, as in a trial."""


def run_trial(trial: Trial, load_nodes: NodeLoader | None = None) -> TrialResult:
    """Drive the trial and measure it; deterministic for its seed except ``wall_s``.

    Args:
        trial: what to run.
        load_nodes: required for a trial that replaces nodes of the stack.

    Raises:
        NavetteError: invalid world, robot or parameter.
    """
    stopwatch = Stopwatch()
    simulation = Simulation(
        options_of(trial),
        replacements=_replacements(trial, load_nodes),
    )
    try:
        meter = CpuMeter()
        for node in simulation.context.nodes:
            meter.watch(node)
        observer = TrialObserver(
            trial.goals[-1],
            trial.reach_m,
            on_end=simulation.stop,
            ends_at_contact=trial.ends_at_contact,
            context=simulation.context,
        )
        simulation.executor.add_node(observer)
        simulation.run()
        result = _measure(trial, simulation, observer, stopwatch.elapsed_s)
        cpu_s = {name: round(s, 4) for name, s in meter.seconds().items()}
        return replace(result, cpu_s=cpu_s)
    finally:
        simulation.close()


def _replacements(
    trial: Trial, load_nodes: NodeLoader | None
) -> Mapping[str, MakeNode]:
    if not trial.replacements:
        return {}
    if load_nodes is None:
        names = ", ".join(trial.replacements)
        raise InvalidValueError(
            f"trial {trial.name!r} replaces {names}, but no loader of nodes was given; "
            "pass load_nodes, such as navette.ros2.names.node_classes.node_makers"
        )
    return load_nodes(trial.replacements)


def options_of(trial: Trial) -> RunOptions:
    """Return the options of the run: headless, as fast as possible."""
    return RunOptions(
        world=trial.world,
        robot=trial.robot,
        start=trial.start,
        goals=trial.goals,
        headless=True,
        speed=math.inf,
        seed=trial.seed,
        params_files=trial.params_files,
        methods=trial.methods,
        parameters=trial.parameters,
        max_time_s=trial.limit_s,
    )


def _measure(
    trial: Trial, simulation: Simulation, observer: TrialObserver, wall_s: float
) -> TrialResult:
    summary = simulation.summary()
    samples = observer.samples
    outcome = _outcome(trial, simulation, observer)
    began_s = 0.0 if observer.began_ns is None else observer.began_ns / 1e9
    time_s = float(samples[-1, 0] - began_s) if len(samples) else 0.0
    path_m = float(np.hypot(*np.diff(samples[:, 1:3], axis=0).T).sum())
    cruise = simulation.stack.cruise_speed_mps or trial.fastest_mps
    return TrialResult(
        suite=trial.suite,
        name=trial.name,
        seed=trial.seed,
        outcome=outcome,
        time_s=time_s,
        score=barn_score(
            outcome == "reached", time_s, trial.shortest_m, trial.fastest_mps
        ),
        contacts=summary.contacts,
        path_m=path_m,
        shortest_m=trial.shortest_m,
        min_clearance_m=summary.min_clearance_m,
        lost_s=lost_seconds(samples, observer.states, cruise)
        | detour_loss(path_m, trial, cruise, succeeded=outcome == "reached"),
        jerk=_roughness(samples),
        wall_s=wall_s,
        track=np.round(samples[::5, 1:3], 2).tolist(),
        sim_s=summary.sim_time_s,
        reach_m=trial.reach_m,
        variant=trial.variant,
        pose_error_m=summary.pose_error_m.final,
        worst_pose_error_m=summary.pose_error_m.worst,
    )


def _outcome(trial: Trial, simulation: Simulation, observer: TrialObserver) -> str:
    if simulation.sim.simulator.contacts.count:
        return "contact"
    if trial.reach_m > 0:
        if observer.arrived:
            return "reached"
    elif all(goal.result == "reached" for goal in simulation.summary().goals):
        return "reached"
    failed = [
        goal.result
        for goal in simulation.summary().goals
        if goal.result not in ("reached", "unfinished")
    ]
    return failed[0] if failed else "timed_out"


def _roughness(samples: NDArray[np.float64]) -> float:
    """Return the root mean square of the acceleration's change (m/s³), at 10 Hz."""
    if len(samples) < 4:
        return 0.0
    grid = np.arange(samples[0, 0], samples[-1, 0], 0.1)
    speed = np.interp(grid, samples[:, 0], samples[:, 3])
    if len(speed) < 3:
        return 0.0
    return float(np.sqrt(np.mean((np.diff(speed, 2) / 0.01) ** 2)))
