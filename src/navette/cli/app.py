"""The commands and their options; the work is done in ``launch``."""

import math
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from navette import __version__
from navette.cli.arguments import (
    fill_values,
    join_pairs,
    parse_goal,
    parse_speed,
    spread_lists,
    without_daemon,
)
from navette.cli.completing_installed import complete_robots, complete_worlds
from navette.cli.completion import is_completing, keep_quiet
from navette.cli.lazy import lazy_group
from navette.cli.remarks import complain
from navette.cli.verbs import VERBS
from navette.errors import NavetteError

if TYPE_CHECKING:
    from navette.navigation.stack import RunOptions

app = typer.Typer(
    name="navette",
    cls=lazy_group(VERBS),
    help="Robot navigation you pip install: simulate, map, plan, drive, watch.",
    no_args_is_help=True,
    add_completion=is_completing(),  # adds options that only a shell needs
    rich_markup_mode="rich",
    context_settings={"help_option_names": ["-h", "--help"]},
)

USAGE_ERROR = 2

World = Annotated[
    str,
    typer.Argument(
        metavar="[WORLD]",
        help="A built-in world (arena, empty, …) or a file: .sdf, .world, .xml (MJCF),"
        " .urdf, or a ROS map .yaml.",
        autocompletion=complete_worlds,
    ),
]
Robot = Annotated[
    str | None,
    typer.Option(
        metavar="NAME|PATH",
        help="A built-in robot (jackal, turtlebot3_burger, husky, course) or a model"
        " file; by default the world's own.",
        autocompletion=complete_robots,
    ),
]
Start = Annotated[
    tuple[float, float, float] | None,
    typer.Option(metavar="X Y YAW_DEG", help="Where the robot starts."),
]
Goals = Annotated[
    list[str] | None,
    typer.Option(metavar="X Y", help="A goal in metres; repeat for several in order."),
]
Headless = Annotated[
    bool,
    typer.Option("--headless", help="No live view; end when the goals are done."),
]
Speed = Annotated[
    str | None,
    typer.Option(
        metavar="FACTOR|max",
        help="Simulated seconds per second; 1 with the live view, max when headless.",
    ),
]
Seed = Annotated[int, typer.Option(help="Seed of all noise; same seed, same run.")]
Record = Annotated[
    Path | None,
    typer.Option(metavar="FILE.mcap", help="Record every topic except raw images."),
]
RecordImages = Annotated[
    bool, typer.Option("--record-images", help="Record raw images as well.")
]
ParamsFile = Annotated[
    list[Path] | None,
    typer.Option(metavar="FILE", help="ROS 2 parameter file; later ones win."),
]
MaxTime = Annotated[
    float | None,
    typer.Option(metavar="S", help="End after this much simulated time."),
]
Json = Annotated[
    bool, typer.Option("--json", help="Print one JSON object about the run on stdout.")
]
Port = Annotated[
    int,
    typer.Option(min=0, max=65535, help="Port of the live view; 0 takes a free one."),
]


def _version(value: bool) -> None:
    if value:
        typer.echo(f"navette {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool,
        typer.Option(
            "--version",
            help="Print the version and exit.",
            callback=_version,
            is_eager=True,
        ),
    ] = False,
    domain_id: Annotated[
        int | None,
        typer.Option(
            min=0, max=232, metavar="N", help="In this domain, not ROS_DOMAIN_ID's."
        ),
    ] = None,
) -> None:
    """Robot navigation you pip install: simulate, map, plan, drive, watch."""
    if domain_id is not None:
        os.environ["ROS_DOMAIN_ID"] = str(domain_id)


@app.command()
def demo(
    robot: Robot = None,
    port: Port = 8765,
    speed: Speed = None,
    max_time: MaxTime = None,
) -> None:
    """A robot drives itself through an arena it does not know; watch it live.

    Drives a few goals at once, then waits for more from the live view.
    Ctrl-C ends it.
    """
    from navette.navigation.stack import RunOptions, demo_goals

    options = RunOptions(
        world="arena",
        robot=robot,
        goals=demo_goals(),
        speed=parse_speed(speed or "1"),
        max_time_s=max_time,
        port=port,
    )
    _run(options, as_json=False)


@app.command()
def sim(
    world: World = "arena",
    robot: Robot = None,
    start: Start = None,
    goal: Goals = None,
    headless: Headless = False,
    speed: Speed = None,
    seed: Seed = 0,
    record: Record = None,
    record_images: RecordImages = False,
    params: ParamsFile = None,
    max_time: MaxTime = None,
    as_json: Json = False,
    port: Port = 8765,
) -> None:
    """Simulate a robot in WORLD and drive it to goals.

    With --headless and goals: runs as fast as it can, drives the goals in order and
    exits 0 only if all were reached without contact.
    """
    from navette.geometry import Pose2
    from navette.navigation.stack import RunOptions

    options = RunOptions(
        world=world,
        robot=robot,
        start=Pose2(start[0], start[1], math.radians(start[2])) if start else None,
        goals=tuple(parse_goal(text) for text in goal or ()),
        headless=headless,
        speed=parse_speed(speed or ("max" if headless and goal else "1")),
        seed=seed,
        record=record,
        record_images=record_images,
        params_files=tuple(params or ()),
        max_time_s=max_time,
        port=port,
    )
    _run(options, as_json=as_json)


def _run(options: "RunOptions", *, as_json: bool) -> None:
    from navette.cli.running import run_simulation

    raise typer.Exit(run_simulation(options, as_json=as_json))


def main() -> None:
    """Entry point of the ``navette`` command."""
    if is_completing():
        keep_quiet()
    arguments = sys.argv[1:]
    if arguments[:1] != ["run"]:
        arguments = without_daemon(fill_values(spread_lists(join_pairs(arguments))))
    try:
        app(args=arguments, prog_name="navette")
    except NavetteError as error:
        complain(str(error))
        raise SystemExit(USAGE_ERROR) from None
    except SystemExit as end:
        _end_at_once(end.code)
        raise


def _end_at_once(exit_code: object) -> None:
    """Not waiting for what closes slowly, if there is such a thing by now."""
    shutdown = sys.modules.get("navette.transports.shutdown")
    if shutdown is not None and isinstance(exit_code, int):
        shutdown.end_with(exit_code)
