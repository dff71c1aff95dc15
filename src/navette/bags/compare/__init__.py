"""Comparison of two recordings, field by field."""

from navette.bags.compare.comparison import Comparison, TopicComparison, compare
from navette.bags.compare.fields import FieldDifference
from navette.bags.compare.tolerance import EXACT, Tolerance, Tolerances

__all__ = [
    "compare",
    "Comparison",
    "TopicComparison",
    "FieldDifference",
    "Tolerance",
    "Tolerances",
    "EXACT",
]
