"""Which offered QoS satisfies which request (DDS 1.4, 2.2.3)."""

import pytest

from navette.transports import (
    INFINITE_NS,
    DurabilityPolicy,
    EndpointQos,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    ReliabilityPolicy,
    incompatible_policies,
)

R, D, L = ReliabilityPolicy, DurabilityPolicy, LivelinessPolicy


@pytest.mark.parametrize(
    ("offered", "requested", "compatible"),
    [
        (R.RELIABLE, R.RELIABLE, True),
        (R.RELIABLE, R.BEST_EFFORT, True),
        (R.BEST_EFFORT, R.BEST_EFFORT, True),
        (R.BEST_EFFORT, R.RELIABLE, False),
        (R.BEST_EFFORT, R.BEST_AVAILABLE, True),
        (R.BEST_AVAILABLE, R.RELIABLE, True),
        (R.BEST_EFFORT, R.SYSTEM_DEFAULT, False),
        (R.SYSTEM_DEFAULT, R.RELIABLE, True),
    ],
)
def test_reliability(offered: R, requested: R, compatible: bool) -> None:
    found = incompatible_policies(
        EndpointQos(reliability=offered), EndpointQos(reliability=requested)
    )
    assert found == (() if compatible else (QoSPolicyKind.RELIABILITY,))


@pytest.mark.parametrize(
    ("offered", "requested", "compatible"),
    [
        (D.VOLATILE, D.VOLATILE, True),
        (D.TRANSIENT_LOCAL, D.VOLATILE, True),
        (D.TRANSIENT_LOCAL, D.TRANSIENT_LOCAL, True),
        (D.VOLATILE, D.TRANSIENT_LOCAL, False),
        (D.VOLATILE, D.BEST_AVAILABLE, True),
    ],
)
def test_durability(offered: D, requested: D, compatible: bool) -> None:
    found = incompatible_policies(
        EndpointQos(durability=offered), EndpointQos(durability=requested)
    )
    assert found == (() if compatible else (QoSPolicyKind.DURABILITY,))


def test_offered_durations_must_not_exceed_the_request() -> None:
    slow = EndpointQos(deadline_ns=20, lease_ns=20)
    fast = EndpointQos(deadline_ns=10, lease_ns=10)
    assert incompatible_policies(fast, slow) == ()
    assert incompatible_policies(slow, fast) == (
        QoSPolicyKind.DEADLINE,
        QoSPolicyKind.LIVELINESS_LEASE_DURATION,
    )


def test_automatic_liveliness_does_not_satisfy_manual() -> None:
    manual = EndpointQos(liveliness=L.MANUAL_BY_TOPIC)
    assert incompatible_policies(EndpointQos(), manual) == (QoSPolicyKind.LIVELINESS,)
    assert incompatible_policies(manual, EndpointQos()) == ()


def test_queue_length() -> None:
    assert EndpointQos(depth=3).queue_length == 3
    assert EndpointQos(depth=0).queue_length == 42
    assert EndpointQos(history=HistoryPolicy.KEEP_ALL).queue_length is None
    assert EndpointQos().deadline_ns == INFINITE_NS


def test_short_keys() -> None:
    assert "best_effort" in R.short_keys()
    assert R.get_from_short_key("best_effort") == R.BEST_EFFORT
    assert R.BEST_EFFORT.short_key == "best_effort"
