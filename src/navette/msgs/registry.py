"""Where interface definitions are found, by name.

Packages come with Navette (``definitions/``) or are added by :func:`load_interfaces`.
A file is read when its type is first asked for.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError, InvalidNameError, UnknownNameError
from navette.msgs.interface import MessageSpec, Spec
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

_folders: dict[str, Path] = {}
_specs: dict[str, Spec] = {}


def packages() -> list[str]:
    """Names of all packages that are known, sorted."""
    built_in = (path.name for path in DEFINITIONS.iterdir() if path.is_dir())
    return sorted({*built_in, *_folders})


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
    if len(parts) == 2 and all(parts):
        return f"{parts[0]}/msg/{parts[1]}"
    if len(parts) == 3 and parts[1] in KINDS and all(parts):
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
    _specs[spec.name] = spec
    if not isinstance(spec, MessageSpec):
        for part in spec.parts():
            _specs[part.name] = part
    for service in (
        getattr(spec, "send_goal", None),
        getattr(spec, "get_result", None),
    ):
        if service is not None:
            _specs[service.name] = service


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
    _refuse_changed(specs, files)
    known_before = package in _folders
    _folders[package] = folder
    added = [spec for spec in specs if spec.name not in _specs]
    for spec in added:
        add_spec(spec)
    try:
        for spec, path in zip(specs, files, strict=True):
            _check_references(spec, path)
    except FileFormatError:
        _forget(package, added, keep_folder=known_before)
        raise
    return sorted(spec.name for spec in specs)


def messages_of(spec: Spec) -> Iterator[MessageSpec]:
    """The message itself, or the messages of a service or action."""
    if isinstance(spec, MessageSpec):
        yield spec
    else:
        yield from spec.parts()


def _folder_of(package: str) -> Path:
    folder = _folders.get(package, DEFINITIONS / package)
    if not PACKAGE_NAME.fullmatch(package) or not folder.is_dir():
        raise UnknownNameError.of("interface package", package, packages())
    return folder


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


def _refuse_changed(specs: list[Spec], files: list[Path]) -> None:
    for spec, path in zip(specs, files, strict=True):
        if _specs.get(spec.name, spec) != spec:
            raise FileFormatError(
                path, f"{spec.name} was loaded before with another definition"
            )


def _check_references(spec: Spec, path: Path) -> None:
    for message in messages_of(spec):
        for field in message.fields:
            if not field.type.is_message:
                continue
            try:
                get_message_spec(field.type.base)
                _refuse_cycle(field.type.base, (message.name,))
            except UnknownNameError as error:
                reason = f"field {field.name!r}: {error}"
                raise FileFormatError(path, reason) from error


def _refuse_cycle(name: str, above: tuple[str, ...]) -> None:
    if name in above:
        raise UnknownNameError(f"{name} contains itself: {' → '.join((*above, name))}")
    for field in get_message_spec(name).fields:
        if field.type.is_message:
            _refuse_cycle(field.type.base, (*above, name))


def _forget(package: str, specs: list[Spec], *, keep_folder: bool) -> None:
    for spec in specs:
        for part in messages_of(spec):
            _specs.pop(part.name, None)
        _specs.pop(spec.name, None)
    if not keep_folder:
        _folders.pop(package, None)
