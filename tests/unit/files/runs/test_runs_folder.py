"""Folders of runs: those of another user are passed over."""

from pathlib import Path

import pytest

from navette.files.runs import live_runs
from navette.files.runs.folder import existing_folders, runtime_folder

VARIABLES = ("NAVETTE_RUNTIME_DIR", "XDG_RUNTIME_DIR")


@pytest.mark.parametrize("variable", VARIABLES)
def test_a_folder_within_another_users_is_passed_over(
    variable: str, runtime: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """``su`` keeps XDG_RUNTIME_DIR, whose content the new user cannot look at."""
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    closed = runtime / "closed"
    monkeypatch.setenv(variable, str(closed / "user"))
    stat, lstat = Path.stat, Path.lstat

    def refuse(path: Path) -> None:
        if closed in path.parents:
            raise PermissionError(13, "Permission denied", str(path))

    def stat_or_refuse(self: Path, *, follow_symlinks: bool = True) -> object:
        refuse(self)
        return stat(self, follow_symlinks=follow_symlinks)

    def lstat_or_refuse(self: Path) -> object:
        refuse(self)
        return lstat(self)

    monkeypatch.setattr(Path, "stat", stat_or_refuse)
    monkeypatch.setattr(Path, "lstat", lstat_or_refuse)
    assert not any(closed in folder.parents for folder in existing_folders())
    assert isinstance(live_runs(), list)
    if variable == "XDG_RUNTIME_DIR":
        assert closed not in runtime_folder(40).parents
