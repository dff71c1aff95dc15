"""Exceptions of transform lookups, with tf2's names."""

# ruff: noqa: N818 - the names are tf2's

from navette.errors import InvalidNameError, TransformError


class TransformException(TransformError):
    """Base of the transform errors."""


class LookupException(TransformException):
    """A frame does not exist."""


class ConnectivityException(TransformException):
    """Two frames have no common ancestor."""


class ExtrapolationException(TransformException):
    """The requested time is outside the buffered interval."""


class InvalidArgumentException(TransformException, InvalidNameError):
    """A frame name or a transform is malformed."""


class TimeoutException(TransformException):
    """The transform was not available in time."""
