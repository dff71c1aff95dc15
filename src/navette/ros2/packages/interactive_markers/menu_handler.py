"""Menus of interactive markers: entries, check boxes, callbacks."""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from typing import Any

from navette.msgs.visualization_msgs.msg import InteractiveMarkerFeedback, MenuEntry
from navette.ros2.packages.interactive_markers.interactive_marker_server import (
    InteractiveMarkerServer,
)

_MARKS = {1: "[x] ", 2: "[ ] "}


OnFeedback = Callable[[InteractiveMarkerFeedback], Any]
"""Receives the selection of a menu entry."""


@dataclass
class _Entry:
    title: str
    command_type: int
    command: str
    callback: OnFeedback | None
    parent: int
    is_visible: bool = True
    check_state: int = 0
    children: list[int] = field(default_factory=list)


class MenuHandler:
    """A menu that is shown at markers; each entry has a handle, counted from 1."""

    NO_CHECKBOX = 0
    CHECKED = 1
    UNCHECKED = 2

    def __init__(self) -> None:
        self._entries: dict[int, _Entry] = {}
        self._top: list[int] = []
        self._handles = count(1)
        self._marker_names: set[str] = set()

    def insert(
        self,
        title: str,
        parent: int | None = None,
        command_type: int = MenuEntry.FEEDBACK,
        command: str = "",
        callback: Callable[[InteractiveMarkerFeedback], Any] | None = None,
    ) -> int | None:
        """Add an entry, below ``parent`` if given; return its handle.

        Returns:
            None if the parent is unknown.
        """
        if parent is not None and parent not in self._entries:
            return None
        handle = next(self._handles)
        self._entries[handle] = _Entry(
            title, command_type, command, callback, parent or 0
        )
        siblings = self._top if parent is None else self._entries[parent].children
        siblings.append(handle)
        return handle

    def setVisible(self, handle: int, visible: bool) -> bool:  # noqa: N802 - ROS 2's name
        """Show or hide an entry; return whether it exists."""
        return self._set(handle, "is_visible", visible)

    def setCheckState(self, handle: int, check_state: int) -> bool:  # noqa: N802 - ROS 2's name
        """Set the check box of an entry; return whether the entry exists."""
        return self._set(handle, "check_state", check_state)

    def getCheckState(self, handle: int) -> int | None:  # noqa: N802 - ROS 2's name
        """Return the state of the check box of an entry, or None."""
        entry = self._entries.get(handle)
        return None if entry is None else entry.check_state

    def getTitle(self, handle: int) -> str | None:  # noqa: N802 - ROS 2's name
        """Return the title of an entry, or None."""
        entry = self._entries.get(handle)
        return None if entry is None else entry.title

    def apply(self, server: InteractiveMarkerServer, marker_name: str) -> bool:
        """Show the menu at a marker; return whether the marker exists."""
        marker = server.get(marker_name)
        if marker is None:
            self._marker_names.discard(marker_name)
            return False
        marker.menu_entries = self._shown(self._top)
        server.insert(
            marker,
            feedback_callback=self.processFeedback,
            feedback_type=InteractiveMarkerFeedback.MENU_SELECT,
        )
        self._marker_names.add(marker_name)
        return True

    def reApply(self, server: InteractiveMarkerServer) -> bool:  # noqa: N802 - ROS 2's name
        """Show the changed menu at all its markers; return whether they exist."""
        shown = [self.apply(server, name) for name in sorted(self._marker_names)]
        return all(shown)

    def processFeedback(  # noqa: N802 - ROS 2's name
        self, feedback: InteractiveMarkerFeedback
    ) -> None:
        """Call the callback of the selected entry."""
        entry = self._entries.get(feedback.menu_entry_id)
        if entry is not None and entry.callback is not None:
            entry.callback(feedback)

    def _set(self, handle: int, name: str, value: Any) -> bool:
        entry = self._entries.get(handle)
        if entry is not None:
            setattr(entry, name, value)
        return entry is not None

    def _shown(self, handles: list[int]) -> list[MenuEntry]:
        """Return the visible entries, each followed by those below it."""
        shown: list[MenuEntry] = []
        for handle in handles:
            entry = self._entries[handle]
            if entry.is_visible:
                title = _MARKS.get(entry.check_state, "") + entry.title
                shown.append(
                    MenuEntry(
                        id=handle,
                        parent_id=entry.parent,
                        title=title,
                        command=entry.command,
                        command_type=entry.command_type,
                    )
                )
                shown += self._shown(entry.children)
        return shown
