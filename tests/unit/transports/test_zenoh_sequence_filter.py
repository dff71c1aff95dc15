"""Sequence numbers of publishers: duplicates, gaps, and numbers that were forged."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from navette.transports.zenoh import sequence_filter
from navette.transports.zenoh.sequence_filter import (
    FAR_AHEAD,
    FAR_BEHIND,
    SequenceFilter,
)

GID = b"publisher"


def accepted(*sequences: int, start: SequenceFilter | None = None) -> list[int | None]:
    chosen = start or SequenceFilter(())
    return [chosen.accept(GID, sequence) for sequence in sequences]


def test_samples_in_order_are_delivered() -> None:
    assert accepted(7, 8, 9) == [0, 0, 0]


def test_duplicate_and_late_samples_are_dropped() -> None:
    assert accepted(4, 5, 5, 4, 6, 2) == [0, 0, None, None, 0, None]


def test_missing_samples_are_counted_when_the_next_one_arrives() -> None:
    assert accepted(1, 4, 5, 7) == [0, 2, 0, 1]


@given(st.lists(st.integers(1, 200), min_size=1))
def test_delivered_and_missing_samples_add_up(sequences: list[int]) -> None:
    results = accepted(*sequences)
    delivered = [n for n, r in zip(sequences, results, strict=True) if r is not None]
    assert delivered == sorted(set(delivered))
    missing = sum(result for result in results if result is not None)
    assert missing + len(delivered) == delivered[-1] - delivered[0] + 1


@pytest.mark.parametrize("forged", [2**63 - 1, 2**62, FAR_AHEAD + 10])
def test_a_forged_number_does_not_block_the_publisher(forged: int) -> None:
    assert accepted(1, forged, 2, 3, forged, 4) == [0, 0, 0, 0, None, 0]


def test_two_outliers_in_a_row_are_of_a_publisher_that_restarted_its_numbers() -> None:
    behind = FAR_BEHIND + 5
    assert accepted(behind, 1, 1, 2, 3) == [0, 0, None, 0, 0]
    assert accepted(2**62, 1, 2, 3, 2**62 + 1, 4) == [0, 0, 0, 0, 0, 0]


def test_publishers_of_the_graph_are_forgotten_last(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(sequence_filter, "_MAX_PUBLISHERS", 3)
    known = SequenceFilter({GID})
    assert accepted(5, start=known) == [0]
    for number in range(10):
        known.accept(f"unlisted {number}".encode(), 1)
    assert accepted(5, 8, start=known) == [None, 2]
