"""Generated worlds by kind and seed, and those of DynaBARN's file."""

from navette.errors import InvalidValueError, UnknownNameError
from navette.navigation.worlds import dynabarn, moving_worlds
from navette.navigation.worlds.generators import GENERATORS, generate
from navette.sim import Scene, world_names

KINDS = (*GENERATORS, moving_worlds.KIND)
"""Kinds of generated worlds."""

KNOWN = (*world_names(), *(f"{kind}:SEED" for kind in KINDS))
"""Names of worlds, for error messages."""


def generated_scene(world: str) -> Scene:
    """Return the world ``KIND:SEED``, or ``dynabarn:FILE:NUMBER``.

    Raises:
        UnknownNameError: unknown kind; the text lists the known ones.
        InvalidValueError: a seed that is not a whole number from 0 on.
        FileFormatError: invalid file.
    """
    if world.startswith(dynabarn.PREFIX):
        return dynabarn.dynabarn_scene(world)
    kind, _, seed = world.partition(":")
    if kind not in KINDS:
        raise UnknownNameError.of("world or file", world, list(KNOWN))
    if not seed.isdecimal():
        raise InvalidValueError(
            f"world {world!r}: expected a seed of 0 or more, as {kind}:7"
        )
    if kind == moving_worlds.KIND:
        return moving_worlds.moving_scene(int(seed))
    return generate(kind, int(seed)).scene
