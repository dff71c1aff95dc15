"""Name resolution."""

from hypothesis import given
from hypothesis import strategies as st

from navette.runtime.names import (
    NodeRemapper,
    RemapRule,
    expand_topic_name,
    validate_full_topic_name,
)

token = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True)
tokens = st.lists(token, min_size=1, max_size=3).map("/".join)
namespace = st.one_of(st.just("/"), tokens.map(lambda name: f"/{name}"))
topic = st.one_of(
    tokens,
    tokens.map(lambda name: f"/{name}"),
    tokens.map(lambda name: f"~/{name}"),
)


@given(topic, token, namespace)
def test_expansion_is_idempotent(name: str, node: str, ns: str) -> None:
    full = expand_topic_name(name, node, ns)
    assert validate_full_topic_name(full)
    assert expand_topic_name(full, node, ns) == full


@given(tokens, token, namespace)
def test_the_three_kinds_of_names(name: str, node: str, ns: str) -> None:
    prefix = ns.rstrip("/")
    assert expand_topic_name(f"/{name}", node, ns) == f"/{name}"
    assert expand_topic_name(name, node, ns) == f"{prefix}/{name}"
    assert expand_topic_name(f"~/{name}", node, ns) == f"{prefix}/{node}/{name}"


@given(topic, topic, topic, token, namespace)
def test_a_rule_changes_its_name_only(
    match: str, replacement: str, name: str, node: str, ns: str
) -> None:
    remapper = NodeRemapper([RemapRule.parse(f"{match}:={replacement}")], node, ns)
    concerned = expand_topic_name(name, node, ns) == expand_topic_name(match, node, ns)
    wanted = replacement if concerned else name
    assert remapper.resolve(name) == expand_topic_name(wanted, node, ns)
