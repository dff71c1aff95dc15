"""Run a simulation with progress on the terminal and an exit code."""

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

from navette.cli.gc_tuning import collect
from navette.cli.interruption import INTERRUPTED, sigterm_as_interrupt
from navette.cli.status import StatusScreen
from navette.errors import CallbackError
from navette.navigation.stack.options import RunOptions

if TYPE_CHECKING:
    from navette.navigation.stack.monitor import RunProgress
    from navette.navigation.stack.simulation import Simulation

SUCCEEDED = 0
FAILED = 1


def run_simulation(options: RunOptions, *, as_json: bool) -> int:
    """Run until the end or an interrupt, and return the exit code.

    0: success (headless: all goals reached without contact). 1: a goal was not
    reached, the robot touched something, or a node raised. 130: a headless run was
    interrupted before its last goal.
    """
    screen = StatusScreen(options)
    simulation = start_simulation(options, screen, screen.on_change)
    collect()
    try:
        return _drive(simulation, screen, as_json=as_json)
    finally:
        simulation.close()


def start_simulation(
    options: RunOptions,
    screen: StatusScreen,
    on_change: Callable[["RunProgress"], None] = lambda progress: None,
) -> "Simulation":
    """Return the simulation of the options; ``screen`` shows how far the start is."""
    with screen.starting():
        # Imported here: it imports Numba.
        from navette.cli.preparing import prepare

        prepare(options, screen.show_line, screen.show_progress)
        return _make_simulation(options, on_change)


def _make_simulation(
    options: RunOptions, on_change: Callable[["RunProgress"], None]
) -> "Simulation":
    """Return the simulation of the options: own nodes, too."""
    # Imported here: the first import compiles the kernels.
    from navette.navigation.stack.simulation import Simulation

    makers = {}
    if options.replacements:
        from navette.ros2.names.node_classes import node_makers

        makers = node_makers(options.replacements)
    return Simulation(options, on_change=on_change, replacements=makers)


def _drive(simulation: "Simulation", screen: StatusScreen, *, as_json: bool) -> int:
    failure: CallbackError | None = None
    with sigterm_as_interrupt(), screen.watching(simulation):
        try:
            simulation.run()
            interrupted = False
        except KeyboardInterrupt:
            interrupted = True
        except CallbackError as error:
            failure = error
            interrupted = False
    summary = simulation.summary()
    screen.report(summary, interrupted=interrupted)
    if as_json:
        sys.stdout.write(summary.to_json() + "\n")
    if failure is not None:
        screen.report_failure(f"stopped: {failure}")
        return FAILED
    if simulation.recorder is not None and simulation.recorder.error is not None:
        screen.report_failure(f"recording failed: {simulation.recorder.error}")
        return FAILED
    if not simulation.options.ends_with_goals:
        return SUCCEEDED
    if interrupted:
        return INTERRUPTED
    return SUCCEEDED if summary.succeeded else FAILED
