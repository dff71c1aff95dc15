"""tf2's exception names."""

# ruff: noqa: N818 - the names are tf2's

from navette.errors import InvalidNameError, TransformError


class TransformException(TransformError):
    """Base of the transform errors."""


class LookupException(TransformException):
    """A frame is not known."""


class ConnectivityException(TransformException):
    """Two frames have no common ancestor."""


class ExtrapolationException(TransformException):
    """A time outside the buffered one was asked for."""


class InvalidArgumentException(TransformException, InvalidNameError):
    """A frame name or a transform is malformed."""


class TimeoutException(TransformException):
    """It did not come in time."""
