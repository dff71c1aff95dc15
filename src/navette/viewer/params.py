"""Parameters of the live view."""

from dataclasses import dataclass

from navette.params import Params, param

# The Foxglove app in a browser, and in its desktop shell.
_FOXGLOVE = ("https://app.foxglove.dev", "https://studio.foxglove.dev", "file://")


@dataclass(frozen=True, kw_only=True)
class ViewerParams(Params):
    """Where the live view listens, and who may use it."""

    host: str = param("127.0.0.1", "address to listen on; 0.0.0.0 is every network")
    port: int = param(
        8765, "TCP port to listen on; 0 takes a free one", at_least=0, at_most=65535
    )
    map_frame: str = param(
        "", "frame that the bundled layout shows; empty takes the other nodes' own"
    )
    base_frame: str = param(
        "", "frame that the layout follows; empty takes the other nodes' own"
    )
    max_clients: int = param(
        32, "clients at the same time; more are refused", at_least=1
    )
    time_rate_hz: float = param(
        20.0, "how often clients are told the time", unit="Hz", above=0.0, at_most=100.0
    )
    allowed_origins: tuple[str, ...] = param(
        _FOXGLOVE,
        "web origins that may open the socket, beside local ones; '*' allows all",
    )
    allowed_hosts: tuple[str, ...] = param(
        (), "names under which the server may be addressed, beside local ones"
    )
