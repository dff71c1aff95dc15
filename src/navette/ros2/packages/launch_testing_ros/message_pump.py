"""Thread that runs the callbacks of a test's node."""

from threading import Event, Thread

from navette.runtime import Context, Node, SingleThreadedExecutor

_PERIOD_S = 0.1
_END_S = 5.0


class MessagePump:
    """Spins a node in a thread from :meth:`start` to :meth:`stop`."""

    def __init__(self, node: Node, context: Context | None = None) -> None:
        self._node = node
        self._context = context
        self._end = Event()
        self._thread = Thread(target=self._spin, name="msg_pump_thread", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def stop(self) -> None:
        """Stop the thread.

        Raises:
            RuntimeError: a callback does not return.
        """
        self._end.set()
        self._thread.join(_END_S)
        if self._thread.is_alive():
            raise RuntimeError(f"a callback of {self._node.get_name()} does not return")

    def _spin(self) -> None:
        executor = SingleThreadedExecutor(context=self._context)
        executor.add_node(self._node)
        while not self._end.is_set():
            executor.spin_once(timeout_sec=_PERIOD_S)
        executor.remove_node(self._node)
