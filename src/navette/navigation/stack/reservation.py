"""What a run needs before its first node exists: a port, and a name of its own."""

import logging
import os
from dataclasses import dataclass, replace

from navette.errors import InvalidValueError, NetworkError, ParameterError
from navette.files.runs import PrivateRun, live_runs, named_run, shares
from navette.navigation.stack.options import RunOptions
from navette.runtime import ContextClock
from navette.runtime.network import (
    IN_PROCESS,
    chosen_transport,
    environment_domain,
)
from navette.runtime.overrides import ParameterOverrides
from navette.viewer.access import scheme_of
from navette.viewer.listening import Listeners, listen, port_of, url_of
from navette.viewer.params import ViewerParams

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Reservation:
    """Ports and name of a run.

    Attributes:
        transport: how the run's context communicates.
        run: the private run; None if the run is shared or stays in its process.
        listeners: sockets of the live view; empty without one.
    """

    transport: str
    run: PrivateRun | None = None
    listeners: Listeners = ()

    def close(self) -> None:
        """Release everything; a second call has no effect."""
        for listener in self.listeners:
            listener.close()
        if self.run is not None:
            self.run.close()


def reserve(
    options: RunOptions, overrides: ParameterOverrides, clock: ContextClock
) -> Reservation:
    """Take the port of the live view and, for a private run, a name.

    Raises:
        InvalidValueError: the port is in use, or the name.
    """
    transport = chosen_transport(None, clock)
    address = None if options.headless else _address(overrides)
    listeners = () if address is None else _listen(*address)
    reserved = Reservation(transport, None, listeners)
    if transport == IN_PROCESS or options.share or shares():
        return reserved
    try:
        run = PrivateRun.claim(
            options.verb,
            name=named_run(),
            world=options.world,
            domain=environment_domain(),
        )
        run.publish(_page(address[0], port_of(listeners)) if address else "")
    except NetworkError as error:
        _log.warning("other programs cannot join this run without --share: %s", error)
        return replace(reserved, transport=IN_PROCESS)
    except BaseException:
        reserved.close()
        raise
    return replace(reserved, run=run)


def _address(overrides: ParameterOverrides) -> tuple[str, int] | None:
    """Return host and port of the live view; None: its node will report an error."""
    given = overrides.for_node("/viewer")
    values = {key: given[key].value for key in ("host", "port") if key in given}
    try:
        params = ViewerParams(**values)
    except ParameterError:
        return None
    return params.host, params.port


def _page(host: str, port: int) -> str:
    return url_of(host, port, scheme_of(host, os.environ))


def _listen(host: str, port: int) -> Listeners:
    try:
        return listen(host, port)
    except InvalidValueError as error:
        for run in live_runs():
            if run.page and run.page == _page(host, port):
                raise InvalidValueError(
                    f"port {port} is in use by run {run.name!r} ({run.command}, pid "
                    f"{run.pid}); end that run, or choose another port: --port 0 takes "
                    "a free one"
                ) from error
        raise
