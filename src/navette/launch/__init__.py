"""Puts it together: the nodes of a run, wired in flow order."""

from navette.launch.options import RunOptions
from navette.launch.summary import RunSummary

__all__ = ["RunOptions", "RunSummary", "demo_goals"]


def demo_goals() -> tuple[tuple[float, float], ...]:
    """Where ``navette demo`` drives at once: a tour of the built-in arena."""
    return ((7.0, -6.5), (7.0, 6.5), (-7.0, 5.5), (0.0, 0.0))
