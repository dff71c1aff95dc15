"""``navette bench``: trials in worlds, their measures, statistics and report."""

from navette.navigation.bench.trial import Trial, TrialResult

__all__ = ["Trial", "TrialResult"]
