"""Contexts and arguments."""

from navette.runtime import (
    get_default_context,
    ok,
    remove_ros_args,
    shutdown,
    try_shutdown,
)

__all__ = ["get_default_context", "ok", "remove_ros_args", "shutdown", "try_shutdown"]
