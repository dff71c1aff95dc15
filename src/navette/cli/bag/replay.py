"""``navette bag replay``: feed recorded inputs to nodes, as fast as possible."""

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Annotated

import click

from navette.cli.options import Argument, Json, Option

if TYPE_CHECKING:
    from navette.bags.compare import Comparison
    from navette.navigation.stack.replay import MakeNode
    from navette.navigation.stack.scene import ResolvedScene
    from navette.runtime import Node

FAILED = 1

File = Annotated[Path, Argument(metavar="FILE", help="Recording of the inputs.")]
Nodes = Annotated[
    list[str],
    Option(
        "--node",
        metavar="NAME",
        help="A stage (costmap, map_memory, planner, control, …), MODULE:Class or"
        " FILE.py:Class. Repeat for several.",
    ),
]
Parameters = Annotated[
    list[str] | None,
    Option("-p", metavar="[NODE:]NAME:=VALUE", help="Set a parameter."),
]
ParamsFiles = Annotated[
    list[Path] | None,
    Option("--params-file", metavar="FILE", help="ROS 2 parameter file."),
]
World = Annotated[
    str | None,
    Option(help="World of the recording, for the parameters of its robot."),
]
Robot = Annotated[str | None, Option(help="Robot whose parameters the stages use.")]
Record = Annotated[
    Path | None,
    Option(metavar="OUT.mcap", help="Record the output of the nodes to a new file."),
]
Overwrite = Annotated[
    bool, Option("--overwrite", help="Replace an existing recording of that name.")
]
Golden = Annotated[
    Path | None,
    Option(
        "--compare",
        metavar="GOLDEN",
        help="Compare the output of the nodes with this recording, which can be FILE;"
        " exit code 1 if it differs.",
    ),
]
Tolerance = Annotated[
    list[str] | None,
    Option(
        metavar="[TOPIC[.FIELD]=]VALUE[:SHARE%]",
        help="Allowed difference of numbers, and share of array elements that may"
        " exceed it. Repeat for several; the last match wins.",
    ),
]
TimeTolerance = Annotated[
    float,
    Option(metavar="S", help="Allowed difference of stamps.", min=0),
]
Inputs = Annotated[
    list[str] | None,
    Option(
        "--input", metavar="TOPIC", help="Feed this topic even if a node publishes it."
    ),
]
Start = Annotated[
    float,
    Option("-s", "--start-offset", metavar="S", help="Skip the first S seconds."),
]
Length = Annotated[
    float | None,
    Option("-u", "--duration", metavar="S", help="Replay S seconds."),
]


def replay(
    file: File,
    nodes: Nodes,
    parameters: Parameters = None,
    params_files: ParamsFiles = None,
    world: World = None,
    robot: Robot = None,
    record: Record = None,
    overwrite: Overwrite = False,
    golden: Golden = None,
    tolerance: Tolerance = None,
    time_tolerance: TimeTolerance = 0.0,
    inputs: Inputs = None,
    start_offset: Start = 0.0,
    duration: Length = None,
    as_json: Json = False,
) -> None:
    """Feed recorded inputs to nodes in lock-step, faster than real time.

    Topics that the nodes publish are not read from the recording. The replay is
    deterministic: repeated replays write identical files.
    """
    from navette.bags import open_bag
    from navette.bags.compare import Tolerances, compare
    from navette.bags.play import PlayOptions
    from navette.cli.bag.replay_report import as_document, report
    from navette.cli.output import show_json
    from navette.navigation.stack.replay import Replay

    tolerances = Tolerances.parse(tolerance or ())
    comparison: Comparison | None = None
    with ExitStack() as stack:
        if golden is not None and record is None:
            record = Path(stack.enter_context(TemporaryDirectory())) / "replay.mcap"
            shown_record = None
        else:
            shown_record = record
        _check_record(record, file, golden)
        source = stack.enter_context(open_bag(file))
        resolved = _robot(world, robot)
        replayed = Replay(
            source,
            [_maker(name) for name in nodes],
            record=record,
            overwrite=overwrite,
            overrides=resolved.override_parameters if resolved else _no_parameters,
            arguments=_arguments(
                parameters or [],
                params_files or [],
                resolved.remappings if resolved else [],
            ),
            also=inputs or (),
            options=PlayOptions(start_offset_s=start_offset, duration_s=duration),
        )
        stack.callback(replayed.close)
        summary = replayed.run()
        if golden is not None and record is not None:
            expected = stack.enter_context(open_bag(golden))
            got = stack.enter_context(open_bag(record))
            comparison = compare(
                expected,
                got,
                topics=summary.outputs,
                tolerances=tolerances,
                time_tolerance_ns=round(time_tolerance * 1e9),
                start_ns=replayed.begin_ns,
                # The source may lack later messages with the last stamp.
                end_ns=replayed.end_ns - golden.samefile(file),
            )
    if as_json:
        show_json(as_document(summary, comparison, shown_record))
    else:
        report(summary, comparison, shown_record)
    raise click.exceptions.Exit(0 if comparison is None or comparison.same else FAILED)


def _maker(name: str) -> "MakeNode":
    """Return the constructor of a stage, or of a class given by its location."""
    if ":" not in name:
        from navette.navigation.stack.stack import node_class

        stage: Callable[..., Node] = node_class(name)
        return lambda context: stage(context=context)
    from navette.ros2.names.node_classes import load_node_class

    kind: Callable[[], Node] = load_node_class(name)
    return lambda context: kind()


def _robot(world: str | None, robot: str | None) -> "ResolvedScene | None":
    """Return the chosen robot, whose parameters and names of topics are used."""
    if world is None and robot is None:
        return None
    from navette.navigation.stack.options import RunOptions
    from navette.navigation.stack.scene import resolve_scene

    options = RunOptions(world=world or "empty", robot=robot)
    return resolve_scene(options)


def _no_parameters(overrides: object) -> None:
    """Use the recorded values."""


def _arguments(
    parameters: list[str], files: list[Path], remappings: list[str]
) -> list[str]:
    words = [word for each in files for word in ("--params-file", str(each))]
    words += [word for each in parameters for word in ("-p", each)]
    words += [word for each in remappings for word in ("-r", each)]
    return ["--ros-args", *words] if words else []


def _check_record(record: Path | None, *read: Path | None) -> None:
    from navette.errors import InvalidValueError

    if record is None or not record.exists():
        return
    if any(
        path is not None and path.exists() and record.samefile(path) for path in read
    ):
        raise InvalidValueError(f"--record {record} would overwrite an input")
