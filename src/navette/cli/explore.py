"""``navette explore``: drive to frontiers of the map until the world is mapped."""

import json
import sys
from dataclasses import asdict
from typing import TYPE_CHECKING, Annotated, Any

import click
from rich.console import Console
from rich.text import Text

from navette.cli.app import (
    NO_METHODS,
    Headless,
    Json,
    MaxTime,
    Overwrite,
    Record,
    Robot,
    Seed,
    Sensors,
    Speed,
    Start,
    World,
)
from navette.cli.arguments import parse_speed, start_pose
from navette.cli.bag.text import counted
from navette.cli.hanging_indent import print_beside
from navette.cli.methods import MethodOptions
from navette.cli.options import Option
from navette.cli.view_options import DEFAULT_VIEW, ViewOptions
from navette.errors import InvalidValueError

if TYPE_CHECKING:
    from navette.navigation.missions.explore.frontiers import Frontier
    from navette.navigation.missions.explore.node import (
        ExplorationReport,
        ExplorerNode,
    )
    from navette.navigation.stack.simulation import Simulation

_FAILED = 1
_SEARCH_S = 5.0
_REASONS = {
    "complete": "everything that can be reached is mapped",
    "unreachable": "the remaining frontiers cannot be reached",
    "time_limit": "time limit",
    "no_map": "no map arrived on /map; is map_memory running?",
    "no_server": "no action navigate_to_pose; is missions running?",
    "canceled": "a goal was cancelled",
    "interrupted": "interrupted",
}


def explore(
    world: World = "arena",
    robot: Robot = None,
    sensor: Sensors = None,
    start: Start = None,
    running: Annotated[
        bool,
        Option("--running", help="Explore with the running robot, not the simulator."),
    ] = False,
    methods: MethodOptions = NO_METHODS,
    headless: Headless = False,
    speed: Speed = None,
    seed: Seed = 0,
    record: Record = None,
    overwrite: Overwrite = False,
    max_time: MaxTime = None,
    as_json: Json = False,
    view: ViewOptions = DEFAULT_VIEW,
) -> None:
    """Map an unknown world: in the simulator, or with the running robot.

    The robot drives to frontiers, where known free space meets unknown space, until
    none is left that it can reach. Exit code 0: everything reachable is mapped, without
    contact.
    """
    screen = _Screen()
    if running and methods != NO_METHODS:
        raise InvalidValueError(
            "--running explores with the robot as it runs: --planner, --controller, "
            "--costmap, --mapping, --localization, --replace and -p choose the "
            "methods of a simulated one; leave them out"
        )
    if running and start is not None:
        raise InvalidValueError(
            "--running explores with the robot as it runs: it starts where it is; "
            "leave out --start"
        )
    if running and record is not None:
        raise InvalidValueError(
            "--running explores with the robot as it runs: record it with "
            f"navette bag record -o {record}"
        )
    if running:
        code = _explore_running(screen, max_time, as_json=as_json)
    else:
        from navette.navigation.stack import RunOptions

        options = RunOptions(
            world=world,
            robot=robot,
            sensors=tuple(sensor or ()),
            start=start_pose(start),
            headless=headless,
            speed=parse_speed(speed or ("max" if headless else "1")),
            seed=seed,
            record=record,
            overwrite=overwrite,
            max_time_s=max_time,
            verb="explore",
        )
        options = methods.applied_to(view.applied_to(options))
        code = _explore_simulated(screen, options, as_json=as_json)
    raise click.exceptions.Exit(code)


class _Screen:
    """Lines about the exploration on stderr."""

    def __init__(self) -> None:
        self.console = Console(stderr=True, highlight=False)

    def on_goal(self, frontier: "Frontier", report: "ExplorationReport") -> None:
        x, y = frontier.goal
        text = (
            f"→ frontier ({x:.1f}, {y:.1f}), "
            f"{frontier.length_m:.1f} m long, {frontier.way_m:.1f} m away; "
            f"{report.coverage:.0%} of the boundary known, {report.free_m2:.0f} m² free"
        )
        print_beside(self.console, Text(f"{report.time_s:8.1f} s  "), Text(text))

    def on_end(self, report: "ExplorationReport", contacts: int | None) -> None:
        word, style = (
            ("done", "bold green") if report.succeeded else ("ended", "bold yellow")
        )
        reason = _REASONS.get(report.reason, report.reason)
        touched = "" if contacts is None else f", {counted(contacts, 'contact')}"
        text = (
            f"{reason}; {report.coverage:.1%} of the boundary known, "
            f"{report.free_m2:.0f} m² free, {counted(report.goals, 'goal')}, "
            f"{report.path_length_m:.0f} m driven in {report.time_s:.0f} s{touched}"
        )
        print_beside(self.console, Text(f"{word}: ", style), Text(text))


def _explore_simulated(screen: _Screen, options: Any, *, as_json: bool) -> int:
    from navette.cli.interruption import sigterm_as_interrupt
    from navette.cli.running import start_simulation
    from navette.cli.status import StatusScreen

    simulation = start_simulation(options, StatusScreen(options))
    try:
        from navette.navigation.stack.exploring import add_explorer

        node = add_explorer(simulation)
        node.on_goal = screen.on_goal
        if simulation.viewer is not None:
            screen.console.print(f"live view  {simulation.viewer.url}")
        with sigterm_as_interrupt():
            try:
                simulation.run()
                node.end("time_limit")
            except KeyboardInterrupt:
                node.end("interrupted")
        contacts = simulation.summary().contacts
        screen.on_end(node.report, contacts)
        if as_json:
            _print_json(node, simulation)
        return 0 if node.report.succeeded and not contacts else _FAILED
    finally:
        simulation.close()


def _print_json(node: "ExplorerNode", simulation: "Simulation") -> None:
    summary = simulation.summary()
    values = {
        **asdict(node.report),
        "contacts": summary.contacts,
        "min_clearance_m": summary.min_clearance_m,
        "sim_time_s": summary.sim_time_s,
        "wall_time_s": summary.wall_time_s,
        "seed": summary.seed,
    }
    rounded = {k: round(v, 4) if isinstance(v, float) else v for k, v in values.items()}
    sys.stdout.write(json.dumps(rounded) + "\n")


def _explore_running(screen: _Screen, max_time: float | None, *, as_json: bool) -> int:
    from navette.cli.session import connect, fail, follow_clock, is_simulated, wait_for
    from navette.navigation.stack.exploring import make_explorer, planner_values

    with connect() as node:
        values = planner_values(node, _SEARCH_S)
        if values is None:
            fail(
                f"no node planner in {_SEARCH_S:g} s; start the robot first, for "
                "example with navette up"
            )
        explorer = make_explorer(node.context, values)
        node.executor.add_node(explorer)
        if is_simulated(node):
            follow_clock(explorer)
        explorer.on_goal = screen.on_goal
        try:
            if not wait_for(node, lambda: explorer.done, max_time):
                explorer.end("time_limit")
        finally:
            explorer.end("interrupted")
            # The cancel request has to leave before the session closes.
            wait_for(node, lambda: False, 0.2)
            screen.on_end(explorer.report, None)
            if as_json:
                sys.stdout.write(explorer.report.to_json() + "\n")
        return 0 if explorer.report.succeeded else _FAILED
