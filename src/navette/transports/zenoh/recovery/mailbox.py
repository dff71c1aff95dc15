"""Where a session's letters arrive, and how they are sent."""

import contextlib
from collections.abc import Callable
from typing import Any

import zenoh

from navette.errors import DecodeError
from navette.transports.zenoh.complaints import Complaints
from navette.transports.zenoh.recovery.mail import (
    Kind,
    Letter,
    mail_key,
    parse_letter,
    parse_sender,
)

# Sessions remembered; a hostile peer may make up any number.
_MOST_PEERS = 20_000
# How far a publisher has come, or that it is closed, is not to be known before its
# samples are there; all else had better come before them.
_AHEAD, _IN_TURN = zenoh.Priority.INTERACTIVE_HIGH, zenoh.Priority.DATA
_KINDS_IN_TURN = {Kind.HEADS, Kind.CLOSED, Kind.BYE}


class Mailbox:
    """Sends letters, and reads those that come.

    Args:
        zid: of ``session``.
        read: called with the sender and the letter, on Zenoh's threads.
    """

    def __init__(
        self,
        session: zenoh.Session,
        zid: str,
        domain_id: int,
        complaints: Complaints,
        read: Callable[[str, Letter], None],
    ) -> None:
        self._session = session
        self._zid = zid
        self._domain_id = domain_id
        self._complaints = complaints
        self._read = read
        self._subscriber: Any = None
        self._correspondents: dict[str, None] = {}

    @property
    def is_open(self) -> bool:
        """Whether letters can come."""
        return self._subscriber is not None

    def open(self) -> None:
        """Letters can come from now on."""
        self._subscriber = self._session.declare_subscriber(
            mail_key(self._domain_id, self._zid, "*"),
            zenoh.handlers.Callback(self._on_sample, indirect=False),
            allowed_origin=zenoh.Locality.REMOTE,
        )

    def send(self, to: str, letter: Letter) -> None:
        """It may be lost."""
        self._remember(to)
        # Closed by now, at the exit of the process: nobody reads it.
        with contextlib.suppress(zenoh.ZError):
            self._session.put(
                mail_key(self._domain_id, to, self._zid),
                letter.encode(),
                priority=_IN_TURN if letter.kind in _KINDS_IN_TURN else _AHEAD,
                congestion_control=zenoh.CongestionControl.DROP,
                allowed_destination=zenoh.Locality.REMOTE,
            )

    def say_goodbye(self) -> None:
        """To all with whom there were letters."""
        for session in list(self._correspondents):
            self.send(session, Letter(Kind.BYE))

    def _on_sample(self, sample: zenoh.Sample) -> None:
        try:
            sender = parse_sender(str(sample.key_expr))
            letter = parse_letter(sample.payload.to_bytes())
        except DecodeError as error:
            text = f"recovery: letter ignored: {error}"
            self._complaints.once(("letter",), text)
            return
        self._remember(sender)
        self._read(sender, letter)

    def _remember(self, session: str) -> None:
        known = self._correspondents
        if session not in known and len(known) >= _MOST_PEERS:
            known.pop(next(iter(known)), None)
        known[session] = None
