"""Build messages, requests and goals from partial YAML."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from navette.errors import FileFormatError, InvalidValueError

MOST_BYTES = 4 * 1024 * 1024  # of text on standard input


def filled(message_class: Any, text: str) -> Any:
    """Build a message with the fields in ``text``; others keep their defaults.

    Raises:
        InvalidValueError: not a YAML mapping, unknown field, or wrong type of value.
    """
    from navette.ros2.packages.rosidl_runtime_py import set_message_fields

    message = message_class()
    fields = from_yaml(text)
    if fields is not None:
        set_message_fields(message, fields)
    return message


def from_yaml(text: str) -> Any:
    """Parse YAML.

    Raises:
        InvalidValueError: not YAML.
    """
    import yaml

    from navette.files.untrusted.yaml_input import load_yaml, problem_of

    try:
        return load_yaml(text)
    except yaml.YAMLError as error:
        raise InvalidValueError(f"{text!r} is not YAML: {problem_of(error)}") from None


def from_yaml_file(path: Path) -> list[Any]:
    """Parse the YAML documents of a file, separated by ``---``.

    Raises:
        InvalidValueError: the file cannot be read, is not YAML, or is empty.
    """
    import yaml

    from navette.files.untrusted.budget import DOCUMENT
    from navette.files.untrusted.files import read_bounded
    from navette.files.untrusted.yaml_input import load_all_yaml

    try:
        data = read_bounded(path, DOCUMENT)
        documents = [each for each in load_all_yaml(data) if each]
    except FileFormatError as error:
        raise InvalidValueError(str(error)) from None
    except yaml.YAMLError as error:
        raise InvalidValueError(f"{path} is not YAML: {error}") from None
    if not documents:
        raise InvalidValueError(f"{path} contains no messages")
    return documents


def from_stdin() -> str:
    """Read standard input to its end.

    Raises:
        InvalidValueError: the input is too long.
    """
    text = sys.stdin.read(MOST_BYTES + 1)
    if len(text) > MOST_BYTES:
        raise InvalidValueError(f"standard input: more than {MOST_BYTES} characters")
    return text


def is_type_name(text: str, kind: str) -> bool:
    """Whether a word is an interface name: ``pkg/srv/Name`` or ``pkg/Name``."""
    parts = text.split("/")
    if len(parts) == 3 and parts[1] != kind:
        return False
    return len(parts) in (2, 3) and all(part.isidentifier() for part in parts)


def type_and_values(words: Sequence[str], kind: str) -> tuple[str | None, str | None]:
    """Split the arguments ``[TYPE] [YAML]``; both are optional.

    Raises:
        InvalidValueError: too many words.
    """
    rest = list(words)
    type_name = rest.pop(0) if rest and is_type_name(rest[0], kind) else None
    if len(rest) > 1:
        raise InvalidValueError(
            f"{' '.join(words)!r} is not [TYPE] [YAML]; quote the YAML, as in"
            " '{a: 1, b: 2}'"
        )
    return type_name, rest[0] if rest else None
