"""Bounded send queue of one client; the newest frames are kept."""

from collections import Counter, deque
from collections.abc import Hashable
from dataclasses import dataclass, field

from navette.viewer import replies
from navette.viewer.large_grid import LargeGrid, Payload

Frame = str | bytes
Parts = list[bytes | memoryview]
"""A binary frame in parts, which are sent one after another."""

_PART_BYTES = 2**18


@dataclass(frozen=True)
class MessageFrame:
    """A message; encoded when it is sent, so that dropped ones cost nothing."""

    subscription_id: int
    stamp_ns: int
    payload: Payload

    def __len__(self) -> int:
        return len(self.payload)

    def encode(self) -> bytes | Parts:
        """Return the frame, in parts if it is long.

        Python runs one thread at a time: copying a large map at once would stop the
        robot's nodes in the same process.
        """
        head = replies.message_head(self.subscription_id, self.stamp_ns)
        if isinstance(self.payload, LargeGrid):
            head, view = head + self.payload.head, self.payload.cells
        elif len(self.payload) <= _PART_BYTES:
            return head + self.payload
        else:
            view = memoryview(self.payload)
        starts = range(0, len(view), _PART_BYTES)
        return [head, *(view[start : start + _PART_BYTES] for start in starts)]


class Outbox:
    """Frames for one client, in order; a slow client loses old data frames only.

    Control frames (responses, advertisements) are never dropped: when more than
    ``control_bytes`` of them are queued, :attr:`overflowed` is set and the client
    should be disconnected. Data frames belong to a stream (a subscription); each stream
    keeps its newest ``depth`` frames and at most ``stream_bytes`` (but always one
    frame), so that a slow client receives current data of every topic at a lower rate.
    All streams together keep at most ``data_bytes`` (but always the newest frame): the
    stream with the most bytes loses its oldest, so that a goal outlives images.
    """

    def __init__(
        self,
        *,
        depth: int = 16,
        stream_bytes: int = 4_000_000,
        data_bytes: int = 32_000_000,
        control_bytes: int = 64_000_000,
    ) -> None:
        self._depth = depth
        self._stream_bytes = stream_bytes
        self._data_limit = data_bytes
        self._data_size = 0
        self._control_limit = control_bytes
        self._control: deque[Frame] = deque()
        #: Bytes of the queued control frames.
        self.control_size = 0
        self._sending = 0
        self._streams: dict[Hashable, _Stream] = {}
        self._turns: deque[Hashable] = deque()
        self._lost = Counter[Hashable]()
        self.dropped = 0
        self.overflowed = False

    def __bool__(self) -> bool:
        return bool(self._control or self._turns)

    def put_control(self, frame: Frame) -> None:
        if self.overflowed:
            return
        self._control.append(frame)
        self.control_size += len(frame)
        self.overflowed = self.control_size > self._control_limit

    def put_data(
        self,
        stream: Hashable,
        frame: Frame | MessageFrame,
        *,
        depth: int | None = None,
    ) -> None:
        waiting = self._streams.get(stream)
        if waiting is None:
            waiting = self._streams[stream] = _Stream()
        waiting.frames.append(frame)
        waiting.size += len(frame)
        self._data_size += len(frame)
        self._turns.append(stream)
        limit = self._depth if depth is None else depth
        while len(waiting.frames) > 1 and (
            len(waiting.frames) > limit or waiting.size > self._stream_bytes
        ):
            self._drop_oldest(stream)
        while self._data_size > self._data_limit and len(self._turns) > 1:
            self._drop_oldest(self._largest(stream))

    def _largest(self, newest: Hashable) -> Hashable:
        """Return the stream with the most bytes, besides the frame put last."""
        return max(
            (
                name
                for name, waiting in self._streams.items()
                if name != newest or len(waiting.frames) > 1
            ),
            key=lambda name: self._streams[name].size,
        )

    def _drop_oldest(self, stream: Hashable) -> None:
        waiting = self._streams[stream]
        size = len(waiting.frames.popleft())
        waiting.size -= size
        self._data_size -= size
        # A stream has as many turns as frames.
        self._turns.remove(stream)
        if not waiting.frames:
            del self._streams[stream]
        self.dropped += 1
        self._lost[stream] += 1

    def lost(self, stream: Hashable) -> int:
        """Return the number of frames of a stream that were dropped."""
        return self._lost[stream]

    def forget(self, stream: Hashable) -> None:
        del self._lost[stream]
        waiting = self._streams.pop(stream, None)
        if waiting is not None:
            self._data_size -= waiting.size
            self._turns = deque(turn for turn in self._turns if turn != stream)

    def pop(self) -> Frame | Parts:
        """Remove and return the next frame: control frames first, then data.

        The frame counts as queued until the next one or :meth:`sent`.
        """
        if self._control:
            frame: Frame | MessageFrame = self._control.popleft()
            self.control_size -= len(frame)
        else:
            frame = self._pop_data()
        self._sending = len(frame)
        return frame.encode() if isinstance(frame, MessageFrame) else frame

    def sent(self) -> None:
        """Note that the frame that was removed last has been sent."""
        self._sending = 0

    @property
    def size(self) -> int:
        """Bytes of all queued frames."""
        return self.control_size + self._data_size + self._sending

    def _pop_data(self) -> Frame | MessageFrame:
        stream = self._turns.popleft()
        waiting = self._streams[stream]
        data = waiting.frames.popleft()
        waiting.size -= len(data)
        self._data_size -= len(data)
        if not waiting.frames:
            del self._streams[stream]
        return data


@dataclass
class _Stream:
    frames: deque[Frame | MessageFrame] = field(default_factory=deque)
    size: int = 0
