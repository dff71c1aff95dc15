"""``navette tree``: the live behaviour tree, and tree files."""

from pathlib import Path
from typing import Annotated

from navette.cli.options import Argument, Option

_PAINT = {"[✓]": "green", "[✕]": "red", "[*]": "bold blue", "[-]": "dim"}


def tree(
    file: Annotated[
        Path | None,
        Argument(metavar="FILE.xml", help="Check and print this file instead."),
    ] = None,
    once: Annotated[
        bool, Option("--once", help="Print the present tree and exit.")
    ] = False,
    default: Annotated[
        bool, Option("--default", help="Print the file of Navette's default tree.")
    ] = False,
    nodes: Annotated[
        bool, Option("--nodes", help="List the kinds of nodes and their ports.")
    ] = False,
    timeout: Annotated[
        float, Option(metavar="S", min=0.0, help="How long --once waits for a tree.")
    ] = 5.0,
) -> None:
    """Watch the behaviour tree of the running robot, or check a tree file.

    Signs: * running, ✓ succeeded, ✕ failed, - not ticked since the start.
    """
    if nodes:
        _list_nodes()
    elif default:
        from navette.cli.output import show
        from navette.navigation.missions.params import MissionParams

        show(MissionParams().to_pose_tree.read_text(encoding="utf-8"))
    elif file is not None:
        _check(file)
    else:
        _watch(timeout if once else None)


def _list_nodes() -> None:
    from navette.cli.output import show
    from navette.navigation.missions.tree.catalog import KINDS
    from navette.navigation.missions.tree.ports import KINDS as PORT_KINDS

    lines = []
    for tag, kind in KINDS.items():
        lines.append(f"{tag}: {(kind.__doc__ or '').splitlines()[0]}")
        for name, port in kind.PORTS.items():
            what = "output" if port.output else PORT_KINDS[port.parse]
            given = "required" if port.required else ""
            if port.default is not None:
                given = f"default {port.default!r}"
            lines.append(f"    {name}: {what}" + (f" ({given})" if given else ""))
    show("\n".join(lines))


def _check(file: Path) -> None:
    from navette.cli.output import show
    from navette.navigation.missions.params import tree_path
    from navette.navigation.missions.tree.drawing import file_text

    show(file_text(tree_path(str(file))))


def _watch(once_s: float | None) -> None:
    """Print the tree whenever it changes; with a time, print it once."""
    from navette.cli.output import is_terminal, show, show_over
    from navette.cli.session import connect, fail, wait_for
    from navette.msgs import topics
    from navette.msgs.std_msgs.msg import String
    from navette.runtime import DurabilityPolicy, QoSProfile

    topic = topics.BEHAVIOR_TREE
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with connect() as node:
        seen: list[str] = []

        def receive(message: String) -> None:
            seen.append(message.data)
            text = painted(message.data) if is_terminal() else message.data
            if once_s is None:
                show_over(text, clear=True)
            else:
                show(text)

        node.create_subscription(String, topic.name, receive, latched)
        if once_s is None:
            note_waiting = node.create_timer(2.0, lambda: _note_waiting(seen))
            wait_for(node, lambda: False)
            node.destroy_timer(note_waiting)
        elif not wait_for(node, lambda: bool(seen), once_s):
            fail(
                f"no tree on {topic.name} in {once_s:g} s: a tree appears with the "
                "first goal; is a robot with missions running?"
            )


def _note_waiting(seen: list[str]) -> None:
    from navette.cli.stderr import note

    if not seen:
        seen.append("")
        note("waiting for a tree: it appears with the first goal")


def painted(text: str) -> str:
    """Return the tree with coloured signs."""
    from rich.console import Console
    from rich.text import Text

    from navette.files.untrusted.escaping import escaped

    text = escaped(text)  # rich removes some control characters, which moves the signs
    styled = Text(text)
    for sign, style in _PAINT.items():
        start = text.find(sign)
        while start >= 0:
            styled.stylize(style, start, start + len(sign))
            start = text.find(sign, start + 1)
    console = Console(highlight=False, force_terminal=True)
    with console.capture() as capture:
        console.print(styled, end="", soft_wrap=True)
    return capture.get()
