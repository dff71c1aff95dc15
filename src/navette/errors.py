"""Every exception Navette raises on purpose.

NavetteError
├── InvalidValueError (ValueError)      a value is out of range or malformed
│   ├── ParameterError                  a parameter: unknown, mistyped, out of range
│   ├── InvalidNameError                a node, topic or frame name
│   └── MessageError                    a message field: type, range, length
├── UnknownNameError (LookupError)      a type, frame, robot or world not there
├── FileFormatError (ValueError)        a file: carries path and line
├── DecodeError (ValueError)            bytes that are not what they claim to be
├── TransformError                      a transform that cannot be given
├── NetworkError (ConnectionError)      the network cannot be joined or reached
├── LockStepError                   a process of a lock-step is gone or silent
├── MissingPartError (ImportError)      an optional package is not installed
└── CallbackError (RuntimeError)        a callback raised: node, topic, stamp; also of
                                        the original's class
"""

from pathlib import Path
from typing import Any


class NavetteError(Exception):
    """Base of the package; catch this to catch them all."""


class InvalidValueError(NavetteError, ValueError):
    """A value is not allowed; the text names thing, value and what is allowed."""


class ParameterError(InvalidValueError):
    """A parameter is unknown, of the wrong type or out of range."""


class InvalidNameError(InvalidValueError):
    """A node, topic, namespace or frame name breaks the naming rules."""


class MessageError(InvalidValueError, TypeError, AssertionError):
    """A message field got a value of the wrong type, range or length.

    Also a ``TypeError`` and an ``AssertionError``: with rclpy, publishing a message of
    another type raises the one, a field's value of another type the other.
    """


class UnknownNameError(NavetteError, LookupError):
    """Something was asked for by a name that nobody has; the text lists those known."""

    @classmethod
    def of(cls, kind: str, name: str, known: list[str]) -> "UnknownNameError":
        listed = ", ".join(sorted(known)) or "none"
        return cls(f"unknown {kind} {name!r}; known: {listed}")


class FileFormatError(NavetteError, ValueError):
    """A file cannot be read as what it should be."""

    def __init__(self, path: Path | str, reason: str, line: int | None = None) -> None:
        where = f"{path}:{line}" if line is not None else f"{path}"
        super().__init__(f"{where}: {reason}")
        self.path = Path(path)
        self.line = line
        self.reason = reason


class DecodeError(NavetteError, ValueError):
    """Bytes do not decode as the type they are said to be."""


class TransformError(NavetteError):
    """A transform is unknown, not connected or outside the buffered time."""


class NetworkError(NavetteError, ConnectionError):
    """The network cannot be joined, or what was there is gone."""


class LockStepError(NavetteError):
    """A run in lock-step cannot go on: a process is gone, or does not answer."""


class MissingPartError(NavetteError, ImportError):
    """An optional package is not installed; says how to."""


class CallbackError(NavetteError, RuntimeError):
    """A callback raised; the original exception is ``original`` and the ``__cause__``.

    The one that a spin raises is an instance of the original's class as well, and has
    its attributes: around a spin, a program's own ``except ValueError`` catches what
    its callback raised, as it does on ROS 2.
    """

    def __init__(self, node: str, source: str, stamp_ns: int, cause: object) -> None:
        # Not super(): in a joint class that may be one that wants other arguments.
        Exception.__init__(
            self,
            f"node {node}: callback of {source} raised at "
            f"{stamp_ns / 1e9:.3f} s: {type(cause).__name__}: {cause}",
        )
        self.node = node
        self.source = source
        self.stamp_ns = stamp_ns
        self.original = cause

    @classmethod
    def of(
        cls, node: str, source: str, stamp_ns: int, cause: Exception
    ) -> "CallbackError":
        """One that is of the class of ``cause`` too, where Python allows it."""
        error = _blank(_joint_class(type(cause)))
        CallbackError.__init__(error, node, source, stamp_ns, cause)
        return error

    def __str__(self) -> str:
        # Not the original class's: a KeyError would show it in quotes.
        return str(self.args[0])

    def __getattr__(self, name: str) -> Any:
        if name == "original" or name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.original, name)


def _joint_class(kind: type[Exception]) -> type[CallbackError]:
    if issubclass(CallbackError, kind):
        return CallbackError
    try:
        return type(CallbackError.__name__, (CallbackError, kind), {})
    except TypeError:  # it may not be derived from
        return CallbackError


def _blank(kind: type[CallbackError]) -> CallbackError:
    """An instance without ``__init__``: the original's class may want arguments."""
    for base in kind.__mro__:
        if base.__module__ == "builtins":
            make: Any = base.__new__
            try:
                blank: CallbackError = make(kind)
            except TypeError:  # of another layout
                continue
            return blank
    # An exception group wants its parts to be made.
    return CallbackError.__new__(CallbackError)
