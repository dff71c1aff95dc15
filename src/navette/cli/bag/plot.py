"""``navette bag plot``: fields of a recording as a picture."""

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
        help="/odom.twist.twist.linear.x: over time; /odom.pose.pose.position.x:y: y"
        " over x. Fields of one name share a panel; a quaternion is drawn as its yaw.",
    ),
]
Picture = Annotated[
    Path | None,
    Option(
        "--output",
        "-o",
        metavar="FILE",
        help="A .png, .svg or .pdf; by default the recording's name with .png, here.",
    ),
]


def plot(bag: Bag, fields: Fields, output: Picture = None) -> None:
    r"""Draw fields of a recording: over time, or one over the other.

    Needs matplotlib: pip install 'navette\[plot]'.
    """
    from navette.bags import open_bag
    from navette.cli.bag.drawing import draw
    from navette.cli.bag.series import Wanted, read_series

    wanted = [Wanted.read(text) for text in fields]
    path = output or Path(f"{bag.name.partition('.')[0] or 'recording'}.png")
    with open_bag(bag) as reader:
        series = read_series(reader, wanted, lambda damage: note(f"left out: {damage}"))
    draw(series, bag.name, path)
    points = sum(len(each.x) for each in series)
    show(f"{path}: {len(series)} line{'s' * (len(series) > 1)}, {points} points")
