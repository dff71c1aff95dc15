"""Train a small policy in Gymnasium, then let it drive in the whole stack.

CMA-ES (the package cma) searches for the weights of two neurons by the rewards of
episodes in generated worlds. A real training takes minutes::

    python examples/32_train_a_policy.py 40 policy.npz
    POLICY=policy.npz navette bench barn-like \\
        --controller examples/32_train_a_policy.py:LearnedController

Without arguments, it is a short one. Prints::

    2 generations of 8 policies, 4 episodes each
    more reward than without training: True
"""

import os
import sys

import cma
import gymnasium
import numpy as np

import navette.navigation.gym  # noqa: F401 - registers the environment
from navette.geometry import Pose2

SECTORS, INPUTS = 16, 16 + 5
NEAR_M = 3.0  # farther obstacles do not matter
LOOKAHEAD_M = 1.0
# Limits of `control` for the Jackal: what the policy learns is what it will drive.
LIMITS = {
    "max_accel_mps2": 1.5, "max_decel_mps2": 1.5, "max_yaw_rate_radps": 1.5,
    "max_yaw_accel_radps2": 4.0, "timestep_s": 0.005,  # faster than steps of 2 ms
}  # fmt: skip


def make_env(world="barn-like"):
    return gymnasium.make(
        "navette/Navigation-v0", world=world, robot="jackal", beams=SECTORS,
        lookahead_m=LOOKAHEAD_M, limit_s=15.0, worlds=20, parameters={"sim": LIMITS},
    )  # fmt: skip


def act(weights, observation):
    """Return speed and turn rate: two neurons over sectors, goal and velocity."""
    near = 1 - np.minimum(observation["ranges"], NEAR_M) / NEAR_M
    inputs = np.concatenate([near, observation["goal"], observation["velocity"], [1]])
    return np.tanh(weights.reshape(2, INPUTS) @ inputs).astype(np.float32)


def first_weights():
    """Return the weights of a policy that turns to the goal and sees no obstacles."""
    weights = np.zeros(2 * INPUTS)
    weights[[INPUTS - 1, INPUTS + SECTORS + 1]] = 0.5, 1.5  # speed; turn by goal's y
    return weights


def episode(env, weights, seed):
    """Return the sum of the rewards of an episode."""
    observation, _ = env.reset(seed=seed)
    total, ends = 0.0, [False]
    while not any(ends):
        observation, reward, *ends, _ = env.step(act(weights, observation))
        total += reward
    return total


def train(env, generations, population, episodes=4):
    """Yield the mean of the best weights' distribution after each generation."""
    search = cma.CMAEvolutionStrategy(
        first_weights(), 0.3, {"seed": 1, "popsize": population, "verbose": -9}
    )
    for generation in range(generations):
        seeds = range(episodes * generation, episodes * (generation + 1))
        candidates = search.ask()
        rewards = [np.mean([episode(env, w, s) for s in seeds]) for w in candidates]
        search.tell(candidates, [-each for each in rewards])
        yield search.result.xfavorite, float(np.mean(rewards))


class LearnedController:
    """The policy as a controller: ``command`` is called many times a second."""

    def __init__(self):
        self.weights = np.load(os.environ["POLICY"])["weights"]
        self.observer = make_env("empty").unwrapped.observer

    def command(self, state, path, obstacles):
        pose = Pose2(state.x, state.y, state.yaw)
        lengths = np.cumsum(np.hypot(*np.diff(path[:, :2], axis=0).T))
        ahead = path[np.searchsorted(lengths, LOOKAHEAD_M), :2]
        ranges = self.observer.ranges_to(obstacles, pose)
        moving = (state.speed, state.turn_rate)
        observation = self.observer.observe(ranges, pose, tuple(ahead), moving)
        return self.observer.command(act(self.weights, observation))


def main(generations=2, file=None):
    env, population = make_env(), 16 if file else 8
    print(f"{generations} generations of {population} policies, 4 episodes each")
    for weights, reward in train(env, int(generations), population):
        if file:
            np.savez(file, weights=weights)
            print(f"mean reward {reward:.1f}", flush=True)
    policies = (first_weights(), weights)
    before, after = (sum(episode(env, p, s) for s in range(4)) for p in policies)
    print("more reward than without training:", after > before)


if __name__ == "__main__":
    main(*sys.argv[1:])
