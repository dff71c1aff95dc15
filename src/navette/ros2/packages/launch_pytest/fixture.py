"""Fixtures that return a launch description."""

from collections.abc import Callable
from typing import Any

import pytest

OPTIONS = "_launch_pytest_options"


def fixture(
    decorated: Callable[..., Any] | None = None,
    *,
    shutdown: bool = False,
    auto_shutdown: bool = True,
    **kwargs: Any,
) -> Any:
    """Make a pytest fixture of a function that returns a launch description.

    Args:
        shutdown: tests run after the launch has been shut down.
        auto_shutdown: the launch ends with the fixture.
        kwargs: of ``pytest.fixture``: ``scope``, ``params``, ``name``, …
    """

    def make(function: Callable[..., Any]) -> Any:
        options = {"shutdown": shutdown, "auto_shutdown": auto_shutdown}
        setattr(
            function, OPTIONS, {**options, "scope": kwargs.get("scope", "function")}
        )
        made: Any = pytest.fixture(function, **kwargs)
        setattr(made, OPTIONS, getattr(function, OPTIONS))
        return made

    return make if decorated is None else make(decorated)
