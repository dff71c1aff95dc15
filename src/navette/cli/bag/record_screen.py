"""Progress of a recording on stderr."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.console import Console
from rich.live import Live
from rich.text import Text

from navette.cli.bag.text import counted, size_text
from navette.runtime import Stopwatch

if TYPE_CHECKING:
    from navette.bags.node import RecorderNode

_REFRESH_HZ = 4


class RecordScreen:
    """A live line of progress, and a summary."""

    def __init__(self, recorder: "RecorderNode") -> None:
        self._recorder = recorder
        self._stopwatch = Stopwatch()
        self._console = Console(stderr=True, highlight=False)

    @contextmanager
    def watching(self, *, keys: bool) -> Iterator[None]:
        """Show the progress until the block ends."""
        hint = "space pauses, q ends" if keys else "Ctrl-C ends"
        self._console.print(
            Text.assemble(
                ("recording to ", "dim"),
                (str(self._recorder.path), "bold"),
                (f"   {hint}", "dim"),
            ),
            soft_wrap=True,
        )
        if not self._console.is_terminal:
            yield
            return
        with Live(
            get_renderable=self._line,
            console=self._console,
            refresh_per_second=_REFRESH_HZ,
            transient=True,
        ):
            yield

    def report(self) -> None:
        """Print the summary."""
        recorder = self._recorder
        if recorder.error is not None:
            text = f"{recorder.error}; messages recorded before are valid"
            self._console.print(Text(text, style="bold red"), soft_wrap=True)
        self._console.print(
            Text(f"{recorder.path}: ") + Text(self._figures()), soft_wrap=True
        )

    def _figures(self) -> str:
        recorder = self._recorder
        return (
            f"{counted(recorder.message_count, 'message')} of "
            f"{counted(len(recorder.topics), 'topic')}, "
            f"{size_text(recorder.payload_bytes)} before compression"
        )

    def _line(self) -> Text:
        paused = self._recorder.params.paused
        state = ("❚❚ paused   ", "yellow") if paused else ("● recording", "red")
        since = f"  {self._stopwatch.elapsed_s:7.1f} s  "
        return Text.assemble(state, (since, "dim"), self._figures())
