"""The verbs of ``navette bag``."""

from navette.cli.bag import edit_verbs, look_verbs
from navette.cli.bag.play import play
from navette.cli.bag.plot import plot
from navette.cli.bag.record import record
from navette.cli.bag.replay import replay
from navette.cli.commands import Group

bag = Group(
    name="bag",
    help="Record, play, inspect, repair and edit recordings (.mcap, .bag, .db3).",
)
bag.command()(record)
bag.command()(play)
bag.command()(replay)
bag.command()(look_verbs.info)
bag.command("list")(look_verbs.list_)
bag.command()(look_verbs.check)
bag.command()(edit_verbs.recover)
bag.command()(edit_verbs.convert)
bag.command("filter")(edit_verbs.filter_)
bag.command()(edit_verbs.cut)
bag.command()(edit_verbs.merge)
bag.command()(plot)
