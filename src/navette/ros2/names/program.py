"""A program (script, entry point or node class) and its run as ROS 2 executable."""

import importlib
import inspect
import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Any

from navette import runtime
from navette.errors import InvalidValueError
from navette.ros2.names.missing import advice
from navette.ros2.names.tracebacks import shortened

SUCCEEDED = 0
FAILED = 1
INTERRUPTED = 130  # 128 + SIGINT, as a shell reports it


Main = Callable[[], object]
"""The body of a program; what it returns is the exit code, as in ``sys.exit``."""


@dataclass(frozen=True)
class Program:
    """What to run, with its arguments."""

    name: str
    arguments: tuple[str, ...]
    main: Main
    #: Inserted at the front of ``sys.path``, as Python does with a script's folder.
    path: tuple[Path, ...] = ()

    @property
    def argv(self) -> list[str]:
        return [self.name, *self.arguments]


def script(path: Path, arguments: tuple[str, ...] = ()) -> Program:
    """Return the program of a Python file, run as ``__main__``."""
    return Program(
        str(path), arguments, lambda: _run_file(path), search_path(path.resolve())
    )


def entry_point(
    module: str, attribute: str, arguments: tuple[str, ...] = (), *, name: str = ""
) -> Program:
    """Return the program of a function or node class in an importable module.

    The function is called without arguments; a node of the class is created and spun.
    """
    return Program(
        name or f"{module}:{attribute}",
        arguments,
        lambda: _run_attribute(_import(module), attribute),
        (Path.cwd(),),
    )


def file_entry_point(
    path: Path, attribute: str, arguments: tuple[str, ...] = ()
) -> Program:
    """Return the program of a function or node class in a file."""
    return Program(
        f"{path}:{attribute}",
        arguments,
        lambda: _run_attribute(load_file(path, path.stem), attribute),
        search_path(path.resolve()),
    )


def run(program: Program) -> int:
    """Run in this thread and return the exit code that Python would return.

    Print the traceback of an uncaught exception. Shut the context down if the program
    did not.
    """
    try:
        return _exit_code(program.main())
    except SystemExit as stop:
        return _exit_code(stop.code)
    except KeyboardInterrupt:
        return INTERRUPTED
    except BaseException as error:
        _print_traceback(error)
        return FAILED
    finally:
        runtime.try_shutdown()


def _exit_code(value: object) -> int:
    """Return the exit code for an argument of ``sys.exit``; print a text argument."""
    if value is None:
        return SUCCEEDED
    if isinstance(value, int):
        return int(value)
    sys.stderr.write(f"{value}\n")
    return FAILED


def search_path(file: Path) -> tuple[Path, ...]:
    """Return the file's folder and, in a Python package, the folder above it."""
    root = file.parent
    while (root / "__init__.py").is_file():
        root = root.parent
    return (file.parent,) if root == file.parent else (file.parent, root)


def _run_file(path: Path) -> None:
    module = _new_module(path, "__main__")
    if threading.current_thread() is threading.main_thread():
        sys.modules["__main__"] = module  # where pickle looks for its classes
    _execute(path, module)


def _import(name: str) -> ModuleType:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name is None or not f"{name}.".startswith(f"{error.name}."):
            raise  # the module exists; one of its imports is missing
        raise InvalidValueError(
            f"module {name!r} cannot be imported: {error} (searched "
            f"{Path.cwd()}, its workspace and the installed modules)"
        ) from None


def load_file(path: Path, name: str) -> ModuleType:
    module = sys.modules[name] = _new_module(path, name)
    _execute(path, module)
    return module


def _new_module(path: Path, name: str) -> ModuleType:
    module = ModuleType(name)
    module.__file__ = str(path)
    return module


def _execute(path: Path, module: ModuleType) -> None:
    exec(compile(path.read_bytes(), str(path), "exec"), vars(module))


def _run_attribute(module: ModuleType, name: str) -> object:
    value = getattr(module, name, None)
    ros = _ros_of(value)
    if ros is not None:
        _spin(value, ros)
        return None
    if callable(value) and not inspect.isclass(value):
        return value()
    raise InvalidValueError(
        f"{module.__name__}:{name} is not a node class or a function; {_offer(module)}"
    )


def _offer(module: ModuleType) -> str:
    own = [
        name
        for name, value in vars(module).items()
        if getattr(value, "__module__", "") == module.__name__
        and (inspect.isfunction(value) or _ros_of(value) is not None)
    ]
    return f"the module has {', '.join(sorted(own)) or 'neither'}"


def _ros_of(value: Any) -> Any:
    """Return the module with ``init`` and ``spin`` for a node class, else None.

    It is Navette's runtime, or ROS 2's rclpy where the program runs on ROS 2.
    """
    if not inspect.isclass(value):
        return None
    if issubclass(value, runtime.Node):
        return runtime
    real = sys.modules.get("rclpy.node")
    return sys.modules["rclpy"] if real and issubclass(value, real.Node) else None


def _spin(node_class: Any, ros: Any) -> None:
    ros.init()
    node = node_class()
    try:
        ros.spin(node)
    except KeyboardInterrupt:
        pass  # Ctrl-C is the normal end
    finally:
        node.destroy_node()
        ros.try_shutdown()


def _print_traceback(error: BaseException) -> None:
    """Print the traceback without Navette's frames, with advice where there is any."""
    if isinstance(error, ModuleNotFoundError) and error.name is not None:
        note = advice(error.name)
        if note is not None:
            error.add_note(note)
    shown: TracebackType | None = error.__traceback__
    while shown is not None and shown.tb_frame.f_code.co_filename == __file__:
        shown = shown.tb_next
    if shown is None and isinstance(error, InvalidValueError):  # of the command line
        sys.stderr.write(f"navette: {error}\n")
        return
    if shown is None and not isinstance(error, SyntaxError):  # in a script, no frame
        shown = error.__traceback__
    sys.stderr.write("".join(shortened(error, shown).format()))
