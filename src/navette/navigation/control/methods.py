"""The registry of controllers."""

from navette.params.plugins import MethodRegistry

CONTROLLERS = MethodRegistry(
    "controller",
    "navette.controllers",
    {
        # The user's own: CommandFollower; a steering law along the pieces of the path:
        # PathFollower; a whole follower.
        "command": ("state", "path", "obstacles"),
        "curvature": ("piece", "at", "pose", "speed"),
        "step": ("inputs", "dt"),
    },
)
"""A controller has one of these methods; see docs/howto/bring-your-own.md."""
