"""Shell completion of installed names and of files."""

from collections.abc import Callable, Iterable
from pathlib import Path

import click


def complete_from(*words: str) -> Callable[[str], list[str]]:
    """Return a completer of fixed words."""
    return lambda incomplete: chosen(incomplete, words)


def complete_types(incomplete: str) -> list[str]:
    """Complete all installed interfaces, as ``pkg/msg/Name``."""
    return _types(incomplete, "msg", "srv", "action")


def complete_messages(incomplete: str) -> list[str]:
    return _types(incomplete, "msg")


def complete_service_types(incomplete: str) -> list[str]:
    return _types(incomplete, "srv")


def complete_action_types(incomplete: str) -> list[str]:
    return _types(incomplete, "action")


def complete_packages(incomplete: str) -> list[str]:
    """Complete packages, installed or in the workspace."""
    from navette.ros2.workspace import find_packages

    return chosen(incomplete, find_packages())


def complete_programs(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete ``navette run``: packages with programs, programs, Python files."""
    from navette.ros2.workspace import find_packages

    before = list(ctx.params.get("words") or ())
    packages = find_packages()
    if len(before) == 1 and before[0] in packages:
        return chosen(incomplete, (e.name for e in packages[before[0]].executables()))
    if before:
        return []
    built_in = packages["navette"].executables() if "navette" in packages else ()
    names = [each.name for each in built_in]
    names += [name for name, each in packages.items() if each.executables()]
    return chosen(incomplete, [*names, *_files_here("*.py")])


def complete_launch_files(ctx: click.Context, incomplete: str) -> list[str]:
    """Complete ``navette launch``: packages, launch files."""
    from navette.ros2.workspace import find_packages

    before = list(ctx.params.get("words") or ())
    packages = find_packages()
    if len(before) == 1 and before[0] in packages:
        folder = packages[before[0]].share / "launch"
        return chosen(incomplete, (path.name for path in folder.glob("*launch*")))
    if before:
        return []
    names = [n for n, p in packages.items() if (p.share / "launch").is_dir()]
    return chosen(incomplete, [*names, *_files_here("*launch*")])


def _files_here(pattern: str) -> list[str]:
    return [path.name for path in Path.cwd().glob(pattern) if path.is_file()]


def complete_worlds(incomplete: str) -> list[str]:
    """Complete built-in worlds and kinds of generated ones."""
    from navette.navigation.worlds.generated import KINDS
    from navette.sim.library import world_names

    return chosen(incomplete, [*world_names(), *(f"{kind}:" for kind in KINDS)])


def complete_robots(incomplete: str) -> list[str]:
    """Complete built-in robots."""
    from navette.sim.library import robot_names

    return chosen(incomplete, robot_names())


def complete_sensors(incomplete: str) -> list[str]:
    """Complete sensors of the catalogue, and where they are mounted."""
    from navette.sim.sensor_catalogue import CATALOGUE, PLACES

    names = [f"{kind}@{place}" for kind in CATALOGUE for place in PLACES]
    return chosen(incomplete, [*CATALOGUE, *(names if "@" in incomplete else ())])


def _types(incomplete: str, *kinds: str) -> list[str]:
    from navette.ros2.packages.rosidl_runtime_py import get_interfaces

    return chosen(
        incomplete,
        (
            f"{package}/{name}"
            for package, names in get_interfaces().items()
            for name in names
            if name.partition("/")[0] in kinds
        ),
    )


def chosen(incomplete: str, names: Iterable[str]) -> list[str]:
    """Return the names with the given prefix, sorted."""
    return sorted({name for name in names if name.startswith(incomplete)})


def complete_runs(incomplete: str) -> list[str]:
    """Complete the name of a private run of this user."""
    from navette.files.runs import live_runs

    return [run.name for run in live_runs() if run.name.startswith(incomplete)]
