"""Looking at all nodes a few times a second, while a client wants to know.

The socket thread keeps the time: it goes on where a callback of this program hangs, and
its seconds are those of people, whatever clock the program lives by.
"""

from collections.abc import Callable, Mapping

from navette.viewer.heartbeats import Heartbeats, NodeReport
from navette.viewer.hub import Hub
from navette.viewer.parameter_desk import Call
from navette.viewer.questions import Questions
from navette.viewer.remote_parameters import RemoteParameters

_HANGS_S = 2.0  # without a turn: then all nodes of this program hang

WhoIsThere = Callable[[], tuple[set[str], Mapping[str, bool]]]
"""Full names of the nodes here; of those elsewhere, with whether they can be asked."""


class Beats:
    """Asks the nodes, and tells the clients how they are.

    Args:
        run_soon: runs a function on the executor's thread.
        who_is_there: called there.
        now_s: wall time that only grows.
    """

    def __init__(
        self,
        hub: Hub,
        call: Call,
        run_soon: Callable[[Callable[[], None], str], None],
        who_is_there: WhoIsThere,
        questions: Questions,
        remote: RemoteParameters,
        now_s: Callable[[], float],
    ) -> None:
        self._hub = hub
        self._call = call
        self._run_soon = run_soon
        self._who_is_there = who_is_there
        self._questions = questions
        self._remote = remote
        self._heartbeats = Heartbeats(questions, now_s)
        self._now_s = now_s
        self._reports: list[NodeReport] = []
        self._is_under_way = False
        self._began_s = 0.0
        self._goes_on = False  # there is something to end

    def on_beat(self) -> None:
        """On the socket thread, every ``heartbeats.PERIOD_S``."""
        if self._is_under_way:
            waited_s = self._now_s() - self._began_s
            if waited_s > _HANGS_S:
                self._hub.set_nodes(self._reports, waited_s)
        elif self._hub.is_curious or self._goes_on or self._questions.under_way:
            self._is_under_way, self._began_s = True, self._now_s()
            self._run_soon(self._look, "heartbeat")

    def _look(self) -> None:
        self._is_under_way = False
        self._questions.give_up_old()
        self._goes_on = self._hub.is_curious
        if not self._goes_on:
            self._heartbeats.rest()
            return
        self._remote.fetch()
        here, others = self._who_is_there()
        self._reports = self._heartbeats.beat(here, others)
        self._call(self._hub.set_nodes, self._reports, 0.0)
