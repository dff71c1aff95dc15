"""Ends of messages about unknown names: similar names, or all of them."""

import pytest

from navette.errors import instead_of

MANY = ["max_speed_mps", "max_side_speed_mps", *(f"other_{i}" for i in range(40))]


@pytest.mark.parametrize(
    ("name", "known", "end"),
    [
        ("max_sped_mps", MANY, "; did you mean 'max_speed_mps'? (all 42: HERE)"),
        ("othr_1", MANY, "; did you mean 'other_1'? (all 42: HERE)"),
        ("raet", ["rate", "a"], "; did you mean 'rate'?; known: a, rate"),
        ("xyz", ["b", "a"], "; known: a, b"),
        ("xyz", [], "; known: none"),
    ],
)
def test_similar_names_are_listed_or_all(name: str, known: list[str], end: str) -> None:
    assert instead_of(name, known, see_all="HERE") == end


def test_all_names_are_listed_without_a_similar_one() -> None:
    assert instead_of("xyz", MANY, see_all="HERE").count(", ") == len(MANY) - 1
