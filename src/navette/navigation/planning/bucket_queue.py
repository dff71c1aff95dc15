"""An open list for integer priorities: a circle of buckets (Dial 1969).

A bucket is a last-in-first-out list threaded through one pool of int64 entries,
``item << 32 | next``; ``heads[priority >> shift & lap]`` is its first entry, 0 none.
All priorities waiting at a time must span less than one lap. Popped entries are
reused. ``state`` holds (entries ever used, first reusable entry, entries waiting).

The functions compile into the searches that use them.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

USED, FREE, WAITING = 0, 1, 2
_NEXT = 0x7FFFFFFF
_MAX_BUCKETS = 1 << 13


def layout(
    span: int, *, shift: int = 10, max_buckets: int = 1 << 13
) -> tuple[int, int]:
    """(shift, number of buckets) for priorities that span up to ``span``.

    2¹⁰ units are a tenth of a straight step: measured best of 2¹⁰ … 2¹⁴.
    """
    shift = 10
    while (span >> shift) + 3 > _MAX_BUCKETS:
        shift += 1
    return shift, 1 << int((span >> shift) + 2).bit_length()


def new_pool() -> NDArray[np.int64]:
    """A pool for :func:`reserve` to grow; worth keeping between searches."""
    return np.zeros(1 << 12, np.int64)


def new_state() -> NDArray[np.int64]:
    """State of an empty queue; entry 0 means "none" and is never used."""
    return np.array([1, 0, 0], np.int64)


@njit(cache=True, forceinline=True)
def reserve(pool: Any, state: Any, pushes: int) -> Any:
    """The pool, or a larger copy, with room for ``pushes`` more."""
    if state[USED] + pushes <= pool.size:
        return pool
    larger = np.empty(2 * pool.size + pushes, np.int64)
    for i in range(pool.size):  # a slice would take a second to compile
        larger[i] = pool[i]
    return larger


@njit(cache=True, forceinline=True)
def push(pool: Any, heads: Any, state: Any, bucket: int, item: int) -> None:
    """Add ``item`` (31 bits) to the bucket; :func:`reserve` comes first."""
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


@njit(cache=True, forceinline=True)
def pop(pool: Any, heads: Any, state: Any, bucket: int) -> Any:
    """The newest item of the bucket, or −1 when it is empty."""
    at = np.uint64(bucket & (heads.size - 1))
    slot = heads[at]
    if slot == 0:
        return np.int64(-1)
    entry = pool[np.uint64(slot)]
    heads[at] = entry & _NEXT
    pool[np.uint64(slot)] = state[FREE]
    state[FREE] = slot
    state[WAITING] -= 1
    return entry >> 32
