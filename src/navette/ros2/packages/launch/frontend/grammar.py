"""Parser of substitutions in text: ``$(name argument …)``.

An argument ends at a space unless it is quoted; it may contain ``$(…)``. A backslash
escapes the next character.
"""

from collections.abc import Callable
from typing import Any

from navette.errors import InvalidValueError
from navette.ros2.packages.launch.substitution import (
    Parts,
    Substitution,
    TextSubstitution,
)
from navette.ros2.packages.launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PythonExpression,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from navette.ros2.packages.launch.utilities.type_utils import (
    is_instance_of_valid_type,
)

MAX_DEPTH = 32
_SPACE = " \t\r\n"

#: Substitution of ROS 1 → what to write instead.
_OF_ROS_1 = {
    "arg": "$(var NAME)",
    "find": "$(find-pkg-share PACKAGE)",
    "optenv": "$(env NAME DEFAULT)",
}

Maker = Callable[[list[Parts]], Substitution]

SUBSTITUTIONS: dict[str, tuple[int, int, Maker]] = {
    "all": (1, 99, lambda a: AllSubstitution(*a)),
    "and": (2, 2, lambda a: AndSubstitution(a[0], a[1])),
    "anon": (1, 1, lambda a: AnonName(a[0])),
    "any": (1, 99, lambda a: AnySubstitution(*a)),
    "command": (
        1,
        2,
        lambda a: Command(a[0], on_stderr=a[1] if len(a) > 1 else "fail"),
    ),
    "dirname": (0, 0, lambda a: ThisLaunchFileDir()),
    "env": (
        1,
        2,
        lambda a: EnvironmentVariable(a[0], default_value=a[1] if a[1:] else None),
    ),
    "equals": (2, 2, lambda a: EqualsSubstitution(a[0], a[1])),
    "eval": (1, 2, lambda a: PythonExpression(*a)),
    "file-content": (1, 1, lambda a: FileContent(a[0])),
    "filename": (0, 0, lambda a: ThisLaunchFile()),
    "find-exec": (1, 1, lambda a: FindExecutable(name=a[0])),
    "if": (2, 3, lambda a: IfElseSubstitution(*a)),
    "launch_log_dir": (0, 0, lambda a: LaunchLogDir()),
    "log_dir": (0, 0, lambda a: LaunchLogDir()),
    "not": (1, 1, lambda a: NotSubstitution(a[0])),
    "not-equals": (2, 2, lambda a: NotEqualsSubstitution(a[0], a[1])),
    "or": (2, 2, lambda a: OrSubstitution(a[0], a[1])),
    "var": (
        1,
        2,
        lambda a: LaunchConfiguration(a[0], default=a[1] if len(a) > 1 else None),
    ),
}
"""Name → minimum and maximum number of arguments, and factory."""


def parse_substitution(text: str) -> Parts:
    """Parse a text into substitutions.

    Raises:
        InvalidValueError: unbalanced brackets, an unknown name, or a wrong number of
            arguments.
    """
    reader = _Reader(text)
    parts = reader.read("")
    assert reader.position == len(text), "no end character was given"
    return parts or Parts([TextSubstitution(text="")])


def split_words(text: str) -> list[str]:
    """Split a command line at spaces, except within ``$(…)`` and quotes."""
    words: list[str] = [""]
    depth, quote = 0, ""
    for position, character in enumerate(text):
        if quote:
            quote = "" if character == quote else quote
        elif character in "'\"":
            quote = character
        elif text.startswith("$(", position):
            depth += 1
        elif character == ")" and depth:
            depth -= 1
        elif character.isspace() and not depth:
            words.append("")
            continue
        words[-1] += character
    return [_unquoted(word) for word in words if word]


def _unquoted(word: str) -> str:
    """Remove the quotes around a word, not those within ``$(…)``."""
    if len(word) > 1 and word[0] == word[-1] and word[0] in "'\"":
        return word[1:-1]
    return word


def parse_if_substitutions(value: Any) -> Any:
    """Return a value whose texts with ``$(…)`` are substitutions.

    Raises:
        ValueError: a list of values of several types.
    """
    if isinstance(value, str):
        parts = parse_substitution(value)
        texts = [part.text for part in parts if isinstance(part, TextSubstitution)]
        return "".join(texts) if len(texts) == len(parts) else parts
    if isinstance(value, (list, tuple)):
        found = [parse_if_substitutions(each) for each in value]
        plain = [each for each in found if not isinstance(each, Parts)]
        if not is_instance_of_valid_type(plain):
            raise ValueError(f"{value!r}: expected values of one type")
        return found
    return value


class _Reader:
    """Recursive descent parser."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.position = 0
        self._depth = 0
        self._is_quoted = False

    def read(self, ends: str) -> Parts:
        """Parse up to, not including, one of the end characters."""
        parts = Parts()
        plain = ""
        while self.position < len(self.text):
            character = self.text[self.position]
            if character in ends:
                break
            if self.text.startswith("$(", self.position):
                if plain:
                    parts.append(TextSubstitution(text=plain))
                plain = ""
                parts.append(self._substitution())
                continue
            if character == "\\" and self._peek(1) in "$'\"\\()" and self._peek(1):
                self.position += 1
                character = self.text[self.position]
            plain += character
            self.position += 1
        if plain:
            parts.append(TextSubstitution(text=plain))
        return parts

    def _peek(self, offset: int) -> str:
        return self.text[self.position + offset : self.position + offset + 1]

    def _substitution(self) -> Substitution:
        start = self.position
        self._depth += 1
        if self._depth > MAX_DEPTH:
            raise InvalidValueError(f"$(…) nested deeper than {MAX_DEPTH}")
        self.position += 2
        name = ""
        while self._peek(0) and self._peek(0) not in _SPACE + ")":
            name += self._peek(0)
            self.position += 1
        arguments = self._arguments(start)
        self._depth -= 1
        return _make(name, arguments, self.text[start : self.position])

    def _arguments(self, start: int) -> list[Parts]:
        """Parse all arguments and the closing bracket."""
        arguments: list[Parts] = []
        while True:
            while self._peek(0) and self._peek(0) in _SPACE:
                self.position += 1
            character = self._peek(0)
            if character == ")":
                self.position += 1
                return arguments
            if not character:
                raise InvalidValueError(
                    f"{self.text[start:]!r}: the closing ')' is missing"
                )
            arguments.append(self._argument(character))

    def _argument(self, character: str) -> Parts:
        # As in ROS 2, quotes within a quoted argument are text.
        if character not in "'\"" or self._is_quoted:
            return self.read(_SPACE + ")")
        self.position += 1
        self._is_quoted = True
        parts = self.read(character)
        self._is_quoted = False
        if self._peek(0) != character:
            raise InvalidValueError(
                f"{self.text!r}: the closing {character} is missing"
            )
        self.position += 1
        return parts or Parts([TextSubstitution(text="")])


def _make(name: str, arguments: list[Parts], text: str) -> Substitution:
    if name in _OF_ROS_1 and name not in SUBSTITUTIONS:
        raise InvalidValueError(
            f"{text!r} belongs to launch files of ROS 1; write {_OF_ROS_1[name]}"
        )
    if name not in SUBSTITUTIONS:
        raise InvalidValueError(
            f"unknown substitution {text!r}; known: {', '.join(sorted(SUBSTITUTIONS))}"
        )
    fewest, most, make = SUBSTITUTIONS[name]
    if name == "eval" and len(arguments) > 1 and not _looks_quoted(text):
        # `$(eval 1 + 1)`: join the words of one expression
        spaced = Parts()
        for argument in arguments:
            spaced += [TextSubstitution(text=" "), *argument] if spaced else argument
        arguments = [spaced]
    if not fewest <= len(arguments) <= most:
        count = str(fewest) if fewest == most else f"{fewest} to {most}"
        raise InvalidValueError(
            f"{text!r}: {len(arguments)} arguments; expected {count} "
            "(quote an argument that has spaces)"
        )
    return make(arguments)


def _looks_quoted(text: str) -> bool:
    return text.removeprefix("$(eval").lstrip()[:1] in ("'", '"')
