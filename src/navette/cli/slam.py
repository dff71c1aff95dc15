"""``navette slam``: build a map from a recording."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from navette.cli.map_stem import map_stem
from navette.cli.options import Argument, Json, Option
from navette.cli.output import show, show_json
from navette.cli.session import FAILED, fail
from navette.cli.stderr import note, print_error
from navette.errors import FileFormatError, InvalidValueError
from navette.files.writing import writing

if TYPE_CHECKING:
    from navette.geometry import Pose2
    from navette.navigation.slam import Slam, SlamParams
    from navette.navigation.stack.recorded_scans import RecordedScans


@dataclass(frozen=True, kw_only=True)
class SlamInput:
    """The recording and what is read of it."""

    bag: Annotated[
        Path,
        Argument(
            metavar="BAG", help="A .mcap, .bag or .db3 file, or a rosbag2 folder."
        ),
    ]
    scan_topic: Annotated[
        str,
        Option(
            "--scan",
            metavar="TOPIC",
            help="Topic of the laser scans. Default: /scan, /lidar, or the only one.",
        ),
    ] = ""
    odometry: Annotated[
        str,
        Option(
            "--odometry",
            metavar="TOPIC|none",
            help="Topic of the odometry; none: scans only. Default: odom → base_link"
            " of /tf, else a topic.",
        ),
    ] = ""
    known: Annotated[
        Path | None,
        Option(
            "--continue",
            metavar="FILE.slam",
            help="Continue this map, written by --save.",
        ),
    ] = None
    localize: Annotated[
        bool, Option("--localize", help="Localise in --continue; the map stays.")
    ] = False
    start: Annotated[
        str,
        Option(
            metavar="X Y YAW_DEG",
            help="Where in --continue the recording begins, roughly. Default: the whole"
            " map is searched.",
        ),
    ] = ""


@dataclass(frozen=True, kw_only=True)
class SlamOutput:
    """The files to write."""

    map_file: Annotated[
        Path | None,
        Option(
            "--map",
            metavar="OUT",
            help="Write the map as OUT.yaml and OUT.pgm, in ROS's format.",
        ),
    ] = None
    trajectory: Annotated[
        Path | None,
        Option(
            metavar="OUT.tum",
            help="Write the pose at each scan: lines of time, x, y, z, and quaternion.",
        ),
    ] = None
    save: Annotated[
        Path | None,
        Option(
            metavar="OUT.slam",
            help="Write scans and pose graph, for --continue and the node slam.",
        ),
    ] = None
    overwrite: Annotated[
        bool, Option("--overwrite", help="Replace existing files.")
    ] = False


@dataclass(frozen=True, kw_only=True)
class SlamOptions:
    """Options of the verb."""

    source: SlamInput
    output: SlamOutput = field(default_factory=SlamOutput)
    parameters: Annotated[
        list[str] | None, Option("-p", metavar="NAME:=VALUE", help="Set a parameter.")
    ] = None
    params_files: Annotated[
        list[Path] | None,
        Option("--params-file", metavar="FILE", help="ROS 2 parameter file."),
    ] = None
    as_json: Json = False


def slam(options: SlamOptions) -> None:
    """Build a map from a recording: scans and odometry in, map and trajectory out.

    Runs as fast as the machine allows. The same recording gives the same files.
    Damaged parts are left out; the exit code is then 1.
    """
    from navette.bags import open_bag
    from navette.navigation.slam.graph_file import write_graph
    from navette.navigation.stack.recorded_scans import RecordedScans, ScanSource
    from navette.runtime import Stopwatch

    output = options.output
    _check_files(options)
    params = _params(options)
    watch = Stopwatch()
    with open_bag(options.source.bag) as reader:
        source = ScanSource(
            scan_topic=options.source.scan_topic,
            odometry=options.source.odometry,
            odom_frame=params.odom_frame,
            base_frame=params.base_frame,
        )
        damage = list(reader.losses)
        scans = RecordedScans(
            reader, source, on_damage=lambda each: damage.append(str(each))
        )
        run = _slam(options, params)
        used = _add_all(run, scans)
    for problem in damage:
        print_error(f"damaged: {problem}")
    for problem in scans.problems:
        note(f"left out: {problem}")
    if not used:
        fail(f"{options.source.bag}: none of the {scans.count} scans can be used")
    if not run.trajectory():
        fail(
            f"{options.source.known}: no scan of the recording matches this map; give "
            "--start X Y YAW_DEG near the place where the recording begins"
        )
    if run.is_mapping:
        run.refine()
    if output.trajectory is not None:
        with writing(output.trajectory):
            _write_trajectory(output.trajectory, run.trajectory())
    if output.map_file is not None:
        with writing(output.map_file):
            _write_map(output.map_file, run)
    if output.save is not None:
        with writing(output.save):
            write_graph(output.save, run.graph)
    _report(options, scans, run, watch.elapsed_s)
    if damage:
        raise click.exceptions.Exit(FAILED)


def _slam(options: SlamOptions, params: "SlamParams") -> "Slam":
    """Return a SLAM without a map, or with the known one."""
    from navette.geometry import Pose2
    from navette.navigation.slam import Slam
    from navette.navigation.slam.graph_file import read_graph

    source = options.source
    if source.known is None:
        if source.localize or source.start:
            option = "--localize" if source.localize else "--start"
            raise InvalidValueError(f"{option} needs a known map: --continue FILE.slam")
        return Slam(params)
    graph = read_graph(source.known, params)
    start = None
    if source.start:
        try:
            x, y, degrees = map(float, source.start.split())
        except ValueError:
            raise InvalidValueError(
                f"--start {source.start!r}: expected X Y YAW_DEG, such as '1.5 2 90'"
            ) from None
        start = Pose2(x, y, math.radians(degrees))
    return Slam(params, start, graph=graph, is_mapping=not source.localize)


def _check_files(options: SlamOptions) -> None:
    output = options.output
    files = [output.trajectory, _map_file(output.map_file), output.save]
    if not any(files):
        raise InvalidValueError(
            "nothing to write; give --map OUT, --trajectory OUT.tum or --save OUT.slam"
        )
    for each in files:
        if each is None:
            continue
        if each.exists() and not output.overwrite:
            raise FileFormatError(each, "exists already; --overwrite replaces it")
        if not each.parent.is_dir():
            raise InvalidValueError(
                f"{each}: the folder {each.parent} does not exist; create it first"
            )


def _map_file(given: Path | None) -> Path | None:
    if given is None:
        return None
    stem = map_stem(given)
    return stem.with_name(f"{stem.name}.yaml")


def _params(options: SlamOptions) -> "SlamParams":
    from navette.navigation.slam import SlamParams
    from navette.runtime.arguments import parse_parameter_argument
    from navette.runtime.overrides import ParameterOverrides

    overrides = ParameterOverrides()
    overrides.add_arguments(options.params_files or (), "--params-file")
    given = [parse_parameter_argument(text) for text in options.parameters or ()]
    overrides.add_arguments(given, "navette slam")
    values = overrides.for_node("/slam")
    return SlamParams.from_dict({name: each.value for name, each in values.items()})


def _add_all(run: "Slam", scans: "RecordedScans") -> int:
    from navette.cli.bag.progress import progress

    used = 0
    with progress("mapping", scans.count) as advance:
        for each in scans:
            run.add(
                each.stamp_ns,
                each.scan,
                each.odom_T_base,
                base_T_sensor=each.base_T_sensor,
            )
            used += 1
            if advance is not None:
                advance(1)
    return used


def _write_trajectory(path: Path, poses: Iterable[tuple[int, "Pose2"]]) -> None:
    """Write lines of the TUM format: time, s, position, m, and quaternion."""
    from navette.geometry import quaternion_from_yaw

    lines = []
    for stamp_ns, pose in poses:
        _, _, z, w = quaternion_from_yaw(pose.yaw)
        seconds = f"{stamp_ns // 10**9}.{stamp_ns % 10**9:09d}"
        lines.append(f"{seconds} {pose.x:.6f} {pose.y:.6f} 0 0 0 {z:.8f} {w:.8f}\n")
    path.write_text("".join(lines), encoding="utf-8")


def _write_map(path: Path, run: "Slam") -> None:
    from navette.geometry.map_files import OccupancyMap, write_occupancy_map

    cells, spec = run.occupancy()
    occupancy = OccupancyMap(cells, spec.resolution, spec.origin)
    write_occupancy_map(map_stem(path), occupancy)


def _report(
    options: SlamOptions, scans: "RecordedScans", run: "Slam", wall_s: float
) -> None:
    poses = run.trajectory()
    recorded_s = (poses[-1][0] - poses[0][0]) / 1e9
    length = sum(one.distance_to(other) for (_, one), (_, other) in pairwise(poses))
    values: dict[str, Any] = {
        "scan_topic": scans.topic,
        "odometry": scans.odometry,
        "scans": len(poses),
        "skipped": scans.skipped,
        "unmatched": run.unmatched,
        "key_scans": len(run.graph),
        "loop_closures": run.loop_closures,
        "path_m": length,
        "recorded_s": recorded_s,
        "wall_s": wall_s,
        "map": str(_map_file(options.output.map_file) or ""),
        "trajectory": str(options.output.trajectory or ""),
        "saved": str(options.output.save or ""),
    }
    if options.as_json:
        show_json(values)
        return
    show(
        f"{len(poses)} scans of {scans.topic}, odometry: {scans.odometry}; "
        f"{length:.0f} m in {recorded_s:.0f} s"
    )
    show(
        f"{len(run.graph)} key scans, {run.loop_closures} loop closures, "
        f"{run.unmatched} scans without a match"
    )
    for written in (values["map"], values["trajectory"], values["saved"]):
        if written:
            show(f"wrote {written}")
    show(
        f"took {wall_s:.1f} s, 1/{recorded_s / max(wall_s, 1e-3):.0f} of the recording"
    )
