"""Options of ``navette bag replay``."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from navette.cli.options import Argument, Json, Option


@dataclass(frozen=True, kw_only=True)
class ReplayInputs:
    """The recorded messages that are fed to the nodes."""

    file: Annotated[Path, Argument(metavar="FILE", help="Recording of the inputs.")]
    inputs: Annotated[
        list[str] | None,
        Option(
            "--input",
            metavar="TOPIC",
            help="Feed this topic even if a node publishes it.",
        ),
    ] = None
    start_offset: Annotated[
        float,
        Option("-s", "--start-offset", metavar="S", help="Skip the first S seconds."),
    ] = 0.0
    duration: Annotated[
        float | None,
        Option("-u", "--duration", metavar="S", help="Replay S seconds."),
    ] = None


@dataclass(frozen=True, kw_only=True)
class ReplayNodes:
    """The nodes, and their parameters."""

    nodes: Annotated[
        list[str],
        Option(
            "--node",
            metavar="NAME",
            help="A stage (costmap, map_memory, planner, control, …), MODULE:Class or"
            " FILE.py:Class. Repeat for several.",
        ),
    ]
    parameters: Annotated[
        list[str] | None,
        Option("-p", metavar="[NODE:]NAME:=VALUE", help="Set a parameter."),
    ] = None
    params_files: Annotated[
        list[Path] | None,
        Option("--params-file", metavar="FILE", help="ROS 2 parameter file."),
    ] = None
    world: Annotated[
        str | None,
        Option(help="World of the recording, for the parameters of its robot."),
    ] = None
    robot: Annotated[
        str | None, Option(help="Robot whose parameters the stages use.")
    ] = None


@dataclass(frozen=True, kw_only=True)
class ReplayOutput:
    """Where the output goes, and what it is compared with."""

    record: Annotated[
        Path | None,
        Option(
            metavar="OUT.mcap", help="Record the output of the nodes to a new file."
        ),
    ] = None
    overwrite: Annotated[
        bool, Option("--overwrite", help="Replace an existing recording of that name.")
    ] = False
    golden: Annotated[
        Path | None,
        Option(
            "--compare",
            metavar="GOLDEN",
            help="Compare the output of the nodes with this recording, which can be"
            " FILE; exit code 1 if it differs.",
        ),
    ] = None
    tolerance: Annotated[
        list[str] | None,
        Option(
            metavar="[TOPIC[.FIELD]=]VALUE[:SHARE%]",
            help="Allowed difference of numbers, and share of array elements that may"
            " exceed it. Repeat for several; the last match wins.",
        ),
    ] = None
    time_tolerance: Annotated[
        float,
        Option(metavar="S", help="Allowed difference of stamps.", min=0),
    ] = 0.0


@dataclass(frozen=True, kw_only=True)
class ReplayOptions:
    """All options of the command."""

    nodes: ReplayNodes
    output: ReplayOutput = field(default_factory=ReplayOutput)
    inputs: ReplayInputs
    as_json: Json = False
