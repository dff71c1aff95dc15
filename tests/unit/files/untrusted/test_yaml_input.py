"""YAML within a budget: whatever the text, the answer is a value or a YAMLError."""

import pytest
import yaml

from navette.files.untrusted import Budget
from navette.files.untrusted.yaml_input import (
    BoundedLoader,
    line_of,
    load_yaml,
    problem_of,
)


class Small(BoundedLoader):
    BUDGET = Budget(octets=100, items=10, depth=4, word=20)


def repeated(kind: str) -> str:
    """Thirty lists (or mappings), each of which holds the one above it twice."""
    lines = ["a0: &a0 {x: 1}"]
    for i in range(1, 31):
        twice = f"[*a{i - 1}, *a{i - 1}]"
        inside = twice if kind == "list" else f"{{<<: {twice}}}"
        lines.append(f"a{i}: &a{i} {inside}")
    return "\n".join(lines)


def test_values_are_those_of_yaml() -> None:
    text = "a: [1, 2.5, {b: c}]\nd: &x {q: 1}\ne: *x\nf: {<<: *x, z: 2}\ng: 2001-01-02"
    assert load_yaml(text) == yaml.safe_load(text)
    assert load_yaml("") is None


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        # libyaml 0.2.6 and newer refuses this itself while it looks for a key
        ("[" * 60_000, "nest"),
        ("- " * 60_000, "nested deeper than 64"),
        ("? " * 60_000, "nested deeper than 64"),
        ("{a: " * 60_000, "nested deeper than 64"),
        ("\n".join(" " * i + "a:" for i in range(2000)), "nested deeper than 64"),
        (repeated("list"), "more than 100000 items"),
        (repeated("merge"), "more than 100000 items"),
        ("&a [*a]", "contains itself"),
        ("- a\n" * 250_000, "more than 100000 items"),
        (" " * (5 << 20), "5242880 bytes"),
        ("1" * 5000, "a number of 5000 characters"),
        ("1" + ":1" * 100_000, "a number of 200001 characters"),
        ("2001-99-99", "month must be in"),
        ("!!int abc", "invalid literal"),
        ("!!python/object:os.system x", "could not determine a constructor"),
        ("{[1]: 2}", "unhashable key"),
        ("a\0b", "control characters"),
        ("'\ud800'", "invalid text"),
        (b"\xff\xfe\x00", "unacceptable character"),
    ],
)
def test_hostile_text_is_an_error_of_yaml(text: str | bytes, problem: str) -> None:
    with pytest.raises(yaml.YAMLError) as caught:
        load_yaml(text)
    assert problem in problem_of(caught.value)


def test_errors_have_the_line() -> None:
    with pytest.raises(yaml.YAMLError) as caught:
        load_yaml("a: 1\nb: [[[[[2]]]]]", Small)
    assert line_of(caught.value) == 2


def test_a_derived_loader_has_its_own_budget() -> None:
    assert load_yaml("[[[1]]]", Small) == [[[1]]]
    for text in ("[[[[1]]]]", "[1,2,3,4,5,6,7,8,9,10]", "1" * 21, "a" * 101):
        with pytest.raises(yaml.YAMLError):
            load_yaml(text, Small)


def test_an_alias_counts_as_much_as_what_it_repeats() -> None:
    assert load_yaml("[&a [1, 2], *a]", Small) == [[1, 2], [1, 2]]
    with pytest.raises(yaml.YAMLError, match="more than 10 items"):
        load_yaml("[&a [1, 2], *a, *a, *a]", Small)
