"""Gymnasium environments: the simulator as a task for learning.

Gymnasium (from 1.0 on) looks for no entry points: an import registers them, that of
``navette`` after Gymnasium's, or this one::

    import gymnasium
    import navette

    gymnasium.make("navette/Navigation-v0", world="barn-like", robot="jackal")

Without either the id is ``navette:navette/Navigation-v0``.
"""

from navette import register_environment
from navette.errors import MissingPartError

try:
    import gymnasium
except ImportError:
    raise MissingPartError(
        "navette.navigation.gym requires Gymnasium: pip install 'navette[gym]'"
    ) from None

from navette.navigation.gym.environment import NavigationEnv
from navette.navigation.gym.observation import Observer
from navette.navigation.gym.params import NavigationEnvParams

__all__ = ["NavigationEnv", "NavigationEnvParams", "Observer"]

register_environment(gymnasium)
