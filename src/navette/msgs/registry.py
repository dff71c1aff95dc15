"""Registry of interface definitions, by name.

Packages are part of Navette, found on the search path, or added by
:func:`load_interfaces`. A file is read on the first use of its type.

Navette's definitions are those of ROS 2 Jazzy (``definitions/``). ``distributions/``
contains the types that differ in other distributions; ``NAVETTE_DISTRO`` chooses one.
"""

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from navette.errors import FileFormatError, InvalidNameError, UnknownNameError
from navette.msgs.interface import ActionSpec, MessageSpec, Spec
from navette.msgs.parser import (
    INTERFACE_NAME,
    PACKAGE_NAME,
    PARSERS,
)

DEFINITIONS = Path(__file__).parent / "definitions"
KINDS = ("msg", "srv", "action")
_DISTRIBUTIONS = Path(__file__).parent / "distributions"
DISTRO_VARIABLE = "NAVETTE_DISTRO"
DEFAULT_DISTRO = "jazzy"
# Rolling's definitions are Lyrical's, until they differ.
_FOLDERS_OF_DISTROS = {
    "humble": "humble",
    "jazzy": "",
    "kilted": "kilted",
    "lyrical": "lyrical",
    "rolling": "lyrical",
}
DISTROS = tuple(_FOLDERS_OF_DISTROS)

# A list of folders of packages, as PATH is one of programs, for processes that do not
# call add_interface_path.
PATH_VARIABLE = "NAVETTE_INTERFACE_PATH"

_folders: dict[str, Path] = {}
_search_path: list[Path] = []
_specs: dict[str, Spec] = {}


def distro() -> str:
    """Return the distribution of ROS 2 whose definitions are used.

    Raises:
        UnknownNameError: ``NAVETTE_DISTRO`` is not a known distribution.
    """
    name = os.environ.get(DISTRO_VARIABLE) or DEFAULT_DISTRO
    if name not in DISTROS:
        raise UnknownNameError.of(DISTRO_VARIABLE, name, list(DISTROS))
    return name


def packages() -> list[str]:
    """Return the names of all packages, sorted."""
    built_in = (path.name for path in DEFINITIONS.iterdir() if path.is_dir())
    searched = (name for root in _roots() for name in _found_packages(root))
    return sorted({*built_in, *_folders, *searched})


def interface_names(package: str, kind: str) -> list[str]:
    """Return the names of a package's ``msg``, ``srv`` or ``action`` types, sorted.

    Raises:
        UnknownNameError: no such package.
    """
    return sorted(
        {
            path.stem
            for folder in _folders_of(package)
            for path in (folder / kind).glob(f"*.{kind}")
        }
    )


def full_name(name: str) -> str:
    """Expand ``pkg/Name`` to ``pkg/msg/Name``; full names are returned unchanged.

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
        f"interface name {name!r}: expected 'package/msg/Name' (or srv, action)"
    )


def get_spec(name: str) -> Spec:
    """Return the definition of an interface or a part (``pkg/srv/Name_Request``).

    Raises:
        InvalidNameError: the name has the wrong form.
        UnknownNameError: no such interface; lists those of the package.
        FileFormatError: a syntax error in its file; names file and line.
    """
    name = full_name(name)
    if name not in _specs:
        _load(name)
    return _specs[name]


def get_message_spec(name: str) -> MessageSpec:
    """Return the definition of a message; raises as :func:`get_spec`."""
    spec = get_spec(name)
    if not isinstance(spec, MessageSpec):
        raise InvalidNameError(f"{name} is a service or an action, expected a message")
    return spec


def _add_spec(spec: Spec) -> None:
    """Register a definition under its own name and those of its parts."""
    for part in _parts_of(spec):
        _specs[part.name] = part


def load_interfaces(package: str, folder: Path | str) -> list[str]:
    """Register the ``.msg``, ``.srv`` and ``.action`` files of a package.

    ``folder`` contains ``msg/``, ``srv/`` or ``action/``. All files are read at once,
    so that errors are raised here. They replace Navette's definitions of these types.
    Returns the full names, sorted.

    Raises:
        InvalidNameError: not a package name.
        FileFormatError: no definitions in the folder, a syntax error, or a reference
            to an unknown type.
    """
    folder = Path(folder)
    if not PACKAGE_NAME.fullmatch(package):
        raise InvalidNameError(
            f"package name {package!r}: expected a lower-case letter, then "
            "lower-case letters, digits and single underscores"
        )
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


def prefer_interfaces(package: str, folder: Path | str) -> None:
    """Use the definitions of a folder for the types that it has, read on first use.

    A workspace's copy of a package that is part of Navette.
    """
    _folders.setdefault(package, Path(folder))


def add_specs(specs: Sequence[Spec], sources: Sequence[Path | str]) -> None:
    """Register definitions: all, or none if one is invalid.

    Raises:
        FileFormatError: a definition is registered with other content, refers to an
            unknown type, or contains itself; names its source.
    """
    for spec, source in zip(specs, sources, strict=True):
        if _specs.get(spec.name, spec) != spec:
            raise FileFormatError(
                source, f"{spec.name} is already registered with another definition"
            )
    added = [spec for spec in specs if spec.name not in _specs]
    for spec in added:
        _add_spec(spec)
    try:
        for spec, source in zip(specs, sources, strict=True):
            _check_references(spec, source)
    except FileFormatError:
        _forget(added)
        raise


def add_interface_path(folder: Path | str) -> None:
    """Search for packages in ``folder/<package>/{msg,srv,action}``, too.

    The environment variable ``NAVETTE_INTERFACE_PATH`` adds such folders as well. The
    packages of Navette come first, then folders in the order in which they were added;
    those of the variable precede Navette's.

    Raises:
        FileFormatError: no such folder.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise FileFormatError(folder, "no such folder; cannot search interfaces in it")
    if folder not in _search_path:
        _search_path.append(folder)


def _folders_of(package: str) -> list[Path]:
    """Return the folders with definitions of a package; the first with a type decides.

    Raises:
        UnknownNameError: no such package.
    """
    own = [_folders[package]] if package in _folders else []
    if PACKAGE_NAME.fullmatch(package):
        if (DEFINITIONS / package).is_dir():
            named = [root / package for root in _named_roots()]
            of_distro = _FOLDERS_OF_DISTROS[distro()]
            changed = _DISTRIBUTIONS / of_distro / package if of_distro else None
            folders = [*own, *named, changed, DEFINITIONS / package]
            return [each for each in folders if each is not None and each.is_dir()]
        for root in [] if own else _roots():
            if _found_packages(root, package):
                load_interfaces(package, root / package)
                return [_folders[package]]
    if own:
        return own
    raise UnknownNameError.of("interface package", package, packages())


def _roots() -> list[Path]:
    return [*_search_path, *_named_roots()]


def _named_roots() -> list[Path]:
    """Return the folders of the variable: of packages, or a package's own."""
    variable = os.environ.get(PATH_VARIABLE, "")
    named = [Path(each) for each in variable.split(os.pathsep) if each]
    return [each.parent if _is_package(each) else each for each in named]


def _is_package(folder: Path) -> bool:
    return any((folder / kind).is_dir() for kind in KINDS)


def _found_packages(root: Path, pattern: str = "*") -> set[str]:
    return {
        folder.parent.name
        for kind in KINDS
        for folder in root.glob(f"{pattern}/{kind}")
        if folder.is_dir() and PACKAGE_NAME.fullmatch(folder.parent.name)
    }


def definition_file(name: str) -> Path | None:
    """Return the file that defines a type, or of which the type is a part.

    Raises:
        UnknownNameError: no such package.
    """
    package, kind, rest = name.split("/")
    stem = rest if kind == "msg" else rest.partition("_")[0]
    if not INTERFACE_NAME.fullmatch(stem):
        return None
    paths = (folder / kind / f"{stem}.{kind}" for folder in _folders_of(package))
    return next(filter(Path.is_file, paths), None)


def _load(name: str) -> None:
    package, kind, _ = name.split("/")
    path = definition_file(name)
    if path is not None:
        _add_spec(_parse_file(package, path))
    if name not in _specs:
        known = [f"{package}/{kind}/{each}" for each in interface_names(package, kind)]
        raise UnknownNameError.of("interface", name, known)


def _parse_file(package: str, path: Path) -> Spec:
    kind = path.suffix[1:]
    if not INTERFACE_NAME.fullmatch(path.stem):
        raise FileFormatError(path, "the file name is not a CamelCase type name")
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise FileFormatError(path, f"not UTF-8: {error}") from None
    return PARSERS[kind](f"{package}/{kind}/{path.stem}", text, path)


def _definition_files(folder: Path) -> list[Path]:
    files = [
        path for kind in KINDS for path in sorted((folder / kind).glob(f"*.{kind}"))
    ]
    if not files:
        raise FileFormatError(
            folder, "no interface definitions; expected msg/*.msg, srv/*.srv, …"
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
    """The definition and its parts."""
    yield spec
    if isinstance(spec, ActionSpec):
        yield from (spec.send_goal, spec.get_result)
    if not isinstance(spec, MessageSpec):
        yield from spec.parts()


def _forget(specs: Sequence[Spec]) -> None:
    for spec in specs:
        for part in _parts_of(spec):
            _specs.pop(part.name, None)
