"""Long payloads in shared memory: written once, read with one copy.

Zenoh itself moves long payloads between processes of one machine through shared memory,
but copies them once more on the way there, and clears the memory that a reader receives
before it fills it. Both are avoided here. Peers see no difference: a peer that
cannot open the memory receives the bytes.
"""

import ctypes
import logging
import threading

import zenoh
from zenoh import shm

from navette.msgs.registry import get_message_spec
from navette.transports.base import Endpoint, TransportObserver

# Shorter payloads are copied faster than shared memory is managed.
MIN_BYTES = 32_768
# Room for so many payloads in the first pool; longer ones use the large pool.
_PAYLOADS = 4
_POOL_BYTES = 8 << 20
_LARGE_POOL_BYTES = 32 << 20

# Parameters of glibc's mallopt(3).
_M_TRIM_THRESHOLD, _M_MMAP_THRESHOLD = -1, -3
_KEPT_BYTES = 32 << 20

_log = logging.getLogger(__name__)


def copied(payload: zenoh.ZBytes) -> bytes:
    """Return a copy of a payload."""
    if len(payload) >= MIN_BYTES:
        shared = payload.as_shm()
        if shared is not None:
            return bytes(shared)
    return payload.to_bytes()


class SharedPool:
    """Shared memory of one size; kept until the end of the process.

    Readers open it when they receive the first payload: it must not vanish before.

    Args:
        size: in bytes.
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._provider: shm.ShmProvider | None = None
        self._is_requested = False
        # Before an allocation: the chunks that all readers have released.
        self._policy = shm.GarbageCollect()

    def open(self) -> None:
        """Open the pool in a thread, which takes 10 to 20 ms; may be called again."""
        if not self._is_requested:
            self._is_requested = True
            threading.Thread(target=self._open, name="navette-shm", daemon=True).start()

    def stored(self, data: bytes) -> "bytes | shm.ZShmMut":
        """Return the data in shared memory, or the data itself if it has no place."""
        if self._provider is None:
            self.open()
            return data
        size = len(data)
        try:
            chunk = self._provider.alloc(size, self._policy)
        except zenoh.ZError:  # slow readers hold too much
            return data
        chunk[0:size] = data
        return chunk

    def _open(self) -> None:
        try:
            provider = shm.ShmProvider.default_backend(self._size)
            provider.alloc(1, self._policy)  # the first chunk opens further resources
            self._provider = provider
            _keep_freed_memory()
        except zenoh.ZError as error:
            _log.warning(
                "no shared memory of %d MB (%s): long messages between processes are "
                "slower; check the free space of /dev/shm",
                self._size >> 20,
                error,
            )


class SharedPools(TransportObserver):
    """Shared memory for the samples of a session, opened when it is needed.

    A pool for images, point clouds and grids is opened when an endpoint of such a type
    is matched. Before a pool is open, and while slow readers hold all of it, payloads
    are sent through the socket.
    """

    def __init__(self) -> None:
        self._pool = SharedPool(_POOL_BYTES)
        self._large_pool = SharedPool(_LARGE_POOL_BYTES)

    def matched(self, publisher: Endpoint, subscription: Endpoint) -> None:
        if _has_long_samples(publisher.type_name):
            self._pool.open()

    def stored(self, data: bytes) -> "bytes | shm.ZShmMut":
        """Return the data in shared memory, or the data itself if it has no place."""
        if len(data) <= _POOL_BYTES // _PAYLOADS:
            return self._pool.stored(data)
        if len(data) <= _LARGE_POOL_BYTES // 2:
            return self._large_pool.stored(data)
        return data


def _keep_freed_memory() -> None:
    """Let glibc reuse the memory of long messages instead of returning it.

    The kernel clears each page that it hands out again, which costs as much as the
    copies of a message. At most 32 MB per thread arena are kept.
    """
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is not None:
        mallopt(_M_MMAP_THRESHOLD, _KEPT_BYTES)
        mallopt(_M_TRIM_THRESHOLD, _KEPT_BYTES)


def _has_long_samples(type_name: str) -> bool:
    """Return whether messages of the type are images, clouds, grids or similar."""
    return any(
        field.type.container == "sequence"
        and field.type.size is None
        and field.type.base in ("uint8", "int8")
        for field in get_message_spec(type_name).fields
    )
