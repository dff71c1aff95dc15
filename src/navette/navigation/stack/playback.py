"""Bags played to whoever listens: in this process, in others, in a browser."""

import logging
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path

from navette.bags import Damage, open_bag
from navette.bags.play import (
    MergedSource,
    PlayOptions,
    PlayState,
    Source,
    TolerantSource,
)
from navette.bags.play.node import PlayerNode, PlayProgress
from navette.runtime import Context, Executor, LoggingSeverity, Parameter
from navette.viewer.playback import PlaybackState, PlaybackStatus

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
            #: Where to look at it in a browser.
            self.url = None if view_port is None else self._open_view(view_port)
            opening.pop_all()

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

    def _open_view(self, port: int) -> str:
        # Only here: who plays without a view need not wait for a web server to load.
        from navette.viewer.node import ViewerNode

        viewer = ViewerNode(
            context=self.context,
            playback=_Shown(self.player),
            parameter_overrides=[Parameter("port", value=port)],
        )
        self._stack.callback(viewer.close)
        self.executor.add_node(viewer)
        return viewer.url

    def _on_end(self) -> None:
        if self.url is None:
            self.stop()


class _Shown:
    """The player as the live view sees it."""

    def __init__(self, player: PlayerNode) -> None:
        self._player = player
        self.begin_ns = player.player.begin_ns
        self.end_ns = player.player.end_ns

    def state(self) -> PlaybackState:
        progress = self._player.progress()
        status = _STATUS[progress.state]
        return PlaybackState(status, progress.position_ns, progress.rate)

    def control(self, *, play: bool, speed: float, seek_ns: int | None) -> None:
        # A 32-bit number on the wire: 0.1 was meant.
        rate = float(f"{speed:.6g}")
        self._player.control(play=play, rate=rate, seek_ns=seek_ns)

    def step(self) -> None:
        self._player.step()

    def on_change(self, callback: Callable[[bool], None]) -> None:
        self._player.on_change = callback


_STATUS = {
    PlayState.PLAYING: PlaybackStatus.PLAYING,
    PlayState.PAUSED: PlaybackStatus.PAUSED,
    PlayState.ENDED: PlaybackStatus.ENDED,
}


def _report(damage: Damage) -> None:
    _log.warning("left out: %s", damage)
