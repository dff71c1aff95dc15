"""Where interface definitions are found, by name.

Packages come with Navette (``definitions/``) or are added by :func:`load_interfaces`.
A file is read when its type is first asked for.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError, InvalidNameError, UnknownNameError
from navette.msgs.interface import ActionSpec, MessageSpec, Spec
from navette.msgs.parser import (
    INTERFACE_NAME,
    PACKAGE_NAME,
    parse_action,
    parse_message,
    parse_service,
)

DEFINITIONS = Path(__file__).parent / "definitions"
KINDS = ("msg", "srv", "action")
_PARSERS: dict[str, Callable[[str, str, Path], Any]] = {
    "msg": parse_message,
    "srv": parse_service,
    "action": parse_action,
}

# Folders of packages, as PATH holds folders of programs; for processes that call no
# add_interface_path of their own.
PATH_VARIABLE = "NAVETTE_INTERFACE_PATH"

_folders: dict[str, Path] = {}
_search_path: list[Path] = []
_specs: dict[str, Spec] = {}


def packages() -> list[str]:
    """Names of all packages that are known, sorted."""
    built_in = (path.name for path in DEFINITIONS.iterdir() if path.is_dir())
    searched = (name for root in _roots() for name in _found_packages(root))
    return sorted({*built_in, *_folders, *searched})


def interface_names(package: str, kind: str) -> list[str]:
    """Names of the interfaces of one kind (``msg``, ``srv``, ``action``), sorted.

    Raises:
        UnknownNameError: no such package.
    """
    folder = _folder_of(package)
    return sorted(path.stem for path in (folder / kind).glob(f"*.{kind}"))


def full_name(name: str) -> str:
    """``pkg/Name`` → ``pkg/msg/Name``; full names stay.

    Raises:
        InvalidNameError: neither of the two forms.
    """
    parts = name.split("/")
    if all(part.isidentifier() for part in parts):
        if len(parts) == 2:
            return f"{parts[0]}/msg/{parts[1]}"
        if len(parts) == 3 and parts[1] in KINDS:
            return name
    raise InvalidNameError(
        f"interface name {name!r}: wanted 'package/msg/Name' (or srv, action)"
    )


def get_spec(name: str) -> Spec:
    """The definition of an interface, or of a part such as ``pkg/srv/Name_Request``.

    Raises:
        InvalidNameError: the name has the wrong form.
        UnknownNameError: nobody defines it; lists what the package has.
        FileFormatError: its file is broken; names file and line.
    """
    name = full_name(name)
    if name not in _specs:
        _load(name)
    return _specs[name]


def get_message_spec(name: str) -> MessageSpec:
    """As :func:`get_spec`, for messages only."""
    spec = get_spec(name)
    if not isinstance(spec, MessageSpec):
        raise InvalidNameError(f"{name} is a service or an action; wanted a message")
    return spec


def add_spec(spec: Spec) -> None:
    """Make a definition known under its own name and those of its parts."""
    for part in _parts_of(spec):
        _specs[part.name] = part


def load_interfaces(package: str, folder: Path | str) -> list[str]:
    """Make the ``.msg``, ``.srv`` and ``.action`` files of a package usable.

    ``folder`` holds ``msg/``, ``srv/``, ``action/`` (any of them). Every file is read
    at once, so that a broken one shows here. Returns the full names, sorted.

    Raises:
        InvalidNameError: not a package name, or one that Navette itself has.
        FileFormatError: no definitions there, a broken one, or one that refers to a
            type nobody defines.
    """
    folder = Path(folder)
    if not PACKAGE_NAME.fullmatch(package):
        raise InvalidNameError(
            f"package name {package!r}: wanted lower case letters, digits and single "
            "underscores, starting with a letter"
        )
    if (DEFINITIONS / package).is_dir():
        raise InvalidNameError(f"package {package!r} is one of Navette's own")
    files = _definition_files(folder)
    specs = [_parse_file(package, path) for path in files]
    known_before = _folders.get(package)
    _folders[package] = folder
    try:
        add_specs(specs, files)
    except FileFormatError:
        del _folders[package]
        if known_before is not None:
            _folders[package] = known_before
        raise
    return sorted(spec.name for spec in specs)


def add_specs(specs: Sequence[Spec], sources: Sequence[Path | str]) -> None:
    """Make definitions known, all of them or, if one is wrong, none.

    Raises:
        FileFormatError: names the source of a definition that was known before with
            other content, refers to a type nobody defines, or contains itself.
    """
    for spec, source in zip(specs, sources, strict=True):
        if _specs.get(spec.name, spec) != spec:
            raise FileFormatError(
                source, f"{spec.name} was loaded before with another definition"
            )
    added = [spec for spec in specs if spec.name not in _specs]
    for spec in added:
        add_spec(spec)
    try:
        for spec, source in zip(specs, sources, strict=True):
            _check_references(spec, source)
    except FileFormatError:
        _forget(added)
        raise


def add_interface_path(folder: Path | str) -> None:
    """Let packages be found as ``folder/<package>/{msg,srv,action}`` when asked for.

    The environment variable ``NAVETTE_INTERFACE_PATH`` adds such folders, too. Own
    packages of Navette come first, then folders in the order they were added.

    Raises:
        FileFormatError: no such folder.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise FileFormatError(folder, "no such folder to search interfaces in")
    if folder not in _search_path:
        _search_path.append(folder)


def _folder_of(package: str) -> Path:
    if package in _folders:
        return _folders[package]
    if PACKAGE_NAME.fullmatch(package):
        if (DEFINITIONS / package).is_dir():
            return DEFINITIONS / package
        for root in _roots():
            if _found_packages(root, package):
                load_interfaces(package, root / package)
                return _folders[package]
    raise UnknownNameError.of("interface package", package, packages())


def _roots() -> list[Path]:
    variable = os.environ.get(PATH_VARIABLE, "")
    named = [Path(each) for each in variable.split(os.pathsep) if each]
    return [*_search_path, *named]


def _found_packages(root: Path, pattern: str = "*") -> set[str]:
    return {
        folder.parent.name
        for kind in KINDS
        for folder in root.glob(f"{pattern}/{kind}")
        if folder.is_dir() and PACKAGE_NAME.fullmatch(folder.parent.name)
    }


def _load(name: str) -> None:
    package, kind, rest = name.split("/")
    folder = _folder_of(package)
    stem = rest if kind == "msg" else rest.partition("_")[0]
    path = folder / kind / f"{stem}.{kind}"
    if INTERFACE_NAME.fullmatch(stem) and path.is_file():
        add_spec(_parse_file(package, path))
    if name not in _specs:
        known = [f"{package}/{kind}/{each}" for each in interface_names(package, kind)]
        raise UnknownNameError.of("interface", name, known)


def _parse_file(package: str, path: Path) -> Spec:
    kind = path.suffix[1:]
    if not INTERFACE_NAME.fullmatch(path.stem):
        raise FileFormatError(path, "the file's name is no type name: wanted CamelCase")
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise FileFormatError(path, f"not UTF-8: {error}") from None
    spec: Spec = _PARSERS[kind](f"{package}/{kind}/{path.stem}", text, path)
    return spec


def _definition_files(folder: Path) -> list[Path]:
    files = [
        path for kind in KINDS for path in sorted((folder / kind).glob(f"*.{kind}"))
    ]
    if not files:
        raise FileFormatError(
            folder, "no interface definitions; wanted msg/*.msg, srv/*.srv, …"
        )
    return files


def _check_references(spec: Spec, source: Path | str) -> None:
    for message in _parts_of(spec):
        for field in getattr(message, "fields", ()):
            if not field.type.is_message:
                continue
            try:
                _refuse_cycle(field.type.base, (message.name,))
            except UnknownNameError as error:
                reason = f"field {field.name!r}: {error}"
                raise FileFormatError(source, reason) from error


def _refuse_cycle(name: str, above: tuple[str, ...]) -> None:
    if name in above:
        raise UnknownNameError(f"{name} contains itself: {' → '.join((*above, name))}")
    for field in get_message_spec(name).fields:
        if field.type.is_message:
            _refuse_cycle(field.type.base, (*above, name))


def _parts_of(spec: Spec) -> Iterator[Spec]:
    """The definition and all that is defined with it."""
    yield spec
    if isinstance(spec, ActionSpec):
        yield from (spec.send_goal, spec.get_result)
    if not isinstance(spec, MessageSpec):
        yield from spec.parts()


def _forget(specs: Sequence[Spec]) -> None:
    for spec in specs:
        for part in _parts_of(spec):
            _specs.pop(part.name, None)
