"""From package and executable to what can be run."""

from pathlib import Path

from navette.ros2.packages.launch.running import PythonProgram
from navette.ros2.workspace import find_package


def find_program(package: str, name: str) -> PythonProgram | Path:
    """A Python program, or the path of any other executable.

    Raises:
        UnknownNameError: no such package or executable; lists those known.
    """
    found = find_package(package)
    executable = found.executable(name)
    if executable.path is None:
        folder = found.python_path
        return PythonProgram(
            module=executable.module,
            function=executable.attribute,
            search=() if folder is None else (folder,),
        )
    return program_of(executable.path)


def program_of(path: Path) -> PythonProgram | Path:
    """A file as Python program if it is one."""
    if path.suffix == ".py":
        return PythonProgram(file=path)
    with path.open("rb") as file:
        first = file.readline(200)
    if first.startswith(b"#!") and b"python" in first:
        return PythonProgram(file=path)
    return path
