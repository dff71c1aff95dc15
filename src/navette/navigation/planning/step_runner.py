"""Steps of the navigator in a worker, while the node's callbacks continue."""

from collections.abc import Callable

from navette.navigation.background import Background
from navette.navigation.planning.navigator import Navigator

OnStepped = Callable[[], None]
"""Called after every step, in the thread of the callbacks."""


class StepRunner:
    """Steps a copy of the navigator, which replaces it when the step is complete.

    Attributes:
        navigator: the state before the step that runs.

    Args:
        navigator: the initial state.
        worker: computes the steps.
    """

    def __init__(
        self, navigator: Navigator, worker: Background, *, on_stepped: OnStepped
    ) -> None:
        self.navigator = navigator
        self._worker = worker
        self._on_stepped = on_stepped
        self._stepping: Navigator | None = None  # copy that the worker steps
        self._next: Callable[[], None] | None = None
        self._after_step: list[Callable[[], None]] = []

    @property
    def is_stepping(self) -> bool:
        """Whether the worker computes a step."""
        return self._stepping is not None

    def run(self, step: Callable[[Navigator], None]) -> None:
        """Step a copy of the navigator."""
        self._stepping = stepping = self.navigator.copy()
        self._worker.run(
            lambda: step(stepping),
            lambda _: self._finish(stepping),
            is_dropped=lambda: self._stepping is not stepping,
        )

    def then(self, action: Callable[[], None]) -> None:
        """Call an action once, after the step that runs, however often it is given."""
        self._next = action

    def drop(self) -> None:
        """Leave the step that the worker computes, for a change that cannot wait."""
        self._stepping = None
        waiting, self._after_step = self._after_step, []
        for change in waiting:
            change()

    def change(self, change: Callable[[], None]) -> None:
        """Change the navigator, after the step that the worker computes."""
        if self._stepping is None:
            change()
        else:
            self._after_step.append(change)

    def _finish(self, stepped: Navigator) -> None:
        self.navigator = stepped
        self.drop()
        self._on_stepped()
        action, self._next = self._next, None
        if action is not None:
            action()
