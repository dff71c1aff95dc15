"""The registry of planners."""

from navette.params.plugins import MethodRegistry

PLANNERS = MethodRegistry(
    "planner",
    "navette.planners",
    {
        # A whole plan: own_methods.OwnPlan; or a search on the grid: route.GridRouter,
        # which straightens it and checks the footprint.
        "plan": ("grid", "start", "goal"),
        "search": ("cost", "start", "goal"),
    },
)
"""A planner has one of these methods; see docs/howto/bring-your-own.md."""
