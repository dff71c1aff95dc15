"""Content filter options of a subscription, under rclpy's name."""

from typing import NamedTuple


class ContentFilterOptions(NamedTuple):
    """Filter expression of a subscription and its parameters.

    See :func:`navette.runtime.filter_expression.compile_filter`.
    ``expression_parameters`` are the values of ``%0``, ``%1``, … as text.
    """

    filter_expression: str
    expression_parameters: list[str]
