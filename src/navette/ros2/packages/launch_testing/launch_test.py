"""The command ``launch_test FILE [name:=value …]``."""

import importlib.util
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

from navette.ros2.packages.launch_testing.junitxml import unittestResultsToXml
from navette.ros2.packages.launch_testing.loader import (
    FUNCTION,
    LoadTestsFromPythonModule,
)
from navette.ros2.packages.launch_testing.print_arguments import (
    print_arguments_of_launch_description,
)
from navette.ros2.packages.launch_testing.test_result import FailResult
from navette.ros2.packages.launch_testing.test_runner import LaunchTestRunner


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of ``launch_test``."""
    add = parser.add_argument
    add("launch_test_file", type=Path, help=f"file with {FUNCTION}()")
    add("--package-name", help="package of the test, for reports")
    add("-v", "--verbose", action="store_true", help="print debug messages")
    add("-s", "--show-args", "--show-arguments", action="store_true")
    add("--junit-xml", dest="xmlpath", help="write a JUnit report to this file")
    add("launch_arguments", nargs="*", metavar="name:=value")


def run(
    parser: ArgumentParser,
    args: Namespace,
    test_runner_cls: type[LaunchTestRunner] = LaunchTestRunner,
) -> int:
    """Run the tests of a file; return 0 if they pass."""
    file: Path = Path(args.launch_test_file).absolute()
    if not file.is_file():
        parser.error(f"{args.launch_test_file}: no such file")
    package = args.package_name or file.stem
    module = _load(parser, package, file)
    name = f"{package}.{file.stem}"
    runs = LoadTestsFromPythonModule(module, name=f"{name}.launch_tests")
    runner = test_runner_cls(runs, args.launch_arguments, args.verbose)
    runner.validate()
    if args.show_args:
        description = runs[0].get_launch_description()
        print_arguments_of_launch_description(launch_description=description)
        return 0
    results = runner.run()
    if args.xmlpath:
        report = unittestResultsToXml(test_results=results, name=name)
        report.write(args.xmlpath, encoding="utf-8", xml_declaration=True)
    for each, result in results.items():
        word = "passed" if result.wasSuccessful() else "FAILED"
        sys.stdout.write(f"{each}: {result.testsRun} tests, {word}\n")
        if isinstance(result, FailResult):  # the others have printed theirs
            sys.stderr.write(f"{result.message}\n")
    return 0 if all(result.wasSuccessful() for result in results.values()) else 1


def _load(parser: ArgumentParser, name: str, file: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, file)
    if spec is None or spec.loader is None:
        parser.error(f"{file} is not a Python file")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if not hasattr(module, FUNCTION):
        parser.error(f"{file} has no {FUNCTION}()")
    return module


def main(argv: Sequence[str] | None = None) -> int:
    """Run the tests of the file that the arguments name; return 0 if they pass."""
    parser = ArgumentParser(prog="launch_test", description="Test launched processes.")
    add_arguments(parser)
    return run(parser, parser.parse_args(argv))
