"""The official MCAP conformance set: read identically, and copied record by record."""

from pathlib import Path

from mcap_set import run
from mcap_variants import names, variant


def test_every_file_of_the_set_is_read_and_copied(tmp_path: Path) -> None:
    for name in names():
        (tmp_path / f"{name}.mcap").write_bytes(variant(name))
    counts, faults = run(tmp_path)
    assert faults == []
    assert counts["files"] == counts["files without a difference"] == 416
    assert counts["messages"] == 1768
    assert counts["copies"] == 4 * 416
