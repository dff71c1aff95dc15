"""Conversion between tf2's exceptions and tf2_msgs/msg/TF2Error."""

from navette.msgs.tf2_msgs.msg import TF2Error
from navette.runtime.tf import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

_KINDS: dict[int, type[TransformException]] = {
    TF2Error.LOOKUP_ERROR: LookupException,
    TF2Error.CONNECTIVITY_ERROR: ConnectivityException,
    TF2Error.EXTRAPOLATION_ERROR: ExtrapolationException,
    TF2Error.INVALID_ARGUMENT_ERROR: InvalidArgumentException,
    TF2Error.TIMEOUT_ERROR: TimeoutException,
}


def exception_of(error: TF2Error) -> TransformException:
    return _KINDS.get(error.error, TransformException)(error.error_string)


def error_of(exception: TransformException) -> TF2Error:
    for number, kind in _KINDS.items():
        if isinstance(exception, kind):
            return TF2Error(error=number, error_string=str(exception))
    return TF2Error(error=TF2Error.TRANSFORM_ERROR, error_string=str(exception))
