"""The order of the open list."""

import numpy as np

from navette.navigation.planning.bucket_queue import (
    NEXT,
    WAITING,
    BucketQueue,
    new_pool,
    pop,
    push,
    push_next,
)


def test_an_item_pushed_next_pops_like_the_newest_of_its_bucket() -> None:
    rng = np.random.default_rng(2)
    plain, next_first = BucketQueue.empty(16, 0), BucketQueue.empty(16, 0)
    pools = new_pool(), new_pool()
    bucket = 0
    for item in range(2000):
        at = bucket + int(rng.integers(3))
        push(pools[0], plain, at, item)
        add = push_next if at == bucket else push
        add(pools[1], next_first, at, item)
        for _ in range(int(rng.integers(3))):
            popped = pop(pools[0], plain, bucket)
            assert pop(pools[1], next_first, bucket) == popped
            assert next_first.state[WAITING] == plain.state[WAITING]
            if popped < 0:
                bucket += 1
    assert plain.state[NEXT] == -1
