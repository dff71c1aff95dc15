"""Playback of bags to nodes in this process, other processes, or a browser."""

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


class BagPlayback:
    """One or several bags, merged by their stamps, under one player.

    Args:
        paths: bag files or folders.
        options: topics and time range to play.
        remap: rules ``FROM:=TO``.
        clock_rate_hz: rate of the recording's time on ``/clock``; None: not published.
        view_port: port of the live view; with it, playback does not stop at the end.
        context: context of the player; by default a new one, joined to the network.

    Raises:
        NavetteError: invalid file or option, named in the text.
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
        #: What could not be played, so far.
        self.losses: list[str] = []
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
            #: Address of the live view.
            self.url = None if view_port is None else self._open_view(view_port)
            opening.pop_all()

    def run(self) -> None:
        """Play to the end, or until :meth:`stop`."""
        self.player.start()
        self.executor.spin()

    def stop(self) -> None:
        """Stop :meth:`run`; callable from any thread."""
        self.executor.stop()

    def progress(self) -> PlayProgress:
        """Return the present progress; callable from any thread."""
        return self.player.progress()

    def do(self, action: Callable[[PlayerNode], object]) -> None:
        """Run an action on the player's loop; callable from any thread."""
        self.player.run_soon(lambda: action(self.player))

    def close(self) -> None:
        """Destroy the nodes and close the files; idempotent."""
        self._stack.close()

    def _open(self, paths: Sequence[Path]) -> Source:
        sources = []
        for path in paths:
            reader = self._stack.enter_context(open_bag(path))
            for problem in reader.problems:
                _log.warning("%s", problem)
            self.losses += [f"{path}: {each}" for each in reader.losses]
            sources.append(TolerantSource(reader, on_damage=self._report))
        return sources[0] if len(sources) == 1 else MergedSource(sources)

    def _join(self) -> Context:
        context = Context()
        self._stack.callback(context.try_shutdown)
        context.init(args=[], console_level=LoggingSeverity.WARN)
        return context

    def _open_view(self, port: int) -> str:
        # Imported here: playback without a view does not load the web server.
        from navette.viewer.node import ViewerNode

        viewer = ViewerNode(
            context=self.context,
            playback=_Shown(self.player),
            parameter_overrides=[Parameter("port", value=port)],
        )
        self._stack.callback(viewer.close)
        self.executor.add_node(viewer)
        return viewer.url

    def _report(self, damage: Damage) -> None:
        _log.warning("left out: %s", damage)
        self.losses.append(str(damage))

    def _on_end(self) -> None:
        if self.url is None:
            self.stop()


class _Shown:
    """Adapter from the player to the live view's playback protocol."""

    def __init__(self, player: PlayerNode) -> None:
        self._player = player
        self.begin_ns = player.player.begin_ns
        self.end_ns = player.player.end_ns

    def state(self) -> PlaybackState:
        progress = self._player.progress()
        status = _STATUS[progress.state]
        return PlaybackState(status, progress.position_ns, progress.rate)

    def control(self, *, play: bool, speed: float, seek_ns: int | None) -> None:
        # A 32-bit float in the protocol: round to its precision (0.1).
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
