"""Parameters of the navigation environment."""

from dataclasses import dataclass

from navette.params import Params, param


@dataclass(frozen=True, kw_only=True)
class NavigationEnvParams(Params):
    """Step, observation, episode and reward of ``navette/Navigation-v0``."""

    step_s: float = param(0.1, "simulated time of a step", at_least=0.01, at_most=1.0)
    beams: int = param(
        0,
        "ranges in the observation: the scan is divided into as many equal sectors, "
        "each gives its smallest range; 0 = all beams",
        at_least=0,
    )
    lookahead_m: float = param(
        0.0,
        "the observed goal is the point of the shortest path this far ahead; "
        "0 = the goal itself",
        at_least=0.0,
    )
    tolerance_m: float = param(
        0.5, "distance from the goal that ends the episode", above=0.0
    )
    limit_s: float = param(
        100.0, "simulated time after which an episode is truncated", above=0.0
    )
    worlds: int = param(
        0,
        "number of different generated worlds, kept in memory; 0 = a new one for each "
        "episode",
        at_least=0,
    )
    first_world: int = param(
        1000,
        "smallest seed of a generated world; navette bench uses those from 0",
        at_least=0,
        at_most=1 << 30,
    )
    random_ends: bool = param(
        False, "draw start and goal in generated worlds too, instead of theirs"
    )
    farthest_goal_m: float = param(
        20.0, "longest shortest path from a drawn start to a drawn goal", at_least=1.0
    )
    progress_reward: float = param(
        1.0, "reward for each metre by which the shortest path to the goal shortens"
    )
    time_penalty: float = param(0.1, "taken from the reward for each second")
    goal_reward: float = param(10.0, "reward for reaching the goal")
    contact_penalty: float = param(10.0, "taken from the reward for a contact")
