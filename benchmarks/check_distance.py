"""The distance of a real drive (KITTI odometry), from bags of three formats.

    python benchmarks/check_distance.py FOLDER

FOLDER holds ``NN_poses.txt`` (3 × 4 row by row, camera axes) and ``NN_times.txt``.
Prints the distance of odom_integrator by position and by velocity, played once, twice,
at another rate, and after seeks; exits with 1 if a value is off by more than 0.1 % (1 %
by velocity).
"""

import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from distance_drive import length, played_distance, write_drive

FORMATS = ("drive.bag", "drive.mcap", "drive.db3")


def read_kitti(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return times (N,) s and east, north, up (N, 3) m; the car starts eastward."""
    (poses,) = sorted(folder.glob("*_poses.txt"))
    camera = np.loadtxt(poses)[:, [3, 7, 11]]  # right, down, ahead
    times = np.loadtxt(poses.with_name(poses.name.replace("poses", "times")))
    return times, np.column_stack([camera[:, 2], -camera[:, 0], -camera[:, 1]])


def main(folder: Path) -> int:
    times, positions = read_kitti(folder)
    way = np.concatenate(
        [[0.0], np.cumsum(np.linalg.norm(np.diff(positions, axis=0), axis=1))]
    )
    total = length(positions)
    print(f"{len(times)} poses, {times[-1]:.1f} s, {total:.3f} m")

    def between(begin_s: float, end_s: float) -> float:
        first, last = np.searchsorted(times, [begin_s, end_s])
        return float(way[min(last, len(way) - 1)] - way[first])

    # A part played twice counts twice, a skipped part does not.
    back = total + between(70.0, 100.0)
    ahead = total - between(100.0, 200.0)
    cases = [
        ("once", total, {}),
        ("at 100 times the rate", total, {"rate": 100.0}),
        ("twice, by looping", 2 * total, {"passes": 2}),
        ("set back from 100 s to 70 s", back, {"seeks": [(100.0, 70.0)]}),
        ("set forward from 100 s to 200 s", ahead, {"seeks": [(100.0, 200.0)]}),
    ]
    failed = 0
    with TemporaryDirectory() as made:
        for name in FORMATS:
            write_drive(Path(made, name), times, positions)
        runs = [(name, "pos", *cases[0]) for name in FORMATS]
        runs += [("drive.mcap", kind, *c) for c in cases[1:] for kind in ("pos", "vel")]
        runs += [(name, "vel", *cases[0]) for name in FORMATS]
        for name, odom_type, text, expected, how in runs:
            started = time.perf_counter()
            metres = played_distance(Path(made, name), odom_type=odom_type, **how)
            seconds = time.perf_counter() - started
            off = metres / expected - 1
            failed += abs(off) > (0.001 if odom_type == "pos" else 0.01)
            print(
                f"{name:10} {odom_type}  {text:32} {metres:10.3f} m  "
                f"wanted {expected:9.3f}  {off:+.4%}  ({seconds:.1f} s)"
            )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
