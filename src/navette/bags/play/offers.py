"""QoS of the player's publishers, from the recorded QoS."""

from navette.bags.bag import BagTopic
from navette.bags.play.latched import is_latched, latched_depth
from navette.bags.qos import OfferedQos

_DEPTH = 10


def joint_offer(topic: BagTopic) -> OfferedQos:
    """Return a QoS compatible with all subscribers of the recorded publishers.

    Of different publishers, the strongest of each policy is used. Lifespan and
    liveliness are dropped, since a paused bag violates them. The depth of latched
    messages is bounded.
    """
    offers = topic.qos
    best_effort = bool(offers) and all(q.reliability == "best_effort" for q in offers)
    latched = is_latched(topic)
    keep_all = not latched and any(q.history == "keep_all" for q in offers)
    depth = max((q.depth for q in offers), default=0) or _DEPTH
    deadlines = {q.deadline_ns for q in offers}
    return OfferedQos(
        history="keep_all" if keep_all else "keep_last",
        depth=latched_depth(topic) if latched else depth,
        reliability="best_effort" if best_effort else "reliable",
        durability="transient_local" if latched else "volatile",
        deadline_ns=max(deadlines, default=OfferedQos.deadline_ns),
    )
