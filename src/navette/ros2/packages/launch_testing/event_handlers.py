"""Event handlers of test descriptions."""

from typing import Any

from navette.ros2.packages.launch.event_handlers import OnProcessIO
from navette.ros2.packages.launch.events.process import ProcessIO

__all__ = ["StdoutReadyListener"]


class StdoutReadyListener(OnProcessIO):
    """Handler that executes actions once a process has printed ``ready_txt``."""

    def __init__(
        self, *, target_action: Any = None, ready_txt: str, actions: list[Any]
    ) -> None:
        self._text = ready_txt
        self._actions = list(actions)
        super().__init__(target_action=target_action, on_stdout=self._on_output)
        self.entities = list(actions)  # for descriptions of the launch

    def _on_output(self, event: ProcessIO) -> list[Any] | None:
        if self._text not in event.text.decode(errors="replace"):
            return None
        actions, self._actions = self._actions, []
        return actions
