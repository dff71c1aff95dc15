"""``navette bag replay``: feed recorded inputs to nodes, as fast as possible."""

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import click

from navette.cli.bag.replay_options import ReplayOptions

if TYPE_CHECKING:
    from navette.bags import BagReader
    from navette.bags.compare import Comparison, Tolerances
    from navette.navigation.stack.programs import MakeNode
    from navette.navigation.stack.replay import Replay, ReplaySummary
    from navette.navigation.stack.scene import ResolvedScene
    from navette.runtime import Node

FAILED = 1


def replay(options: ReplayOptions) -> None:
    """Feed recorded inputs to nodes in lock-step, faster than real time.

    Topics that the nodes publish are not read from the recording. The replay is
    deterministic: repeated replays write identical files.
    """
    from navette.bags import open_bag
    from navette.bags.compare import Tolerances
    from navette.cli.bag.replay_report import as_document, report
    from navette.cli.output import show_json

    output, golden = options.output, options.output.golden
    tolerances = Tolerances.parse(output.tolerance or ())
    comparison: Comparison | None = None
    with ExitStack() as stack:
        record = output.record
        if golden is not None and record is None:
            record = Path(stack.enter_context(TemporaryDirectory())) / "replay.mcap"
        _check_record(record, options.inputs.file, golden)
        source = stack.enter_context(open_bag(options.inputs.file))
        replayed = _replay(source, options, record)
        stack.callback(replayed.close)
        summary = replayed.run()
        if golden is not None and record is not None:
            comparison = _compare(replayed, summary, options, record, tolerances)
    if options.as_json:
        show_json(as_document(summary, comparison, output.record))
    else:
        report(summary, comparison, output.record)
    raise click.exceptions.Exit(0 if comparison is None or comparison.same else FAILED)


def _replay(
    source: "BagReader", options: ReplayOptions, record: Path | None
) -> "Replay":
    from navette.bags.play import PlayOptions
    from navette.navigation.stack.replay import Replay

    inputs, nodes = options.inputs, options.nodes
    resolved = _robot(nodes.world, nodes.robot)
    return Replay(
        source,
        [_maker(name) for name in nodes.nodes],
        record=record,
        overwrite=options.output.overwrite,
        robot=resolved,
        arguments=_arguments(
            nodes.parameters or [],
            nodes.params_files or [],
            resolved.remappings if resolved else [],
        ),
        also=inputs.inputs or (),
        options=PlayOptions(
            start_offset_s=inputs.start_offset, duration_s=inputs.duration
        ),
    )


def _compare(
    replayed: "Replay",
    summary: "ReplaySummary",
    options: ReplayOptions,
    record: Path,
    tolerances: "Tolerances",
) -> "Comparison":
    from navette.bags import open_bag
    from navette.bags.compare import compare

    # Nodes that report who publishes a topic name the player.
    tolerances.stand_in = replayed.player.get_fully_qualified_name()
    golden = options.output.golden
    assert golden is not None, "called to compare"
    with open_bag(golden) as expected, open_bag(record) as got:
        return compare(
            expected,
            got,
            topics=summary.outputs,
            shared=[t.name for t in expected.topics if replayed.shares(t)],
            tolerances=tolerances,
            time_tolerance_ns=round(options.output.time_tolerance * 1e9),
            start_ns=replayed.begin_ns,
            # The source may lack later messages with the last stamp.
            end_ns=replayed.end_ns - golden.samefile(options.inputs.file),
        )


def _maker(name: str) -> "MakeNode":
    """Return the constructor of a stage, or of a class given by its location."""
    if ":" not in name:
        from navette.navigation.stack.stage_classes import node_class

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
