"""Run the test suites of ROS 2's Python packages, unmodified, on Navette.

    python tests/conformance/upstream.py FOLDER… [--suite NAME] [--failures FILE]

Each FOLDER is a checkout (branch jazzy) of ros2/launch, ros2/launch_ros,
ros2/message_filters, ros2/rosidl_runtime_py, ros2/rcl_interfaces (which has values of
messages for the former) or ros2/demos (whose nodes launch_ros starts). Needs
``pip install '.[test]' setuptools osrf-pycommon``. Prints a line for each suite: tests
that pass, tests that fail for a reason listed in ``upstream_failures.toml``, and
others. Exits with 1 where a test fails without a listed reason, or passes although it
is listed. None of the suites is part of this repository.
"""

# ruff: noqa: T201 - it prints a report

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

REASONS = Path(__file__).with_name("upstream_failures.toml")
#: Suite → its folder below a checkout. The linters' own tests are left out.
SUITES = {
    "launch": "launch/test/launch",
    "launch_xml": "launch_xml/test/launch_xml",
    "launch_yaml": "launch_yaml/test/launch_yaml",
    "launch_testing": "launch_testing/test/launch_testing",
    "launch_pytest": "launch_pytest/test/launch_pytest",
    "launch_ros": "test_launch_ros/test/test_launch_ros",
    "launch_testing_ros": "launch_testing_ros/test/examples",
    "message_filters": "test",
    "rosidl_runtime_py": "test/rosidl_runtime_py",
}
#: In a checkout of ros2/rcl_interfaces: values of messages, for rosidl_runtime_py.
_FIXTURES = Path("test_msgs/src")
#: Python packages in place of C++ packages whose components and nodes the tests start.
STAND_INS = Path(__file__).with_name("stand_ins")
#: Prints the data files that setup.py gives.
_DATA_FILES = """
import json, runpy, setuptools, distutils.core
def setup(**given):
    print(json.dumps(given.get("data_files", [])))
setuptools.setup = distutils.core.setup = setup
runpy.run_path("setup.py", run_name="__main__")
"""
_LAUNCH_TEST = """#!/bin/sh
exec {python} -m navette run launch_testing.launch_test:main "$@"
"""
LINTERS = ("copyright", "flake8", "pep257", "mypy", "xmllint")
#: Seconds a test may take, and a suite.
TEST_TIMEOUT_S, SUITE_TIMEOUT_S = 60, 900


@dataclass
class Outcome:
    """Tests of a suite by what happened."""

    passed: list[str] = field(default_factory=list)
    failed: dict[str, str] = field(default_factory=dict)

    @property
    def total(self) -> int:
        return len(self.passed) + len(self.failed)


def install(folders: list[Path], prefix: Path) -> None:
    """Copy the data files of the folders' Python packages as a build would.

    The suites use programs and examples in the share and lib folders of packages.
    """
    for script in (path for each in folders for path in each.glob("**/setup.py")):
        manifest = script.with_name("package.xml")
        if "ament_python" not in manifest.read_text(encoding="utf-8"):
            continue  # built by CMake: its setup.py is for catkin
        done = subprocess.run(
            [sys.executable, "-c", _DATA_FILES],
            cwd=script.parent,
            capture_output=True,
            text=True,
            check=True,
        )
        for target, files in json.loads(done.stdout):
            folder = prefix / target
            folder.mkdir(parents=True, exist_ok=True)
            for file in map(script.parent.joinpath, files):
                if file.is_file():
                    shutil.copy(file, folder)
    command = prefix / "bin" / "launch_test"
    command.parent.mkdir()
    command.write_text(_LAUNCH_TEST.format(python=sys.executable))
    command.chmod(0o755)


def find_suites(folders: list[Path]) -> dict[str, Path]:
    """Return the suites in the checkouts, by name."""
    found = {}
    for folder in folders:
        for name, below in SUITES.items():
            if (folder / below).is_dir() and _contains(folder, name):
                found[name] = folder / below
    return found


def _contains(folder: Path, package: str) -> bool:
    """Whether a checkout is a package or holds it in a folder of its name."""
    manifest = folder / "package.xml"
    if not manifest.is_file():
        return (folder / package).is_dir()
    return ElementTree.parse(manifest).findtext("name") == package


def run_suite(
    name: str, folder: Path, search: list[Path], packages: list[Path]
) -> Outcome:
    """Run the tests of one folder in a pytest of their own.

    Args:
        search: folders of modules that the tests import.
        packages: folders of packages that the tests launch.
    """
    with tempfile.TemporaryDirectory(prefix="navette_upstream_") as scratch:
        report, prefix = Path(scratch) / "report.xml", Path(scratch) / "install"
        install(packages, prefix)
        # launch_ros starts nodes of packages; launch_testing needs installed files.
        sources = [STAND_INS, *packages] if name == "launch_ros" else []
        found = (each / "pytest.ini" for each in folder.parents)
        settings = next(filter(Path.is_file, found), Path(os.devnull))
        command = [
            *(sys.executable, "-m", "pytest", f"--junitxml={report}"),
            *("-p", "no:cacheprovider", "-p", "no:xdist", "-c", str(settings)),
            *("-q", "--tb=short", f"--confcutdir={folder.parent}"),
            *("--continue-on-collection-errors", f"--timeout={TEST_TIMEOUT_S}"),
            f"--rootdir={folder}",
            *(f"--ignore-glob={folder}/*test_{linter}.py" for linter in LINTERS),
            f"--ignore-glob={folder}/*.launch.py",  # data; --doctest-modules takes them
            str(folder),  # behind the options: --launch-args takes the words after it
        ]
        done = subprocess.run(
            command,
            cwd=scratch,
            env=os.environ
            | {
                # Also for the pytest processes that the tests start.
                "PYTEST_PLUGINS": "navette.ros2.names.pytest_plugin",
                "PYTHONPATH": os.pathsep.join(
                    map(str, [folder.parent, STAND_INS, *search])
                ),
                "NAVETTE_PATH": os.pathsep.join(map(str, sources)),
                "AMENT_PREFIX_PATH": str(prefix),
                "PATH": f"{prefix / 'bin'}{os.pathsep}{os.environ['PATH']}",
                "PYTHONDONTWRITEBYTECODE": "1",
                "ROS_LOG_DIR": scratch,
                # The tests' nodes and processes meet, and no others.
                "NAVETTE_TRANSPORT": "zenoh",
                "ROS_DOMAIN_ID": str(100 + os.getpid() % 100),
                "NAVETTE_RUNTIME_DIR": scratch,
            },
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=SUITE_TIMEOUT_S,
            check=False,
        )
        if not report.exists():  # pytest refused its arguments
            sys.exit(f"{name}: {done.stdout[-2000:]}")
        return _read_report(report)


def _read_report(report: Path) -> Outcome:
    outcome = Outcome()
    for case in ElementTree.parse(report).iter("testcase"):
        name = "::".join(filter(None, [case.get("classname"), case.get("name")]))
        problem = next((e for e in case if e.tag in ("failure", "error")), None)
        if problem is not None:
            outcome.failed[name] = f"{problem.get('message')}\n{problem.text}"
        elif case.find("skipped") is None:
            outcome.passed.append(name)
    return outcome


def report_suite(name: str, outcome: Outcome, reasons: dict[str, str]) -> list[str]:
    """Print a suite's line and return what differs from the list of reasons."""
    listed = [test for test in outcome.failed if test in reasons]
    unlisted = [test for test in outcome.failed if test not in reasons]
    repaired = [test for test in outcome.passed if test in reasons]
    share = 100 * len(outcome.passed) / max(outcome.total, 1)
    print(
        f"{name}: {len(outcome.passed)} of {outcome.total} pass ({share:.0f} %), "
        f"{len(listed)} fail for a listed reason, {len(unlisted)} without"
    )
    return [
        *(f"{name}: {test} fails without a listed reason" for test in unlisted),
        *(f"{name}: {test} passes; delete its reason" for test in repaired),
    ]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    parser.add_argument("--suite", choices=SUITES, action="append", metavar="NAME")
    parser.add_argument(
        "--failures", type=Path, metavar="FILE", help="write tracebacks"
    )
    options = parser.parse_args()
    reasons = tomllib.loads(REASONS.read_text(encoding="utf-8"))
    folders = [folder.resolve() for folder in options.folders]
    suites = find_suites(folders)
    if not suites:
        parser.error(f"no suite in {', '.join(map(str, options.folders))}")
    differences, tracebacks = [], []
    extra = [each / _FIXTURES for each in folders]
    for name, folder in suites.items():
        if options.suite and name not in options.suite:
            continue
        found = [each for each in extra if each.is_dir()]
        outcome = run_suite(name, folder, found, folders)
        differences += report_suite(name, outcome, reasons.get(name, {}))
        tracebacks += [f"=== {test}\n{text}" for test, text in outcome.failed.items()]
    if options.failures:
        options.failures.write_text("\n".join(tracebacks), encoding="utf-8")
    print(*differences, sep="\n")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
