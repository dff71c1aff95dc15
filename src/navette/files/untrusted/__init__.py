"""Untrusted input: budgets, and bounded readers of YAML and XML."""

from navette.files.untrusted.budget import Budget, BudgetError, BudgetMeter

__all__ = ["Budget", "BudgetError", "BudgetMeter"]
