"""Options of the live view; verbs that run the simulator have them."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated

from navette.cli.options import Option

if TYPE_CHECKING:
    from navette.navigation.stack import RunOptions

PANEL = "Live view"


@dataclass(frozen=True, kw_only=True)
class ViewOptions:
    """Address of the live view, and who may connect."""

    port: Annotated[
        int,
        Option(
            min=0,
            max=65535,
            metavar="PORT",
            help="Port of the live view; 0 selects a free port.",
            panel=PANEL,
        ),
    ] = 8765
    host: Annotated[
        str,
        Option(
            metavar="ADDRESS",
            help="Address of the live view. 0.0.0.0 lets other machines connect; they"
            " need the token, and the keys of NAVETTE_SECURITY encrypt the connection.",
            panel=PANEL,
        ),
    ] = "127.0.0.1"
    unencrypted: Annotated[
        bool,
        Option(
            "--unencrypted",
            help="With --host: connect other machines without encryption.",
            panel=PANEL,
        ),
    ] = False
    origin: Annotated[
        list[str] | None,
        Option(
            "--origin",
            metavar="ORIGIN",
            help="Also accept web pages of this origin, such as file:// for the"
            " Foxglove desktop app. Repeat for several.",
            panel=PANEL,
        ),
    ] = None
    share: Annotated[
        bool,
        Option(
            "--share",
            help="Open the run to all programs of this machine, or of the network that"
            " ROS_DOMAIN_ID and NAVETTE_ROUTER select. Default: only your own programs"
            " can join.",
            panel=PANEL,
        ),
    ] = False

    def applied_to(self, run: "RunOptions") -> "RunOptions":
        """Return the options of a run with these."""
        return replace(
            run,
            port=self.port,
            host=self.host,
            unencrypted=self.unencrypted,
            origins=tuple(self.origin or ()),
            share=self.share,
        )


DEFAULT_VIEW = ViewOptions()
