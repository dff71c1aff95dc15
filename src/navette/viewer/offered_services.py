"""Services that clients may call, with the ids by which they call them."""

import itertools
from collections.abc import Iterable

from navette.viewer import replies
from navette.viewer.replies import OfferedService


class OfferedServices:
    """The services of the graph, each with an id."""

    def __init__(self) -> None:
        self._by_id: dict[int, OfferedService] = {}
        self._ids = itertools.count(1)
        #: Encoded once for any number of clients that join; empty without services.
        self.advertisement = ""

    def find(self, service_id: int) -> OfferedService | None:
        return self._by_id.get(service_id)

    def update(self, services: Iterable[OfferedService]) -> list[str]:
        """Replace the services; return the frames that report the difference."""
        wanted = dict.fromkeys(services)
        gone = [key for key, service in self._by_id.items() if service not in wanted]
        for key in gone:
            del self._by_id[key]
        known = set(self._by_id.values())
        added = {next(self._ids): each for each in wanted if each not in known}
        self._by_id |= added
        frames = []
        if gone:
            frames.append(replies.unadvertise_services(gone))
        if added:
            frames.append(replies.advertise_services(added.items()))
        if frames:
            self.advertisement = replies.advertise_services(self._by_id.items())
        return frames
