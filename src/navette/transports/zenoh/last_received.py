"""Time at which a session last received a sample or a request."""

# Liveliness tokens wait some milliseconds for the thread that reads them, longer on a
# busy machine.
_TOKEN_DELAY_NS = 2_000_000_000


class LastReceived:
    """Set by the receiving ports of a session, read by its publishers.

    Zenoh processes a subscriber's declaration before it delivers anything that the
    same process sent later. The graph contains that subscriber only once its token has
    been read. A process that sends a request and subscribes to the response topic must
    not miss the first messages on that topic.
    """

    def __init__(self) -> None:
        self.time_ns = -_TOKEN_DELAY_NS

    def is_recent(self, now_ns: int) -> bool:
        """Return whether tokens of the sender may still be unread."""
        return now_ns - self.time_ns < _TOKEN_DELAY_NS
