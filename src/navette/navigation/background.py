"""Where long computations run, as code without a node sees it."""

from collections.abc import Callable
from typing import Protocol, TypeVar

T = TypeVar("T")


class Background(Protocol):
    """Computes beside the callbacks, such as :class:`navette.runtime.worker.Worker`."""

    def run(
        self,
        compute: Callable[[], T],
        finish: Callable[[T], None],
        *,
        is_dropped: Callable[[], bool],
    ) -> None:
        """Call ``finish`` with the result of ``compute``, unless ``is_dropped``."""
