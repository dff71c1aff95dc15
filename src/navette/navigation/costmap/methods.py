"""The registry of costmap methods."""

from navette.params.plugins import MethodRegistry

COSTMAPS = MethodRegistry(
    "costmap",
    "navette.costmaps",
    # The user's own: own_costmap.OwnCostmap; or a whole costmap.
    {"costmap": ("scan", "grid"), "build": ("scan",)},
)
"""A costmap has one of these methods; see docs/howto/bring-your-own.md."""
