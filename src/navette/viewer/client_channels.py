"""Channels on which clients publish."""

from collections.abc import Mapping

from navette.viewer import frames, replies
from navette.viewer.frames import ClientChannel
from navette.viewer.replies import Level
from navette.viewer.session import ProgramCommands, Session

_MAX_OF_A_CLIENT = 64
_MAX_OF_ALL = 256


class ClientChannels:
    """Opens and closes the clients' channels and forwards what they publish.

    Args:
        sessions: the connected clients by id.
    """

    def __init__(
        self, program: ProgramCommands, sessions: Mapping[int, Session]
    ) -> None:
        self._program = program
        self._sessions = sessions

    def advertise(self, session: Session, request: frames.Advertise) -> None:
        problems = []
        for channel in request.channels:
            problem = self._refusal(session, channel)
            if problem:
                problems.append(problem)
                continue
            session.client_channels[channel.id] = channel
            session.add_command(self._program.open_publisher, channel)
        session.send_problems("advertise", problems)

    def unadvertise(self, session: Session, request: frames.Unadvertise) -> None:
        problems = []
        for channel_id in request.channel_ids:
            if session.client_channels.pop(channel_id, None) is None:
                problems.append(f"unknown channel id {channel_id}")
            else:
                session.add_command(self._program.close_publisher, channel_id)
        session.send_problems("unadvertise", problems, Level.WARNING)

    def publish(self, session: Session, request: frames.Publish) -> None:
        if request.channel_id not in session.client_channels:
            session.send_status(
                f"publish: channel {request.channel_id} is not advertised"
            )
            return
        session.add_command(
            self._program.publish_from_client, request.channel_id, request.data
        )

    def close_all(self, session: Session) -> None:
        """Close the channels of a client that leaves."""
        for channel_id in list(session.client_channels):
            del session.client_channels[channel_id]
            session.add_command(self._program.close_publisher, channel_id)

    def _refusal(self, session: Session, channel: ClientChannel) -> str:
        """Return why a client's channel cannot be opened; empty if it can."""
        if channel.id in session.client_channels:
            return f"channel id {channel.id} is in use"
        if channel.encoding not in replies.ENCODINGS:
            return (
                f"encoding {channel.encoding!r:.80} of {channel.topic!r:.80}; "
                f"known: {', '.join(replies.ENCODINGS)}"
            )
        if len(session.client_channels) >= _MAX_OF_A_CLIENT:
            return f"a client can open {_MAX_OF_A_CLIENT} channels at most"
        opened = sum(len(each.client_channels) for each in self._sessions.values())
        if opened >= _MAX_OF_ALL:
            return f"all clients together can open {_MAX_OF_ALL} channels at most"
        return ""
