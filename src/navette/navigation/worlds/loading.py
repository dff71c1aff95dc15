"""A world by name, by file, or generated from a kind and a seed."""

from pathlib import Path

from navette.errors import UnknownNameError
from navette.sim import Scene, load_world


def load_scene(world: str) -> Scene:
    """Return a world: a built-in name, a file, or ``KIND:SEED`` of a generated one.

    ``dynabarn:FILE:NUMBER`` is a world of DynaBARN's ``trajectories.json``.

    Raises:
        UnknownNameError: unknown name or kind; the text lists the known ones.
        InvalidValueError: a seed that is not a whole number from 0 on.
        FileFormatError: invalid file; names file and line.
    """
    # Imported only for these worlds: every stage's program loads a world.
    if ":" in world and not Path(world).is_file():
        from navette.navigation.worlds.generated import generated_scene

        return generated_scene(world)
    try:
        return load_world(world)
    except UnknownNameError:
        from navette.navigation.worlds.generated import KNOWN

        raise UnknownNameError.of("world or file", world, list(KNOWN)) from None
