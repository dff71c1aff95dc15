"""Progress of the playback on stderr; stdout is left for data."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console, RenderableType
from rich.live import Live
from rich.table import Table
from rich.text import Text

from navette.bags.play import PlayState
from navette.cli.bag.text import counted
from navette.navigation.stack.playback import BagPlayback

_REFRESH_HZ = 12
_MOST_LOSSES = 10
_WIDTH = 32
_BESIDE_BAR = 62  # columns of the figures beside the bar
_FIRST_DATE_NS = 10**17  # smaller stamps (before 1973) are simulated time
_SIGNS = {
    PlayState.PLAYING: ("▶", "bold green"),
    PlayState.PAUSED: ("⏸", "bold yellow"),
    PlayState.ENDED: ("■", "dim"),
}
_KEYS = (
    ("space", "pause"),
    ("s", "step"),
    ("←", "back"),
    ("↑↓", "rate"),
    ("q", "quit"),
)


class PlayScreen:
    """One line on the recording and, on a terminal, one live line of progress."""

    def __init__(self, playback: BagPlayback) -> None:
        self._playback = playback
        self._console = Console(stderr=True, highlight=False)

    def show_head(self, paths: list[Path], topics: int, url: str | None) -> None:
        """Print the recording and the address of the live view."""
        progress = self._playback.progress()
        length_s = (progress.end_ns - progress.begin_ns) / 1e9
        head = Text("Playing", style="bold cyan")
        head += Text(f"  {' '.join(p.name for p in paths)}", style="bold")
        head += Text(f" · {length_s:.1f} s · {counted(topics, 'topic')}")
        if progress.begin_ns > _FIRST_DATE_NS:
            head += Text(f" · {_date(progress.begin_ns)}", style="dim")
        self._console.print(head, soft_wrap=True)
        if url is not None:
            line = Text("live view  ", style="dim")
            line += Text(url, style="underline bright_blue")
            self._console.print(line, soft_wrap=True)

    @contextmanager
    def watching(self, *, keys: bool) -> Iterator[None]:
        """Show the progress until the block ends."""
        if not self._console.is_terminal:
            yield
            return
        if keys:
            self._console.print(_key_line(), soft_wrap=True)
        with Live(
            get_renderable=self._line,
            console=self._console,
            refresh_per_second=_REFRESH_HZ,
            transient=True,
        ):
            yield

    def report(self, word: str) -> None:
        """Print the summary."""
        progress = self._playback.progress()
        place_s = (progress.position_ns - progress.begin_ns) / 1e9
        passes = f", pass {progress.passes}" if progress.passes > 1 else ""
        messages = counted(progress.published, "message")
        line = Text(f"{word}: ", style="bold")
        line += Text(f"{messages}, {place_s:.1f} s{passes}")
        self._console.print(line, soft_wrap=True)

    def report_losses(self, losses: Sequence[str]) -> None:
        """Print which parts of the recordings could not be played."""
        if not losses:
            return
        self.report_failure(f"not played: {counted(len(losses), 'damaged part')}")
        for loss in losses[:_MOST_LOSSES]:
            self.report_failure(f"  {loss}")
        if len(losses) > _MOST_LOSSES:
            self.report_failure("  … (all of them: navette bag check FILE)")

    def report_failure(self, text: str) -> None:
        self._console.print(Text(text, style="bold red"), soft_wrap=True)

    def _line(self) -> RenderableType:
        progress = self._playback.progress()
        sign, style = _SIGNS[progress.state]
        place_s = (progress.position_ns - progress.begin_ns) / 1e9
        length_s = (progress.end_ns - progress.begin_ns) / 1e9
        width = len(f"{length_s:.1f}")
        line = Table.grid(padding=(0, 2))
        for _ in range(6):
            line.add_column(no_wrap=True)  # a narrow terminal shortens, one line stays
        line.add_row(
            Text(f"{sign} {progress.state.value:<7}", style=style),
            Text(f"{place_s:>{width}.1f} / {length_s:.1f} s"),
            self._bar(place_s / length_s if length_s else 1.0, style),
            Text(f"×{progress.rate:.3g}", style="cyan"),
            Text(counted(progress.published, "message"), style="dim"),
            Text(f"pass {progress.passes}" if progress.passes > 1 else "", style="dim"),
        )
        return line

    def _bar(self, share: float, style: str) -> Text:
        width = max(0, min(_WIDTH, self._console.width - _BESIDE_BAR))
        done = round(width * share)
        return Text.assemble(("━" * done, style), ("─" * (width - done), "dim"))


def _key_line() -> Text:
    line = Text()
    for key, meaning in _KEYS:
        line.append(f"{key} ", style="bold").append(f"{meaning}   ", style="dim")
    return line


def _date(stamp_ns: int) -> str:
    moment = datetime.fromtimestamp(stamp_ns // 10**9, UTC).astimezone()
    return f"{moment:%Y-%m-%d %H:%M:%S}"
