"""When something of the others came last: what they declared may still be unread."""

# Tokens wait for a thread that reads them: some milliseconds, more on a busy machine.
_UNREAD_NS = 2_000_000_000


class Heard:
    """Noted by the ports of a session that receive, asked by those that send.

    Zenoh knows a subscriber before it delivers anything that its process sent later;
    the graph knows it once its token has been read. Who asks for something and listens
    for what follows must not miss the beginning.
    """

    __slots__ = ("last_ns",)

    def __init__(self) -> None:
        #: The time here when a request or a sample came.
        self.last_ns = -_UNREAD_NS

    def is_recent(self, now_ns: int) -> bool:
        """Whether tokens of its sender may still wait to be read."""
        return now_ns - self.last_ns < _UNREAD_NS
