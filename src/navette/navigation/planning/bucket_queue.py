"""An open list for integer priorities: a circle of buckets (Dial 1969).

A bucket is a last-in-first-out list threaded through one pool of int64 entries,
``item << 32 | next``; ``heads[priority >> shift & lap]`` is its first entry, 0 none.
All priorities in the queue must span less than one lap. Popped entries are reused.

The functions compile into the searches that use them.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from navette.files.kernels import kernel

USED, FREE, WAITING, NEXT = 0, 1, 2, 3
_NEXT = 0x7FFFFFFF
_MAX_BUCKETS = 1 << 13


class BucketQueue(NamedTuple):
    """The queue without its pool, which :func:`reserve` may replace.

    Attributes:
        heads: first entry of each bucket; the number of buckets is a power of two.
        state: entries ever used, first reusable entry, items waiting, and the item
            that is popped next if it is known (−1: it is not).
        shift: a bucket spans 2**shift units of priority.
    """

    heads: NDArray[np.int32]
    state: NDArray[np.int64]
    shift: int

    @classmethod
    def empty(cls, buckets: int, shift: int) -> "BucketQueue":
        """Return a queue without entries; entry 0 means "none" and is never used."""
        state = np.array([1, 0, 0, -1], np.int64)
        return cls(np.zeros(buckets, np.int32), state, shift)

    @classmethod
    def spanning(cls, span: int) -> "BucketQueue":
        """Return an empty queue for priorities that span up to ``span``.

        2⁹ units are a twentieth of a straight step: measured best of 2⁸ … 2¹².
        """
        shift = 9
        while (span >> shift) + 3 > _MAX_BUCKETS:
            shift += 1
        return cls.empty(1 << int((span >> shift) + 2).bit_length(), shift)


def new_pool() -> NDArray[np.int64]:
    """Return a pool for :func:`reserve` to grow; keep it between searches."""
    return np.zeros(1 << 12, np.int64)


@kernel(forceinline=True)
def reserve(pool: Any, queue: Any, pushes: int) -> Any:
    """Return the pool, or a larger copy, with room for ``pushes`` more."""
    if queue.state[USED] + pushes <= pool.size:
        return pool
    larger = np.empty(2 * pool.size + pushes, np.int64)
    for i in range(pool.size):  # a slice would take a second to compile
        larger[i] = pool[i]
    return larger


@kernel(allocates=False, forceinline=True)
def has_room(pool: Any, queue: Any, pushes: int) -> bool:
    """Return whether the pool has room for ``pushes`` more."""
    return bool(queue.state[USED] + pushes <= pool.size)


@kernel(allocates=False, forceinline=True)
def push(pool: Any, queue: Any, bucket: int, item: int) -> None:
    """Add ``item`` (31 bits) to the bucket; call :func:`reserve` before."""
    heads, state = queue.heads, queue.state
    slot = state[FREE]
    if slot != 0:
        state[FREE] = pool[np.uint64(slot)] & _NEXT
    else:
        slot = state[USED]
        state[USED] = slot + 1
    at = np.uint64(bucket & (heads.size - 1))
    pool[np.uint64(slot)] = (item << 32) | heads[at]
    heads[at] = slot
    state[WAITING] += 1


@kernel(allocates=False, forceinline=True)
def push_next(pool: Any, queue: Any, bucket: int, item: int) -> None:
    """Add ``item`` to the bucket that is being popped: it is popped next.

    It stays out of the bucket until another one follows, and often never enters it.
    """
    state = queue.state
    before = state[NEXT]
    state[NEXT] = item
    if before >= 0:
        push(pool, queue, bucket, before)
    else:
        state[WAITING] += 1


@kernel(allocates=False, forceinline=True)
def pop(pool: Any, queue: Any, bucket: int) -> int:
    """Remove and return the newest item of the bucket, or −1 if it is empty."""
    heads, state = queue.heads, queue.state
    item = state[NEXT]
    if item >= 0:
        state[NEXT] = -1
        state[WAITING] -= 1
        return int(item)
    at = np.uint64(bucket & (heads.size - 1))
    slot = heads[at]
    if slot == 0:
        return -1
    entry = pool[np.uint64(slot)]
    heads[at] = entry & _NEXT
    pool[np.uint64(slot)] = state[FREE]
    state[FREE] = slot
    state[WAITING] -= 1
    return int(entry >> 32)
