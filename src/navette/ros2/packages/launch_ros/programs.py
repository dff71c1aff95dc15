"""Programs of packages."""

from pathlib import Path

from navette.ros2.packages.launch.running import PythonProgram
from navette.ros2.workspace import find_package


def find_program(package: str, name: str) -> PythonProgram | Path:
    """Return a Python program, or the path of another executable.

    Raises:
        UnknownNameError: unknown package or executable; lists the known ones.
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
    """Return a Python program for a Python file, else the path."""
    if path.suffix == ".py":
        return PythonProgram(file=path)
    with path.open("rb") as file:
        first = file.readline(200)
    if first.startswith(b"#!") and b"python" in first:
        return PythonProgram(file=path)
    return path
