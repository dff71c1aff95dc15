"""Gymnasium environments: the simulator as a task for learning.

Importing the package registers them, as Gymnasium provides for (its releases from 1.0
look for no entry points)::

    import gymnasium
    import navette.gym

    gymnasium.make("navette/Navigation-v0", world="barn-like", robot="jackal")

Without the second import the id is ``navette.gym:navette/Navigation-v0``.
"""

from navette.errors import MissingPartError

try:
    import gymnasium
except ImportError:
    raise MissingPartError(
        "navette.gym requires Gymnasium: pip install 'navette[gym]'"
    ) from None

from navette.gym.environment import NavigationEnv
from navette.gym.observation import Observer
from navette.gym.params import NavigationEnvParams

__all__ = ["NavigationEnv", "NavigationEnvParams", "Observer"]

if "navette/Navigation-v0" not in gymnasium.registry:
    gymnasium.register(
        id="navette/Navigation-v0",
        entry_point="navette.gym.environment:NavigationEnv",
    )
