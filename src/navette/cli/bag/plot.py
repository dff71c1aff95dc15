"""``navette bag plot``: plot fields of a recording."""

from pathlib import Path
from typing import Annotated

from navette.cli.bag.options import Bag
from navette.cli.options import Argument, Option
from navette.cli.output import show
from navette.cli.stderr import note

Fields = Annotated[
    list[str],
    Argument(
        metavar="TOPIC.FIELD...",
        help="/odom.twist.twist.linear.x plots over time, /odom.pose.pose.position.x:y"
        " plots y over x. Fields with the same name share a panel. A quaternion is"
        " plotted as its yaw.",
    ),
]
Picture = Annotated[
    Path | None,
    Option(
        "--output",
        "-o",
        metavar="FILE",
        help="File to write: .png, .svg or .pdf. Default: the recording's name with"
        " .png, in this folder.",
    ),
]


def plot(bag: Bag, fields: Fields, output: Picture = None) -> None:
    """Plot fields of a recording over time or over another field.

    Needs matplotlib: pip install matplotlib.
    """
    from navette.bags import open_bag
    from navette.cli.bag.drawing import draw
    from navette.cli.bag.series import PlotField, read_series

    selected = [PlotField.read(text) for text in fields]
    path = output or Path(f"{bag.name.partition('.')[0] or 'recording'}.png")
    with open_bag(bag) as reader:
        series = read_series(
            reader, selected, lambda damage: note(f"left out: {damage}")
        )
    draw(series, bag.name, path)
    points = sum(len(each.x) for each in series)
    show(f"{path}: {len(series)} line{'s' * (len(series) > 1)}, {points} points")
