"""Trials on a Dask cluster."""

import threading
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from navette.errors import MissingPartError, NetworkError
from navette.navigation.bench.trial import Trial, TrialResult

if TYPE_CHECKING:
    from navette.navigation.bench.run import NodeLoader

_CONNECT_S = 10.0

_one_at_a_time = threading.Lock()


def run_on_cluster(
    trials: Sequence[Trial], address: str, load_nodes: "NodeLoader | None"
) -> Iterator[tuple[Trial, TrialResult]]:
    """Yield each trial with its result, as the workers finish.

    Workers have this version of Navette, and the files of worlds, robots and methods at
    the same paths. A lost worker's trials are run again by others.

    Raises:
        MissingPartError: Dask is not installed.
        NetworkError: no scheduler at the address, or it has no workers.
        NavetteError: invalid world, robot or parameter of a trial.
    """
    try:
        from distributed import Client, as_completed
    except ImportError:
        raise MissingPartError.of("--dask", "distributed", "cluster") from None
    try:
        client = Client(address, timeout=_CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise NetworkError(
            f"no Dask scheduler at {address!r} ({error}); start one: dask scheduler"
        ) from error
    with client:
        if not client.scheduler_info(n_workers=-1)["workers"]:
            raise NetworkError(
                f"the Dask scheduler at {address!r} has no workers; start some with: "
                f"dask worker {address}"
            )
        # Not pure: equal trials are different runs for the measured times.
        futures = {
            client.submit(_run_alone, each, load_nodes, pure=False): each
            for each in trials
        }
        try:
            finished: Any = as_completed(futures, loop=client.loop)
            for future in finished:
                yield futures[future], future.result()
        finally:
            client.cancel(list(futures), force=True)


def _run_alone(trial: Trial, load_nodes: "NodeLoader | None") -> TrialResult:
    """Run a trial; one at a time in a worker of several threads."""
    from navette.navigation.bench.run import run_trial

    with _one_at_a_time:
        return run_trial(trial, load_nodes)
