"""An environment for learning, as Gymnasium has them: a hand squeezes water out of a sponge. `python environment.py`

`SqueezeEnv` has `reset`, `step` and the shapes of its spaces; it does not need Gymnasium. A reset is a roll back to a snapshot: no scene is
built anew, and the same actions give the same bits.
"""

import numpy as np

import sorb

SCENE = {
    "version": 1,
    "name": "squeeze",
    "time": {"frame_rate": 30},
    "domain": {"kind": "box", "minimum": [-0.1, 0.0, -0.1], "maximum": [0.1, 0.2, 0.1]},
    "fluid": {"spacing": 0.01},
    "sponges": [
        {"name": "sponge", "edge": 0.02, "cells": [4, 3, 4], "position": [-0.04, 0.0, -0.04], "saturation": 1.0}
    ],
    "bodies": [
        {
            "name": "hand",
            "kind": "kinematic",
            "shape": {"kind": "cuboid", "half_extents": [0.05, 0.01, 0.05]},
            "position": [0.0, 0.08, 0.0],
        }
    ],
}
LOWEST, HIGHEST, FASTEST = 0.04, 0.1, 0.3


class SqueezeEnv:
    """Action: velocity of the hand over its largest, -1 to 1. Observation: height of the hand [m], water in the sponge [kg], force [N]."""

    action_shape = (1,)
    observation_shape = (3,)

    def __init__(self, frames: int = 20) -> None:
        self.frames = frames
        self.world = sorb.World(SCENE)
        # The first steps let the scene settle.
        self.world.run(frames=2)
        self.start = self.world.snapshot()
        self.interval = 1.0 / self.world.scene["time"]["frame_rate"]

    def observe(self) -> np.ndarray:
        load = self.world.body_loads()["hand"]
        height = self.world.bodies["hand"].position[1]
        return np.array([height, self.world.measures()["absorbed_mass"], load.sponges.force[1]], np.float32)

    def reset(self, seed: "int | None" = None) -> tuple[np.ndarray, dict]:
        self.world.rollback(self.start)
        self.left, self.water = self.frames, self.world.measures()["absorbed_mass"]
        return self.observe(), {}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict]:
        height = self.world.bodies["hand"].position[1]
        way = float(np.clip(action[0], -1.0, 1.0)) * FASTEST * self.interval
        self.world.move("hand", (0.0, float(np.clip(height + way, LOWEST, HIGHEST)), 0.0), duration=self.interval)
        self.world.advance_frame()
        self.left -= 1
        observation = self.observe()
        # What leaves the sponge is the reward [g].
        reward, self.water = 1000.0 * (self.water - float(observation[1])), float(observation[1])
        return observation, reward, False, self.left <= 0, {"digest": self.world.digest}


def episode(environment: SqueezeEnv, seed: int) -> tuple[float, int]:
    """Return and last digest of an episode of random actions."""
    generator = np.random.default_rng(seed)
    environment.reset()
    total, is_over, info = 0.0, False, {}
    while not is_over:
        _, reward, _, is_over, info = environment.step(generator.uniform(-1.0, 0.5, 1))
        total += reward
    return total, info["digest"]


if __name__ == "__main__":
    environment = SqueezeEnv()
    first, second, other = (episode(environment, seed) for seed in (1, 1, 2))
    print(f"returns {first[0]:.2f}, {second[0]:.2f} and {other[0]:.2f} g")
    assert first == second, "the same actions give the same bits"
    assert first[1] != other[1], "other actions give others"
