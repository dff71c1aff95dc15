"""ROS 2's interface for tags and substitutions of other packages, and its parser."""

import inspect
from collections.abc import Callable
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any, TextIO, TypeVar

from navette.errors import FileFormatError, InvalidValueError
from navette.ros2.packages.launch.errors import InvalidLaunchFileError
from navette.ros2.packages.launch.frontend.element import Element
from navette.ros2.packages.launch.frontend.grammar import (
    SUBSTITUTIONS,
    parse_if_substitutions,
    parse_substitution,
)
from navette.ros2.packages.launch.frontend.parser import (
    ACTIONS,
    FORMATS,
    parse_element,
    parse_root,
)
from navette.ros2.packages.launch.launch_description import LaunchDescription
from navette.ros2.packages.launch.launch_description_entity import (
    LaunchDescriptionEntity,
)
from navette.ros2.packages.launch.substitution import Parts

_GROUP = "launch.frontend.launch_extension"
_MOST_ARGUMENTS = 99
_ExposedT = TypeVar("_ExposedT", bound=Callable[..., Any])
_Exposing = Callable[[_ExposedT], _ExposedT]
_exposed: dict[tuple[str, str], Callable[..., Any]] = {}


def expose_action(name: str) -> _Exposing[Any]:
    """Register a class or function for a tag.

    A class has a classmethod ``parse(entity, parser)``; a function has these
    parameters. Both return the class of the action and its keyword arguments.

    Raises:
        RuntimeError: neither of the two, or the tag is registered already.
    """

    def expose(exposed: Any) -> Any:
        parse = _parse_method(exposed, "action", name)

        def make(element: Element) -> LaunchDescriptionEntity:
            kind, kwargs = parse(element, Parser())
            entity: LaunchDescriptionEntity = kind(**kwargs)
            return entity

        ACTIONS[name] = make
        return exposed

    return expose


def expose_substitution(name: str) -> _Exposing[Any]:
    """Register a class or function for ``$(name …)``.

    A class has a classmethod ``parse(data)``; a function has this parameter, the
    arguments. Both return the class of the substitution and its keyword arguments.

    Raises:
        RuntimeError: neither of the two, or the name is registered already.
    """

    def expose(exposed: Any) -> Any:
        parse = _parse_method(exposed, "substitution", name)

        def make(arguments: list[Parts]) -> Any:
            kind, kwargs = parse(arguments)
            return kind(**kwargs)

        SUBSTITUTIONS[name] = (0, _MOST_ARGUMENTS, make)
        return exposed

    return expose


def _parse_method(exposed: Any, kind: str, name: str) -> Callable[..., Any]:
    found: Any = exposed if inspect.isfunction(exposed) else None
    if inspect.isclass(exposed):
        found = getattr(exposed, "parse", None)
        if not inspect.ismethod(found):
            raise RuntimeError(
                "Did not find a class method called 'parse' in the class being "
                f"decorated: {exposed.__name__}"
            )
    if found is None:
        raise RuntimeError(
            f"Exposed {kind} parser for {name} is not a callable or a class "
            "containing a parse method"
        )
    if _exposed.setdefault((kind, name), found) != found:
        raise RuntimeError(
            f"Two {kind} parsing methods exposed with the same name: [{name}]."
        )
    return found  # type: ignore[no-any-return]


class Parser:
    """ROS 2's parser of launch files; it reads XML and YAML."""

    @classmethod
    def load(cls, file: str | Path | TextIO) -> tuple[Element, "Parser"]:
        """Return the outermost element of a file, and the parser of its tags.

        Raises:
            InvalidLaunchFileError: the file has none of the formats.
        """
        load_launch_extensions()
        if isinstance(file, (str, Path)):
            path = Path(file)
            text = path.read_text("utf-8")
        else:
            path, text = Path(getattr(file, "name", "") or "launch"), file.read()
        readers = [FORMATS[path.suffix]] if path.suffix in FORMATS else []
        readers += [reader for reader in FORMATS.values() if reader not in readers]
        problems: list[Exception] = []
        for reader in dict.fromkeys(readers):
            try:
                return reader(text.encode(), path), cls()
            except FileFormatError as error:
                problems.append(error)
        raise InvalidLaunchFileError(extension=path.suffix, likely_errors=problems)

    def parse_description(self, entity: Element) -> LaunchDescription:
        """Return the description of the outermost element."""
        return parse_root(entity)

    def parse_action(self, entity: Element) -> LaunchDescriptionEntity:
        """Return the action of an element."""
        return parse_element(entity)

    def parse_substitution(self, value: str) -> Parts:
        """Return the substitutions of a text."""
        return parse_substitution(value)

    def parse_if_substitutions(self, value: Any) -> Any:
        """Return a value whose texts with ``$(…)`` are substitutions."""
        return parse_if_substitutions(value)

    def escape_characters(self, value: str) -> str:
        """Return a text without the backslashes that escape characters."""
        return parse_substitution(value.replace("$(", "\\$(")).perform(None)  # type: ignore[arg-type] # text needs no context

    @classmethod
    def get_available_extensions(cls) -> list[str]:
        """Return the formats."""
        return ["xml", "yaml"]

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the endings of files, without a dot."""
        return {ending.removeprefix(".") for ending in FORMATS}

    get_file_extensions_from_parsers = get_file_extensions

    @classmethod
    def may_parse(cls, filename: str) -> bool:
        """Return whether a file's name has one of the endings."""
        return Path(filename).suffix in FORMATS

    is_filename_valid = may_parse

    @classmethod
    def is_extension_valid(cls, extension: str) -> bool:
        """Return whether a format is known."""
        return extension in cls.get_available_extensions()

    @classmethod
    def get_parsers_from_filename(cls, filename: str) -> list[type["Parser"]]:
        """Return the parser, if it reads files of that name."""
        return [cls] if cls.may_parse(filename) else []


def load_launch_extensions() -> None:
    """Import what installed packages register for launch files.

    Raises:
        InvalidValueError: a package's extension cannot be imported; names it.
    """
    for entry_point in entry_points(group=_GROUP):
        if entry_point.module.split(".")[0] in ("launch", "launch_ros"):
            continue  # ROS 2's own, whose tags Navette has
        try:
            entry_point.load()
        except ImportError as error:
            raise InvalidValueError(
                f"extension of launch files {entry_point.value!r}: {error}"
            ) from error
