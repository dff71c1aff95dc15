"""Run every benchmark in its own process, one after the other.

    pip install '.[bench]'
    python benchmarks/run_all.py [--only TEXT] [--page]

Writes ``benchmarks/results.json`` and from it ``docs/performance.md``; ``--page``
writes the page again from the results there are.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from page import performance_page

HERE = Path(__file__).parent
RESULTS = HERE / "results.json"
PAGE = HERE.parent / "docs" / "performance.md"
BENCHMARKS = (
    "planner", "inflation", "scan", "merge", "lidar", "physics",
    "dispatch", "network", "calls", "messages", "recording", "stack", "startup",
    "verbs", "fifty", "gym", "robots", "worlds", "localization", "gap",
)  # fmt: skip
LIBRARIES = (
    "navette", "numpy", "numba", "mujoco-core", "scipy", "opencv-python-headless",
    "scikit-image", "pyastar2d", "eclipse-zenoh", "rosbags", "mcap-ros2-support",
    "ir-sim", "pybullet", "zenoh-ros2-sdk", "gymnasium", "highway-env",
)  # fmt: skip


def machine() -> dict[str, Any]:
    """Return the relevant properties of the machine."""
    return {
        "cores": os.cpu_count(),
        "architecture": platform.machine(),
        "system": platform.system(),
        "python": platform.python_version(),
        "libraries": {name: _version(name) for name in LIBRARIES},
    }


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"


def run(name: str, bytecode: str) -> dict[str, Any]:
    """Run one benchmark in its own process.

    ``bytecode``: folder of the compiled sources, which pip writes for a user.
    """
    command = [sys.executable, str(HERE / f"bench_{name}.py"), "--json"]
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": bytecode}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    done = subprocess.run(
        command, check=True, stdout=subprocess.PIPE, text=True, env=environment
    )
    # Some peers print to stdout: search for the JSON object from the end.
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    found: dict[str, Any] = json.loads(lines[-1])
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="benchmarks whose name has this")
    parser.add_argument("--page", action="store_true", help="write the page only")
    options = parser.parse_args()
    results: dict[str, Any] = {"benchmarks": {}}
    if RESULTS.exists():
        results = json.loads(RESULTS.read_text(encoding="utf-8"))
    if not options.page:
        results["machine"] = machine()
        with tempfile.TemporaryDirectory() as bytecode:
            for name in BENCHMARKS:
                if options.only in name:
                    print(f"{name} …", file=sys.stderr, flush=True)
                    results["benchmarks"][name] = run(name, bytecode)
        ordered = {
            k: results["benchmarks"][k]
            for k in BENCHMARKS
            if k in results["benchmarks"]
        }
        results = {"machine": results["machine"], "benchmarks": ordered}
        text = json.dumps(results, indent=1, ensure_ascii=False)
        RESULTS.write_text(text + "\n", encoding="utf-8")
    PAGE.write_text(performance_page(results), encoding="utf-8")


if __name__ == "__main__":
    main()
