"""A fake of what the sample buffer requires of a transport."""

from navette.transports import Endpoint, Item


class Publishers:
    """The matched publishers of a subscription; their samples are not observed."""

    def __init__(self, by_gid: dict[bytes, Endpoint]) -> None:
        self._by_gid = by_gid

    def publishers(self) -> dict[bytes, Endpoint]:
        return self._by_gid

    def on_sample(self, gid: bytes, item: Item) -> None:
        """Samples assert nothing here."""
