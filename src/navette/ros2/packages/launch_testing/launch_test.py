"""The command ``launch_test FILE [name:=value …]``."""

import importlib.util
import sys
from argparse import ArgumentParser
from collections.abc import Sequence
from pathlib import Path

from navette.ros2.packages.launch_testing.loader import (
    FUNCTION,
    LoadTestsFromPythonModule,
)
from navette.ros2.packages.launch_testing.test_runner import LaunchTestRunner


def main(argv: Sequence[str] | None = None) -> int:
    """Run the tests of a file; return 0 if they pass."""
    parser = ArgumentParser(prog="launch_test", description="Test launched processes.")
    parser.add_argument("file", type=Path, help="file with generate_test_description()")
    parser.add_argument("launch_arguments", nargs="*", metavar="name:=value")
    parser.add_argument("-v", "--verbose", action="store_true")
    options = parser.parse_args(argv)
    if not options.file.is_file():
        parser.error(f"{options.file}: no such file")
    spec = importlib.util.spec_from_file_location(options.file.stem, options.file)
    if spec is None or spec.loader is None:
        parser.error(f"{options.file} is not a Python file")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if not hasattr(module, FUNCTION):
        parser.error(f"{options.file} has no {FUNCTION}()")
    runs = LoadTestsFromPythonModule(module, name=options.file.stem)
    runner = LaunchTestRunner(runs, options.launch_arguments, options.verbose)
    runner.validate()
    is_passed = True
    for run, result in runner.run().items():
        for test, trace in [*result.failures, *result.errors]:
            sys.stderr.write(f"{test}\n{trace}\n")
        is_passed &= result.wasSuccessful()
        word = "passed" if result.wasSuccessful() else "FAILED"
        sys.stdout.write(f"{run}: {result.testsRun} tests, {word}\n")
    return 0 if is_passed else 1
