"""Start-up in a new process: imports, the command line, the demo.

The demo is timed until the robot moves (real-time clock, live view on): warm, and on
the very first run with an empty cache: with the kernels of a wheel, which are built
here if the package has none, and compiling them.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import llvmlite.binding as llvm
from harness import Benchmark, Figure, Run

from navette.files.kernel_archive import package_archive
from navette.navigation.stack.kernel_build import build_archive

HERE = Path(__file__).parent
WARM_STARTS = 9
RUN_CLI = "from navette.cli import main; main()"
NAVETTE = (sys.executable, "-c", RUN_CLI)


def process(*command: str, **variables: str) -> str:
    """Run a command to its end; return its output."""
    environment = {**os.environ, **variables}
    done = subprocess.run(
        command, check=True, capture_output=True, text=True, env=environment
    )
    return done.stdout


def python(code: str) -> Run:
    return lambda: process(sys.executable, "-c", code)


def cli(*arguments: str) -> Run:
    return lambda: process(*NAVETTE, *arguments)


def seconds_to_motion(**variables: str) -> float:
    """Return the wall time from process start until the robot moves."""
    start = time.time()
    printed = process(sys.executable, str(HERE / "first_motion.py"), **variables)
    moved_at: float = json.loads(printed.splitlines()[-1])["moved at"]
    return moved_at - start


def warm_run() -> Figure:
    seconds = statistics.median(seconds_to_motion() for _ in range(WARM_STARTS))
    note = f"kernels cached on disk, live view on; median of {WARM_STARTS}"
    return Figure("demo to a moving robot, warm", seconds, "s", 1.5, False, note)


def first_run() -> Figure:
    archive = package_archive()
    if archive is None or not archive.is_complete():
        build_archive()
    with tempfile.TemporaryDirectory() as empty:
        seconds = seconds_to_motion(NUMBA_CACHE_DIR=empty)
    note = "kernels of the wheel, empty cache; one run"
    return Figure(
        "demo to a moving robot, very first run", seconds, "s", 5.0, False, note
    )


def compiling_run() -> Figure:
    # With a processor that the user names, the package's kernels are not used.
    processor = llvm.get_host_cpu_name()
    with tempfile.TemporaryDirectory() as empty:
        seconds = seconds_to_motion(NUMBA_CACHE_DIR=empty, NUMBA_CPU_NAME=processor)
    note = "one process, empty cache; one run"
    return Figure(
        "demo to a moving robot, compiling all kernels",
        seconds,
        "s",
        None,
        False,
        note,
    )


def main() -> None:
    bench = Benchmark("start-up", __doc__)
    alone = python("pass")
    bench.case(
        "import navette",
        {
            "navette": python("import navette"),
            "python alone": alone,
            "import numpy": python("import numpy"),
        },
    )
    bench.case(
        "from navette import Node",
        {"navette": python("from navette import Node"), "python alone": alone},
    )
    bench.case("navette --version", {"navette": cli("--version")}, target_ms=300)
    assert "Usage" in process(*NAVETTE, "--help")
    bench.case("navette --help", {"navette": cli("--help")}, target_ms=300)
    bench.case("navette sim --help", {"navette": cli("sim", "--help")}, target_ms=300)
    bench.figure(warm_run)
    bench.figure(first_run)
    bench.figure(compiling_run)
    bench.main()


if __name__ == "__main__":
    main()
