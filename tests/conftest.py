"""Settings shared by all tests."""

import logging
import os
import tempfile
from collections.abc import Generator, Iterator

import pytest
from hypothesis import settings

# Examples are drawn from a fixed seed, so that a run repeats; no deadline, because
# the first call of a kernel may compile it.
settings.register_profile("navette", deadline=None, derandomize=True)
settings.load_profile("navette")

# Tests run side by side and must not meet; those of the network say so themselves, and
# have a router of their own.
os.environ["NAVETTE_TRANSPORT"] = "inprocess"

# No test joins a run of this machine, or shows itself to one.
_runtime = tempfile.TemporaryDirectory(prefix="nv-", ignore_cleanup_errors=True)
os.environ["NAVETTE_RUNTIME_DIR"] = _runtime.name


@pytest.fixture(autouse=True)
def logs_end_with_their_test() -> Iterator[None]:
    """A context that a test leaves open writes nothing into the next one's output."""
    package = logging.getLogger("navette")
    handlers, level = package.handlers[:], package.level
    yield
    package.handlers[:] = [each for each in package.handlers if each in handlers]
    package.setLevel(level)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """With NAVETTE_REQUIRE_ALL set (as in .ci/run), a skipped test fails.

    Except for tests that need permissions which the machine does not grant, such as
    network namespaces.
    """
    report = yield
    installable = "not permitted here" not in str(report.longrepr)
    if report.skipped and installable and os.environ.get("NAVETTE_REQUIRE_ALL"):
        report.outcome = "failed"
        report.longrepr = f"skipped with NAVETTE_REQUIRE_ALL set: {report.longrepr}"
    return report
