"""Interface for problems that the user of the live view should see."""

from typing import Protocol


class ProblemReports(Protocol):
    """Receives what the live view refused; called on any thread."""

    def image_refused(self, reason: str) -> None:
        """An image was not compressed; called once per reason."""

    def origin_refused(self, reason: str) -> None:
        """A page of another origin was refused; called once per origin."""

    def user_refused(self) -> None:
        """A program of another user of this machine was refused."""
