"""Load a class or function by its place, and check it against a protocol."""

import importlib
import inspect
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

from navette.errors import InvalidValueError, UnknownNameError
from navette.params.plugins.parameters import params_of, values_of

FORMS = "FILE.py:NAME or MODULE:NAME"

Protocols = Mapping[str, tuple[str, ...]]
"""Name of a method → names of its arguments; a function has that of its
name, otherwise the first."""


Target = Callable[..., Any]
"""The class or function of a method."""


@dataclass(frozen=True)
class Method:
    """A chosen method: a class, or a function.

    Attributes:
        name: as chosen.
        entry: name of the method of the protocol that it has.
        is_own: whether it is not one of Navette's.
    """

    name: str
    target: Target
    entry: str
    is_own: bool

    @property
    def params_class(self) -> type[Any] | None:
        """The dataclass of its parameters; None = it has none."""
        return params_of(self.target)

    def make(self, params: Any) -> Any:
        """Return an object with the method, from an object with its parameters.

        Raises:
            InvalidValueError: the class cannot be made.
        """
        if not inspect.isclass(self.target):
            return SimpleNamespace(**{self.entry: self.target})
        kind = self.params_class
        make: Callable[..., Any] = self.target
        try:
            if kind is None:
                return make()
            if kind is self.target:
                return make(**values_of(kind, params))
            if isinstance(params, kind):
                return make(params)
            return make(kind(**values_of(kind, params)))
        except TypeError as error:
            expected = "()" if kind is None else "(params)"
            raise InvalidValueError(
                f"{describe(self.name, self.target)}: cannot be made with {expected}: "
                f"{error}; parameters are the fields of a dataclass: make the class "
                "one with @dataclass, or define a dataclass Params in it"
            ) from error


def load_method(place: str, protocols: Protocols, kind: str) -> Method:
    """Return the method at ``FILE.py:NAME``, ``MODULE:NAME`` or ``FILE.py``.

    ``FILE.py`` alone is enough if one class or function in it has the protocol.

    Raises:
        UnknownNameError: no such file, module or name; lists what there is.
        InvalidValueError: it cannot be imported, or does not have the protocol.
    """
    alone = place.endswith(".py")
    try:
        found = load_module(place) if alone else load_attribute(place)
    except (InvalidValueError, UnknownNameError) as error:
        raise type(error)(f"{kind} {place}: {error}") from error
    if alone:
        found = _only_method(place, found, protocols, kind)
    return checked_method(place, found, protocols, kind)


def checked_method(name: str, target: Any, protocols: Protocols, kind: str) -> Method:
    """Return the method if it has one of the protocols.

    Raises:
        InvalidValueError: names the file, the line, and what is missing or wrong.
    """
    if inspect.isclass(target):
        entry = next((each for each in protocols if hasattr(target, each)), None)
        if entry is None:
            raise InvalidValueError(
                f"{kind} {describe(name, target)} has no method "
                f"{_signatures(protocols)}; it has: {_listed(_methods(target))}"
            )
        arguments = ("self", *protocols[entry])
        problem = _call_problem(getattr(target, entry), entry, arguments)
    elif callable(target):
        name_of = getattr(target, "__name__", name)
        entry = name_of if name_of in protocols else next(iter(protocols))
        problem = _call_problem(target, name_of, protocols[entry])
    else:
        raise InvalidValueError(
            f"{kind} {describe(name, target)} is of type {type(target).__name__}; "
            f"expected a class with {_signatures(protocols)}, or a function with these "
            "arguments"
        )
    if problem is not None:
        raise InvalidValueError(f"{kind} {describe(name, target)}: {problem}")
    return Method(name, target, entry, is_own=True)


def load_attribute(place: str) -> Any:
    """Return what ``FILE.py:NAME`` or ``MODULE:NAME`` names.

    Raises:
        InvalidValueError: another form, or the module raised while it was imported.
        UnknownNameError: no such file, module or name.
    """
    source, colon, name = place.rpartition(":")
    if not (colon and source and name.isidentifier()):
        raise InvalidValueError(f"{place!r}: expected {FORMS}")
    module = load_module(source)
    if not hasattr(module, name):
        own = [each for each, _ in _defined_in(module)]
        raise UnknownNameError.of(f"name in {source}", name, own)
    return getattr(module, name)


def load_module(source: str) -> ModuleType:
    """Import ``FILE.py`` or a module; a file is loaded once.

    Raises:
        UnknownNameError: no such file or module.
        InvalidValueError: it raised; the text has its error and its line.
    """
    if source.endswith(".py"):
        path = Path(source).expanduser()
        if not path.is_file():
            raise UnknownNameError(f"{source}: no such file in {Path.cwd()}")
        return _load_file(path.resolve())
    put_on_path(Path.cwd())
    try:
        return importlib.import_module(source)
    except ModuleNotFoundError as error:
        if error.name is None or not f"{source}.".startswith(f"{error.name}."):
            raise _failed(source, error) from error
        raise UnknownNameError(
            f"module {source!r} is not installed and not in {Path.cwd()}"
        ) from None
    except Exception as error:  # the module's own code may raise anything
        raise _failed(source, error) from error


def describe(name: str, target: Any) -> str:
    """Return the name with the file and line of the class or function."""
    try:
        file = inspect.getsourcefile(target)
        line = inspect.getsourcelines(target)[1]
    except (TypeError, OSError):
        return name
    return f"{name} ({file}:{line})"


def _load_file(path: Path) -> ModuleType:
    """Import a file under a name that no other file of the same stem has."""
    name = f"{path.stem}_{sha256(str(path).encode()).hexdigest()[:8]}"
    if name in sys.modules:
        return sys.modules[name]
    spec = spec_from_file_location(name, path)
    assert spec is not None, "the path is that of a .py file"
    assert spec.loader is not None, "a .py file has a loader"
    put_on_path(path.parent)
    module = sys.modules[name] = module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # the file's own code may raise anything
        del sys.modules[name]
        raise _failed(str(path), error) from error
    return module


def _failed(source: str, error: Exception) -> InvalidValueError:
    line = ""
    if isinstance(error, SyntaxError):
        line = f" (line {error.lineno})"
    elif error.__traceback__ is not None:
        trace = inspect.getinnerframes(error.__traceback__)
        own = [each for each in trace if Path(each.filename) == Path(source)]
        line = f" (line {own[-1].lineno})" if own else ""
    kind = type(error).__name__
    return InvalidValueError(f"{source}: cannot be imported: {kind}{line}: {error}")


def put_on_path(folder: Path) -> None:
    """Let modules of a folder be imported."""
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))


def _only_method(
    source: str, module: ModuleType, protocols: Protocols, kind: str
) -> Any:
    names = {*protocols}
    found = [
        (name, each)
        for name, each in _defined_in(module)
        if (inspect.isclass(each) and names & {*_methods(each)})
        or (not inspect.isclass(each) and name in names)
    ]
    if len(found) == 1:
        return found[0][1]
    own = [name for name, _ in found] or [name for name, _ in _defined_in(module)]
    wanted = "several" if found else "no"
    raise InvalidValueError(
        f"{kind} {source}: {wanted} classes with {_signatures(protocols)}; name one as "
        f"{source}:NAME; there are: {_listed(own)}"
    )


def _defined_in(module: ModuleType) -> list[tuple[str, Any]]:
    return [
        (name, value)
        for name, value in vars(module).items()
        if not name.startswith("_")
        and (inspect.isclass(value) or inspect.isfunction(value))
        and value.__module__ == module.__name__
    ]


def _methods(target: type) -> list[str]:
    return [
        name
        for name in dir(target)
        if not name.startswith("_") and callable(getattr(target, name))
    ]


def _call_problem(function: Any, name: str, arguments: tuple[str, ...]) -> str | None:
    """Return why a function does not take the arguments; None if it does."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # built in: it has none
        return None
    try:
        signature.bind(*arguments)
    except TypeError as error:
        shown = [each for each in arguments if each != "self"]
        call = f"{name}({', '.join(shown)})"
        return f"{name}{signature} cannot be called as {call}: {error}"
    return None


def _signatures(protocols: Protocols) -> str:
    return " or ".join(f"{name}({', '.join(a)})" for name, a in protocols.items())


def _listed(names: list[str]) -> str:
    return ", ".join(names) or "none"
