"""Accuracy and time of SLAM on recorded drives with reference poses.

  python benchmarks/bench_slam.py FOLDER [-p NAME:=VALUE …]

FOLDER holds recordings, each with its reference beside it: ``drive`` or ``drive.mcap``
and ``drive.reference.tum`` (lines of time, x, y, z, qx, qy, qz, qw). Prints the error
of the trajectory after alignment, the error from scan to scan, and the time as
a share of the recording. Exits with 1 if an error exceeds 0.1 m or a share 1/20.
"""

import argparse
import sys
import time
from pathlib import Path

import numpy as np

from navette.bags import open_bag
from navette.geometry import Pose2, angle_difference
from navette.navigation.slam import Slam, SlamParams
from navette.navigation.stack.recorded_scans import RecordedScans, ScanSource
from navette.runtime.arguments import parse_parameter_argument

ERROR_M, SHARE = 0.10, 1 / 20


def read_reference(path: Path) -> dict[int, Pose2]:
    """Return pose by stamp, µs."""
    lines = np.loadtxt(path)
    return {
        round(t * 1e6): Pose2(x, y, 2 * np.arctan2(z, w))
        for t, x, y, z, w in lines[:, [0, 1, 2, 6, 7]]
    }


def absolute_errors(poses: list[Pose2], truths: list[Pose2]) -> np.ndarray:
    """Return distances (N,) after the best rigid alignment (Umeyama 1991)."""
    a, b = (np.array([each[:2] for each in side]) for side in (poses, truths))
    u, _, v = np.linalg.svd((a - a.mean(axis=0)).T @ (b - b.mean(axis=0)))
    rotation = u @ np.diag([1.0, np.sign(np.linalg.det(u @ v))]) @ v
    return np.linalg.norm((a - a.mean(axis=0)) @ rotation + b.mean(axis=0) - b, axis=1)


def relative_errors(poses: list[Pose2], truths: list[Pose2]) -> np.ndarray:
    """Return (N − 1, 2) errors of the motion between scans, m and rad."""
    rows = []
    for k in range(len(poses) - 1):
        made = poses[k].inverse() @ poses[k + 1]
        true = truths[k].inverse() @ truths[k + 1]
        turn = abs(angle_difference(made.yaw, true.yaw))
        rows.append((made.distance_to(true), turn))
    return np.array(rows)


def run(bag: Path, params: SlamParams) -> tuple[list[tuple[int, Pose2]], float, float]:
    """Return the trajectory, the wall time (s) and the processor time (s)."""
    wall, cpu = time.perf_counter(), time.process_time()
    slam = Slam(params)
    with open_bag(bag) as reader:
        for each in RecordedScans(reader, ScanSource()):
            slam.add(
                each.stamp_ns,
                each.scan,
                each.odom_T_base,
                base_T_sensor=each.base_T_sensor,
            )
    slam.refine()
    slam.occupancy()
    return slam.trajectory(), time.perf_counter() - wall, time.process_time() - cpu


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("-p", action="append", default=[], metavar="NAME:=VALUE")
    given = parser.parse_args()
    values = [parse_parameter_argument(text) for text in given.p]
    params = SlamParams.from_dict({name: value for _, name, value in values})
    failed = False
    for file in sorted(given.folder.glob("*.reference.tum")):
        name = file.name.removesuffix(".reference.tum")
        bag = next(
            each for each in (file.with_name(name), file.with_name(f"{name}.mcap"))
            if each.exists()
        )  # fmt: skip
        reference = read_reference(file)
        poses, wall_s, cpu_s = run(bag, params)
        pairs = [(pose, reference.get(round(t / 1e3))) for t, pose in poses]
        made = [pose for pose, true in pairs if true is not None]
        truths = [true for _, true in pairs if true is not None]
        absolute = absolute_errors(made, truths)
        relative = relative_errors(made, truths)
        recorded_s = (poses[-1][0] - poses[0][0]) / 1e9
        rmse = float(np.sqrt((absolute**2).mean()))
        is_good = rmse <= ERROR_M and wall_s <= SHARE * recorded_s
        failed |= not is_good
        print(
            f"{name:24} {len(poses):6} scans  ATE {rmse:.3f} m, worst "
            f"{absolute.max():.3f} m  RPE {np.median(relative[:, 0]):.3f} m, "
            f"{np.degrees(np.median(relative[:, 1])):.2f} deg  {wall_s:.1f} s "
            f"(processor {cpu_s:.1f} s), 1/{recorded_s / wall_s:.0f}"
            f"{'' if is_good else '  FAILED'}",
            flush=True,
        )
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
