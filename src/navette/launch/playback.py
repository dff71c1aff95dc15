"""Bags played to whoever listens: in this process, in others, in a browser."""

import logging
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path

from navette.bags import Damage, open_bag
from navette.bags.play import MergedSource, PlayOptions, Source, TolerantSource
from navette.bags.play.node import PlayerNode, PlayProgress
from navette.runtime import Context, Executor, LoggingSeverity

_log = logging.getLogger(__name__)


class Playback:
    """One or several bags, merged by their stamps, under one player.

    Args:
        paths: bag files or folders.
        options: what to play of them.
        remap: rules ``FROM:=TO``.
        clock_rate_hz: tell the recording's time on ``/clock`` so often.
        view_port: serve the live view there; then the end of the bag is not the end.
        context: where; by default one of its own, joined to the network.

    Raises:
        NavetteError: a file or an option is wrong; says which.
    """

    def __init__(
        self,
        paths: Sequence[Path],
        options: PlayOptions,
        *,
        remap: Sequence[str] = (),
        clock_rate_hz: float | None = None,
        view_port: int | None = None,
        context: Context | None = None,
    ) -> None:
        self._stack = ExitStack()
        with ExitStack() as opening:
            opening.callback(self.close)
            self.source = self._open(paths)
            self.context = context or self._join()
            self.player = PlayerNode(
                self.source,
                options,
                context=self.context,
                remap=remap,
                clock_rate_hz=clock_rate_hz,
                on_end=self._on_end,
            )
            self._stack.callback(self.player.destroy_node)
            self.executor = Executor(context=self.context)
            self.executor.add_node(self.player)
            opening.pop_all()
        #: Where to look at it in a browser.
        self.url: str | None = None

    def run(self) -> None:
        """Play to the end, or until :meth:`stop`."""
        self.player.start()
        self.executor.spin()

    def stop(self) -> None:
        """End :meth:`run`; from any thread."""
        self.executor.stop()

    def progress(self) -> PlayProgress:
        """How it goes now; from any thread."""
        return self.player.progress()

    def do(self, action: Callable[[PlayerNode], object]) -> None:
        """Have something done with the player; from any thread."""
        self.player.run_soon(lambda: action(self.player))

    def close(self) -> None:
        """Leave the graph and close the files; twice is harmless."""
        self._stack.close()

    def _open(self, paths: Sequence[Path]) -> Source:
        sources = []
        for path in paths:
            reader = self._stack.enter_context(open_bag(path))
            for problem in reader.problems:
                _log.warning("%s", problem)
            sources.append(TolerantSource(reader, _report))
        return sources[0] if len(sources) == 1 else MergedSource(sources)

    def _join(self) -> Context:
        context = Context()
        self._stack.callback(context.try_shutdown)
        context.init(args=[], console_level=LoggingSeverity.WARN)
        return context

    def _on_end(self) -> None:
        if self.url is None:
            self.stop()


def _report(damage: Damage) -> None:
    _log.warning("left out: %s", damage)
