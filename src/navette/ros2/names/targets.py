"""Parse the words after ``navette run`` into programs."""

import ast
from collections.abc import Sequence
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path

from navette.errors import InvalidValueError
from navette.ros2.names.program import Program, entry_point, file_entry_point, script
from navette.ros2.workspace import find_package
from navette.ros2.workspace.executables import BUILT_IN, built_in_executables

WITH = "--with"
_FORMS = (
    "FILE.py [ARGS], MODULE:Class [ARGS], FILE.py:Class [ARGS] "
    "or PACKAGE EXECUTABLE [ARGS]"
)


def read_programs(words: Sequence[str]) -> list[Program]:
    """Return the programs, which are separated by ``--with``.

    Raises:
        InvalidValueError: a program is missing or has none of the accepted forms.
        UnknownNameError: the package or executable does not exist; lists the existing
            ones.
    """
    groups: list[list[str]] = [[]]
    for word in words:
        if word == WITH:
            groups.append([])
        else:
            groups[-1].append(word)
    return [_read_program(group) for group in groups]


def _read_program(words: Sequence[str]) -> Program:
    if not words:
        raise InvalidValueError(f"a program is missing; expected {_FORMS}")
    target, arguments = words[0], tuple(words[1:])
    place, colon, attribute = target.rpartition(":")
    if colon and attribute.isidentifier():
        if place.endswith(".py"):
            return file_entry_point(_existing(Path(place)), attribute, arguments)
        return entry_point(place, attribute, arguments)
    if target.endswith(".py") or _names_file(target):
        return script(_existing(Path(target)), arguments)
    if arguments and not arguments[0].startswith("-"):
        return _executable(target, arguments[0], arguments[1:])
    if any(each.name == target for each in built_in_executables(BUILT_IN)):
        return _executable(BUILT_IN, target, arguments)
    hint = f" (./{target} runs the file)" if Path(target).is_file() else ""
    raise InvalidValueError(f"{target!r} is not a program{hint}; expected {_FORMS}")


def _names_file(target: str) -> bool:
    """Whether the target is an existing file with a suffix or a folder in its name.

    A file without either in the working folder does not hide a package or a stage.
    """
    path = Path(target)
    is_explicit = bool(path.suffix) or "/" in target or path.name != target
    return is_explicit and path.is_file()


def _executable(package: str, name: str, arguments: tuple[str, ...]) -> Program:
    """Return a program that a package declares (setup.py, pyproject.toml or CMake)."""
    found = find_package(package)
    executable = found.executable(name)
    if executable.path is None:
        program = entry_point(
            executable.module, executable.attribute, arguments, name=name
        )
        folder = found.python_path
        return program if folder is None else replace(program, path=(folder,))
    with executable.path.open("rb") as file:
        first = file.readline()
    if executable.path.suffix != ".py" and b"python" not in first:
        raise InvalidValueError(f"{executable.path} is not a Python program")
    return script(executable.path, arguments)


def _existing(path: Path) -> Path:
    if not path.is_file():
        raise InvalidValueError(f"{path}: no such file{_near(path)}")
    return path


def _near(path: Path) -> str:
    """Return a hint: the file one folder up or down, or a file of a similar name."""
    folder = path.parent if path.parent.is_dir() else Path()
    for pattern in (path.name, f"*/{path.name}", f"../{path.name}"):
        for found in folder.glob(pattern):
            return f"; there is {found}"
    names = [each.name for each in folder.glob(f"*{path.suffix}")]
    close = get_close_matches(path.name, names, n=1)
    return f"; did you mean {folder / close[0]}?" if close else ""


def uncalled_main(words: Sequence[str]) -> str | None:
    """Return advice for a file that defines ``main()`` and never calls it."""
    path = Path(words[0])
    if path.suffix != ".py" or not path.is_file():
        return None
    try:
        tree = ast.parse(path.read_bytes())
    except (SyntaxError, ValueError):  # the run itself reports it
        return None
    defines = any(
        isinstance(n, ast.FunctionDef) and n.name == "main" for n in tree.body
    )
    plain = [n for n in tree.body if not isinstance(n, (ast.FunctionDef, ast.ClassDef))]
    used = {
        name.id
        for node in plain
        for name in ast.walk(node)
        if isinstance(name, ast.Name)
    }
    if not defines or "main" in used:
        return None
    return (
        f"{path} defines main() but does not call it: navette run {path}:main starts "
        "it, or add: if __name__ == '__main__': main()"
    )


def find_sources(words: Sequence[str]) -> list[Path]:
    """Return the files and folders that contain a program's source.

    These are the package's folder, the script, or the module below the working folder;
    none for an installed module.
    """
    place, colon, attribute = words[0].rpartition(":")
    target = place if colon and attribute.isidentifier() else words[0]
    if _names_file(target):
        return [Path(target)]
    if colon:
        top = Path.cwd() / target.split(".")[0]
        return [path for path in (top, top.with_suffix(".py")) if path.exists()]
    if len(words) < 2 or words[1].startswith("-"):
        return []
    folder = find_package(target).python_path
    return [] if folder is None else [folder]
