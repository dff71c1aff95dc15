"""Work of a thread, for limits on its share."""

from navette.viewer.wall_clock import WallClock

_CPU_WEIGHT = 3.0  # the most that a second of CPU time counts


class WorkTime:
    """Measures pieces of work of one thread.

    Work is wall time, but at most three times the CPU time: calls that block count, and
    on a machine that is short of CPU time a thread takes more of what the process
    receives. A thread that only waits for the interpreter delays no node, and an
    operator's command must not wait for a debt of others.
    """

    def __init__(self, clock: WallClock) -> None:
        self._clock = clock
        self._begin_s: tuple[float, float] | None = None

    def begin(self) -> None:
        self._begin_s = self._clock.now_s, self._clock.thread_cpu_s

    def elapsed_s(self) -> float:
        """Return the work since :meth:`begin`; 0 before the first."""
        if self._begin_s is None:
            return 0.0
        wall_s = self._clock.now_s - self._begin_s[0]
        cpu_s = self._clock.thread_cpu_s - self._begin_s[1]
        return min(wall_s, _CPU_WEIGHT * cpu_s)
