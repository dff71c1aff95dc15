"""Content filters of subscriptions, under rclpy's name."""

from typing import NamedTuple


class ContentFilterOptions(NamedTuple):
    """Which samples a subscription wants (see ``filter_expression``).

    ``expression_parameters`` are what ``%0``, ``%1``, … stand for, as text.
    """

    filter_expression: str
    expression_parameters: list[str]
