"""Gymnasium environments: the simulator as a task for learning.

Gymnasium (from 1.0 on) looks for no entry points. This import registers the
environment; so does that of ``navette``, if it comes after Gymnasium's::

    import gymnasium
    import navette.navigation.gym

    gymnasium.make("navette/Navigation-v0", world="barn-like", robot="jackal")

Without either the id is ``navette.navigation.gym:navette/Navigation-v0``.
"""

from navette import register_environment
from navette.errors import MissingPartError

try:
    import gymnasium
except ImportError:
    raise MissingPartError.of("navette.navigation.gym", "gymnasium", "gym") from None

from navette.navigation.gym.environment import NavigationEnv
from navette.navigation.gym.observation import Observer
from navette.navigation.gym.params import NavigationEnvParams

__all__ = ["NavigationEnv", "NavigationEnvParams", "Observer"]

register_environment(gymnasium)
