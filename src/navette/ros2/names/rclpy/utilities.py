"""Contexts and arguments."""

from navette.runtime import (
    Context,
    get_default_context,
    ok,
    remove_ros_args,
    shutdown,
    try_shutdown,
)
from navette.runtime.rmw import (
    get_available_rmw_implementations,
    get_rmw_implementation_identifier,
)
from navette.runtime.time import NS_PER_S as S_TO_NS
from navette.runtime.time import timeout_sec_to_nsec

__all__ = [
    "Context",
    "S_TO_NS",
    "get_available_rmw_implementations",
    "get_default_context",
    "get_rmw_implementation_identifier",
    "ok",
    "remove_ros_args",
    "shutdown",
    "timeout_sec_to_nsec",
    "try_shutdown",
]
