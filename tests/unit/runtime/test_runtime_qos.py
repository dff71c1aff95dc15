"""QoS profiles."""

import pytest

from navette.runtime import (
    DurabilityPolicy,
    Duration,
    HistoryPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
    qos_profile_system_default,
)
from navette.runtime.qos import (
    InvalidQoSProfileException,
    as_profile,
    qos_policy_name_from_kind,
)
from navette.transports import INFINITE_NS, QoSPolicyKind


def test_defaults() -> None:
    profile = QoSProfile(depth=3)
    assert profile.history is HistoryPolicy.KEEP_LAST
    assert profile.reliability is ReliabilityPolicy.RELIABLE
    assert profile.durability is DurabilityPolicy.VOLATILE
    assert as_profile(3) == profile
    assert as_profile(profile) is profile


@pytest.mark.parametrize(
    "arguments", [{}, {"history": HistoryPolicy.KEEP_LAST}, {"depth": -1}]
)
def test_incomplete_profiles(arguments: dict[str, int]) -> None:
    with pytest.raises(InvalidQoSProfileException):
        QoSProfile(**arguments)  # type: ignore[arg-type]


def test_plain_numbers_become_policies() -> None:
    profile = QoSProfile(history=2, reliability=2, durability=1)
    assert profile.history is HistoryPolicy.KEEP_ALL
    assert profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert profile.durability is DurabilityPolicy.TRANSIENT_LOCAL


def test_presets() -> None:
    assert qos_profile_sensor_data == QoSPresetProfiles.SENSOR_DATA.value
    assert QoSPresetProfiles.get_from_short_key("system_default") == (
        qos_profile_system_default
    )
    assert "services_default" in QoSPresetProfiles.short_keys()


def test_equality_hash_and_text() -> None:
    profile = QoSProfile(depth=3, deadline=Duration(seconds=1))
    assert profile == QoSProfile(depth=3, deadline=Duration(seconds=1))
    assert profile != QoSProfile(depth=3)
    assert profile != 3
    assert len({profile, QoSProfile(depth=3, deadline=Duration(seconds=1))}) == 1
    assert "reliability=RELIABLE" in str(profile)


def test_conversion_to_the_transports_qos_and_back() -> None:
    profile = QoSProfile(depth=3, deadline=Duration(seconds=1))
    endpoint = profile.to_endpoint_qos()
    assert (endpoint.deadline_ns, endpoint.lifespan_ns) == (1_000_000_000, INFINITE_NS)
    back = QoSProfile.from_endpoint_qos(endpoint)
    assert back.to_endpoint_qos() == endpoint


def test_policy_names() -> None:
    assert qos_policy_name_from_kind(QoSPolicyKind.DURABILITY) == "DURABILITY"
    assert qos_policy_name_from_kind(16) == "RELIABILITY"
