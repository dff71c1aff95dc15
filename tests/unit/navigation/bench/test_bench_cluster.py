"""Trials on a Dask cluster: a scheduler and two workers in processes of their own."""

import dataclasses
import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from distributed import Client

from free_ports import free_port
from navette.errors import NetworkError
from navette.navigation.bench.runner import run_trials
from navette.navigation.bench.trial import Trial, TrialResult

pytestmark = pytest.mark.long

WORKERS = 2
TRIALS = [
    Trial(
        suite="empty", name=f"e{seed}", world="empty", robot="jackal", seed=seed,
        goals=((2.0, 0.0),), limit_s=20.0, shortest_m=2.0,
    )
    for seed in range(4)
]  # fmt: skip


@dataclasses.dataclass
class Cluster:
    address: str
    workers: list[subprocess.Popen[bytes]]


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    """Start the cluster on the loopback; end it afterwards."""
    address = f"tcp://127.0.0.1:{free_port()}"
    scheduler = ["dask_scheduler", "--host", address, "--no-dashboard"]
    worker = [
        *("dask_worker", address, "--nthreads", "1", "--no-nanny", "--no-dashboard"),
        *("--host", "127.0.0.1", "--local-directory", str(tmp_path)),
    ]
    with ExitStack() as stack:
        started = []
        for command in (scheduler, *[worker] * WORKERS):
            process = subprocess.Popen(
                [sys.executable, "-m", f"distributed.cli.{command[0]}", *command[1:]],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                cwd=tmp_path,
            )
            stack.callback(process.wait)
            stack.callback(process.kill)
            started.append(process)
        with Client(address, timeout=60, set_as_default=False) as client:
            client.wait_for_workers(WORKERS, timeout=60)
        yield Cluster(address, started[1:])


def measured(result: TrialResult) -> dict[str, object]:
    """Return the result without the measured times of the machine."""
    values = dataclasses.asdict(result)
    del values["wall_s"], values["cpu_s"]
    return values


@pytest.mark.slow
def test_the_workers_results_are_those_of_this_process(
    cluster: Cluster, tmp_path: Path
) -> None:
    file = tmp_path / "results.jsonl"
    away = list(run_trials(TRIALS, jobs=1, results_file=file, cluster=cluster.address))
    here = {each.name: measured(each) for each in run_trials(TRIALS, jobs=1)}
    assert {each.name: measured(each) for each in away} == here
    rows = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    assert sorted(row["name"] for row in rows) == sorted(here)


@pytest.mark.slow
def test_trials_of_a_lost_worker_run_on_another(cluster: Cluster) -> None:
    found = []
    for result in run_trials(TRIALS, jobs=1, cluster=cluster.address):
        if not found:
            cluster.workers[0].kill()
        found.append(result.name)
    assert sorted(found) == [each.name for each in TRIALS]


def test_an_address_without_a_scheduler_is_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("navette.navigation.bench.cluster._CONNECT_S", 0.2)
    address = f"tcp://127.0.0.1:{free_port()}"
    with pytest.raises(NetworkError, match=rf"no Dask scheduler at '{address}'"):
        list(run_trials(TRIALS, jobs=1, cluster=address))
