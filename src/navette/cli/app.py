"""The command line: global options, ``demo`` and ``sim``; other verbs load lazily."""

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import click

from navette import __version__
from navette.cli.arguments import (
    fill_values,
    join_pairs,
    parse_goal,
    parse_speed,
    split_run,
    start_pose,
    without_daemon,
)
from navette.cli.commands import LazyGroup
from navette.cli.completing_installed import (
    complete_robots,
    complete_runs,
    complete_sensors,
    complete_worlds,
)
from navette.cli.completion import discard_stderr, is_completing
from navette.cli.ending import end_with
from navette.cli.methods import MethodOptions
from navette.cli.options import Argument, Option
from navette.cli.stderr import print_error
from navette.cli.streams import prepare, reporting_failed_writes
from navette.cli.verbs import DRIVE, VERBS
from navette.cli.view_options import DEFAULT_VIEW, ViewOptions
from navette.errors import NavetteError

if TYPE_CHECKING:
    from navette.navigation.stack import RunOptions

USAGE_ERROR = 2
NO_METHODS = MethodOptions()
RECORDING = "Recording"
MAPS = "Maps"

World = Annotated[
    str,
    Argument(
        metavar="[WORLD]",
        help="A built-in world (arena, empty, …) or a file: .sdf, .world, .xml (MJCF),"
        " .urdf, or a ROS map .yaml; or a generated one, as rooms:3 (barn-like, forest,"
        " rooms, office, maze, dynabarn-like).",
        complete=complete_worlds,
    ),
]
Robot = Annotated[
    str | None,
    Option(
        metavar="NAME|PATH",
        help="A built-in robot (jackal, turtlebot3_burger, husky, racecar, mecanum,"
        " course) or a model file. Default: the robot of the world.",
        complete=complete_robots,
    ),
]
Sensors = Annotated[
    list[str] | None,
    Option(
        "--sensor",
        metavar="TYPE[@PLACE]",
        help="Mount a sensor on the robot: d435 (depth camera), vlp16, os1_32 (3D"
        " lidars), urg04lx, hc_sr04 (sonar), bumper, neo_m8n, zed_f9p (GNSS), at"
        " front, rear, left, right or top. Repeat for several.",
        complete=complete_sensors,
    ),
]
Start = Annotated[
    tuple[float, float, float] | None,
    Option(metavar="X Y YAW_DEG", help="Start pose of the robot."),
]
Goals = Annotated[
    list[str] | None,
    Option(metavar="X Y", help="Goal in metres. Repeat for several goals, in order."),
]
Headless = Annotated[
    bool,
    Option("--headless", help="Run without the live view; exit after the last goal."),
]
Speed = Annotated[
    str | None,
    Option(
        metavar="FACTOR|max",
        help="Simulated seconds per second. Default: 1 with the live view, max when"
        " headless.",
    ),
]
Seed = Annotated[
    int,
    Option(metavar="N", help="Seed of all noise. The same seed gives the same run."),
]
Record = Annotated[
    Path | None,
    Option(
        metavar="FILE.mcap",
        help="Record all topics except raw images to a file.",
        panel=RECORDING,
    ),
]
RecordImages = Annotated[
    bool,
    Option("--record-images", help="Also record raw images.", panel=RECORDING),
]
Overwrite = Annotated[
    bool,
    Option(
        "--overwrite",
        help="Replace an existing recording of that name.",
        panel=RECORDING,
    ),
]
ParamsFile = Annotated[
    list[Path] | None,
    Option(
        metavar="FILE",
        help="ROS 2 parameter file. Repeat for several; later files win.",
    ),
]
Tree = Annotated[
    Path | None,
    Option(
        metavar="FILE.xml",
        help="Behaviour tree that drives to a goal, in the XML of BehaviorTree.CPP and"
        " Nav2. Default: Navette's own (navette tree --default).",
    ),
]
Map = Annotated[
    Path | None,
    Option(
        "--map",
        metavar="FILE.yaml",
        help="Plan on this known map, in ROS's format; what the sensors see changes it."
        " Default: the world is unknown.",
        panel=MAPS,
    ),
]
Keepout = Annotated[
    Path | None,
    Option(
        metavar="FILE.yaml",
        help="Keep out of the occupied cells of this mask, in ROS's map format.",
        panel=MAPS,
    ),
]
SpeedZones = Annotated[
    Path | None,
    Option(
        metavar="FILE.yaml",
        help="Slow down in the dark cells of this mask, in ROS's map format (mode:"
        " scale): black means 1 %, white full speed.",
        panel=MAPS,
    ),
]
MaxTime = Annotated[
    float | None, Option(metavar="S", help="Stop after this simulated time.")
]
Json = Annotated[
    bool, Option("--json", help="Print a summary of the run as JSON on stdout.")
]


@click.group(
    "navette",
    cls=LazyGroup,
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.version_option(
    __version__, message="navette %(version)s", help="Print the version and exit."
)
def app(
    domain_id: Annotated[
        int | None,
        Option(
            min=0,
            max=232,
            metavar="N",
            help="Domain instead of ROS_DOMAIN_ID.",
            variable="ROS_DOMAIN_ID",
        ),
    ] = None,
    run: Annotated[
        str | None,
        Option(
            metavar="NAME",
            help="Use this running robot (navette ps lists them); default: the only"
            " one. With demo, sim and explore: name of the new run. shared: the network"
            " of all programs instead. Can also follow the verb.",
            complete=complete_runs,
        ),
    ] = None,
) -> None:
    """Robot navigation you pip install: simulate, map, plan, drive, watch."""
    if domain_id is not None:
        os.environ["ROS_DOMAIN_ID"] = str(domain_id)
    if run is not None:
        os.environ["NAVETTE_RUN"] = run


@app.command(panel=DRIVE, imports_in_call=True)
def demo(
    robot: Robot = None,
    sensor: Sensors = None,
    methods: MethodOptions = NO_METHODS,
    tree: Tree = None,
    view: ViewOptions = DEFAULT_VIEW,
    speed: Speed = None,
    max_time: MaxTime = None,
) -> None:
    """Run the demo: a robot explores an unknown arena; watch it in the live view.

    The robot drives to a few goals, then waits for goals from the live view. It locates
    itself by noisy wheels, an IMU and SLAM (--localization truth: by the simulator's
    pose). Press Ctrl-C to stop.
    """
    from navette.navigation.stack import RunOptions, demo_goals

    options = RunOptions(
        world="arena",
        robot=robot,
        sensors=tuple(sensor or ()),
        goals=demo_goals(),
        tree=tree,
        speed=parse_speed(speed or "1"),
        max_time_s=max_time,
        verb="demo",
    )
    methods = methods.with_localization("slam")
    _run(methods.applied_to(view.applied_to(options)), as_json=False)


@app.command(panel=DRIVE, imports_in_call=True)
def sim(
    world: World = "arena",
    robot: Robot = None,
    sensor: Sensors = None,
    start: Start = None,
    goal: Goals = None,
    headless: Headless = False,
    speed: Speed = None,
    seed: Seed = 0,
    record: Record = None,
    record_images: RecordImages = False,
    overwrite: Overwrite = False,
    params: ParamsFile = None,
    methods: MethodOptions = NO_METHODS,
    tree: Tree = None,
    known_map: Map = None,
    keepout: Keepout = None,
    speed_zones: SpeedZones = None,
    max_time: MaxTime = None,
    as_json: Json = False,
    view: ViewOptions = DEFAULT_VIEW,
) -> None:
    """Simulate a robot in WORLD and drive it to goals.

    With --headless and goals: runs as fast as possible, drives to the goals in order
    and exits with 0 only if all goals were reached without contact.
    """
    from navette.navigation.stack import RunOptions

    options = RunOptions(
        world=world,
        robot=robot,
        sensors=tuple(sensor or ()),
        start=start_pose(start),
        goals=tuple(parse_goal(text) for text in goal or ()),
        headless=headless,
        speed=parse_speed(speed or ("max" if headless and goal else "1")),
        seed=seed,
        record=record,
        record_images=record_images,
        overwrite=overwrite,
        params_files=tuple(params or ()),
        tree=tree,
        known_map=known_map,
        keepout=keepout,
        speed_zones=speed_zones,
        max_time_s=max_time,
    )
    _run(methods.applied_to(view.applied_to(options)), as_json=as_json)


def _run(options: "RunOptions", *, as_json: bool) -> None:
    from navette.cli.running import run_simulation

    raise click.exceptions.Exit(run_simulation(options, as_json=as_json))


for _verb in VERBS:
    app.add_command(_verb)


def main() -> None:
    """Entry point of the ``navette`` command."""
    if is_completing():
        discard_stderr()
    prepare()
    try:
        with reporting_failed_writes():
            app.main(args=_arguments(sys.argv[1:]), prog_name="navette")
    except NavetteError as error:
        print_error(str(error))
        raise SystemExit(USAGE_ERROR) from None
    except SystemExit as end:
        end_with(end.code)
        raise


def _arguments(words: list[str]) -> list[str]:
    """Return the words of the command line as click expects them."""
    run, arguments = split_run(words)
    if arguments[:1] != ["run"]:
        arguments = without_daemon(fill_values(join_pairs(arguments)))
    return [*run, *arguments]
