"""Exceptions of Navette.

NavetteError
├── InvalidValueError (ValueError)      a value is out of range or malformed
│   ├── ParameterError                  a parameter: unknown, mistyped, out of range
│   ├── InvalidNameError                a node, topic or frame name
│   ├── InvalidInputError               a received message: carries the named reason
│   └── MessageError                    a message field: type, range, length
├── UnknownNameError (LookupError)      no such type, frame, robot or world
├── FileFormatError (ValueError)        a malformed file: carries path and line
├── DecodeError (ValueError)            malformed bytes
├── TransformError                      a transform is not available
├── NetworkError (ConnectionError)      the network cannot be joined or reached
├── LockStepError                       a lock-step process is lost or does not respond
├── MissingPartError (ImportError)      an optional package is not installed
└── CallbackError (RuntimeError)        a callback raised: node, topic, stamp; also an
                                        instance of the original class
"""

from collections.abc import Collection, Sequence
from difflib import SequenceMatcher, get_close_matches
from pathlib import Path
from types import MemberDescriptorType
from typing import Any

_FEW = 8  # names that are listed in any case
_MOST_SIMILAR = 3
_RATIO_MARGIN = 0.05  # of SequenceMatcher, below the best ratio


def join_names(names: Sequence[str], most: int) -> str:
    """Join names with commas; of more than ``most``, the rest is a number."""
    if len(names) <= most:
        return ", ".join(names)
    return f"{', '.join(names[:most])} and {len(names) - most} more"


def similar_names(name: str, known: Collection[str]) -> list[str]:
    """Return the known names that are nearly as similar to a name as the best one."""
    close = get_close_matches(name, known, n=_MOST_SIMILAR)
    ratio = {each: SequenceMatcher(None, each, name).ratio() for each in close}
    least = max(ratio.values(), default=0.0) - _RATIO_MARGIN
    return [each for each in close if ratio[each] >= least]


def instead_of(name: str, known: Collection[str], *, see_all: str) -> str:
    """Return the end of a message about an unknown name: which names are known.

    Of many names, only similar ones are listed, and where to see all; if none is
    similar, all are listed.

    Args:
        see_all: a command or place that lists the known names.
    """
    close = similar_names(name, known)
    text = f"; did you mean {' or '.join(map(repr, close))}?" if close else ""
    if close and len(known) > _FEW:
        return f"{text} (all {len(known)}: {see_all})"
    return f"{text}; known: {', '.join(sorted(known)) or 'none'}"


class NavetteError(Exception):
    """Base class of all exceptions of Navette."""


class InvalidValueError(NavetteError, ValueError):
    """A value is out of range or malformed; names the value and what is allowed."""


class ParameterError(InvalidValueError):
    """A parameter is unknown, of the wrong type or out of range."""


class InvalidNameError(InvalidValueError):
    """A node, topic, namespace or frame name breaks the naming rules."""


class InvalidInputError(InvalidValueError):
    """A received message or request cannot be used.

    Raised in a callback of a stage's input, it drops the message: the stage logs the
    reason once, counts it in ``/diagnostics`` and continues.

    Args:
        reason: name of the kind of fault, such as ``not_finite``; the names of the
            stages' own checks are in the reference, "Dropped inputs".
        detail: field, value, and what is allowed.
    """

    def __init__(self, reason: str, detail: str) -> None:
        super().__init__(f"{reason}: {detail}")
        self.reason = reason
        self.detail = detail


class MessageError(InvalidValueError, TypeError, AssertionError):
    """A message field was assigned a value of the wrong type, range or length.

    Also a ``TypeError`` and an ``AssertionError``: rclpy raises the former for
    publishing a message of another type, the latter for a field value of another type.
    """


class UnknownNameError(NavetteError, LookupError):
    """Unknown name; the message lists the known names."""

    @classmethod
    def of(cls, kind: str, name: str, known: list[str]) -> "UnknownNameError":
        names = join_names(sorted(known), most=200) or "none"
        return cls(f"unknown {kind} {name!r}; known: {names}")


class FileFormatError(NavetteError, ValueError):
    """A file does not have the expected format."""

    def __init__(self, path: Path | str, reason: str, line: int | None = None) -> None:
        where = f"{path}:{line}" if line is not None else f"{path}"
        super().__init__(f"{where}: {reason}")
        self.path = Path(path)
        self.line = line
        self.reason = reason


class DecodeError(NavetteError, ValueError, RuntimeError):
    """Bytes cannot be decoded as the given type."""


class TransformError(NavetteError):
    """A transform is unknown, disconnected or outside the buffered time."""


class NetworkError(NavetteError, ConnectionError):
    """The network cannot be joined, or a connection was lost."""


class LockStepError(NavetteError):
    """A lock-step run cannot continue: a process is lost or does not respond."""


class MissingPartError(NavetteError, ImportError):
    """An optional package is not installed; the message names the command."""

    @classmethod
    def of(cls, use: str, package: str, extra: str) -> "MissingPartError":
        """Return the error of a use that needs a package, which an extra installs."""
        return cls(
            f"{use} requires {package}: pip install {package} (with Navette from its "
            f"source: pip install '.[{extra}]')"
        )


class CallbackError(NavetteError, RuntimeError):
    """A callback raised; the original exception is ``original`` and ``__cause__``.

    The error that a spin raises is also an instance of the original class, with its
    attributes and ``args``: ``except ValueError`` around a spin catches a callback's
    ValueError, as in ROS 2. Its text adds the node, the callback and the time.
    """

    def __init__(self, node: str, source: str, stamp_ns: int, cause: object) -> None:
        self._text = (
            f"node {node}: callback of {source} raised at "
            f"{stamp_ns / 1e9:.3f} s: {type(cause).__name__}: {cause}"
        )
        # Not super(): the next class of a joint class may take other arguments.
        Exception.__init__(self, *getattr(cause, "args", (self._text,)))
        self.node = node
        self.source = source
        self.stamp_ns = stamp_ns
        self.original = cause

    @classmethod
    def of(
        cls, node: str, source: str, stamp_ns: int, cause: Exception
    ) -> "CallbackError":
        """Make an error that is also an instance of ``cause``'s class, if possible."""
        error = _blank(_joint_class(type(cause)))
        CallbackError.__init__(error, node, source, stamp_ns, cause)
        if isinstance(error, type(cause)):
            _copy_members(cause, error)
        return error

    def __str__(self) -> str:
        # Not that of the original class: KeyError would quote the text.
        return self._text

    def __getattr__(self, name: str) -> Any:
        if name == "original" or name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.original, name)


def _copy_members(source: Exception, target: Exception) -> None:
    """Copy the attributes of built-in classes, such as an OSError's errno."""
    for kind in type(source).__mro__:
        for name, member in vars(kind).items():
            if isinstance(member, MemberDescriptorType) and name[:2] != "__":
                setattr(target, name, getattr(source, name, None))


def _joint_class(kind: type[Exception]) -> type[CallbackError]:
    if issubclass(CallbackError, kind):
        return CallbackError
    try:
        return type(CallbackError.__name__, (CallbackError, kind), {})
    except TypeError:  # the class forbids subclasses
        return CallbackError


def _blank(kind: type[CallbackError]) -> CallbackError:
    """Make an instance without ``__init__``, which may require arguments."""
    for base in kind.__mro__:
        if base.__module__ == "builtins":
            make: Any = base.__new__
            try:
                blank: CallbackError = make(kind)
            except TypeError:  # another memory layout
                continue
            return blank
    # An exception group cannot be made without its parts.
    return CallbackError.__new__(CallbackError)
