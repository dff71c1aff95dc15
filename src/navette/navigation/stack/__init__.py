"""The stack: the nodes of a run, wired in data-flow order."""

from navette.navigation.stack.options import RunOptions
from navette.navigation.stack.summary import RunSummary

__all__ = ["RunOptions", "RunSummary", "demo_goals"]


def demo_goals() -> tuple[tuple[float, float], ...]:
    """Return the goals of ``navette demo``: a tour of the built-in arena."""
    return ((6.2, -3.4), (8.2, 7.8), (-5.0, 8.3), (-7.5, -2.0))
