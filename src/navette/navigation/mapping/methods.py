"""The registry of mapping methods."""

from navette.params.plugins import MethodRegistry

MAPPINGS = MethodRegistry(
    "mapping",
    "navette.mapping",
    # The user's own: own_mapping.OwnMapping; or a whole map memory.
    {"update": ("cells", "seen", "grid"), "fuse": ("costmap",)},
)
"""A mapping method has one of these; see docs/howto/bring-your-own.md."""
