"""Trains a policy for the legs of a quadruped with a small CMA-ES, and exports it as safetensors. NumPy only.

    python3 train_policy.py [--evaluations 640] [--seed 1] [--out walk.safetensors]

Writes the network and, beside it, a scene that plays it: `limber walk.lua`. The same seed gives the same files.
"""

import argparse
import json
import os
import struct
import time

import numpy as np

import limber
from train_gait import LEGS, PHASES, SCENE, cma_es

SECONDS = 8.0  # of a walk
PACE = 1.8  # steps of each leg per second
OBSERVATIONS, WIDTH, ACTIONS = 5, 8, 3
SHAPES = {"0.weight": (WIDTH, OBSERVATIONS), "0.bias": (WIDTH,), "2.weight": (ACTIONS, WIDTH), "2.bias": (ACTIONS,)}
SCALE = np.array([0.2, 0.4, 0.6], dtype=np.float32)  # of the actions, for hip, thigh and knee, rad
RANGE = 6.0  # the weights are −3 .. 3


def network_of(numbers):
    """The tensors of a network, from numbers between 0 and 1."""
    weights = (RANGE * (np.clip(numbers, 0, 1) - 0.5)).astype(np.float32)
    tensors, at = {}, 0
    for name, shape in SHAPES.items():
        size = int(np.prod(shape))
        tensors[name] = weights[at : at + size].reshape(shape)
        at += size
    return tensors


def evaluate(network, observations):
    """The actions, one row for each row of observations."""
    hidden = np.tanh(observations @ network["0.weight"].T + network["0.bias"])
    return np.tanh(hidden @ network["2.weight"].T + network["2.bias"]) * SCALE


def first_numbers():
    """A network that steps in place: the thigh swings with the sine of the leg's phase, the knee with its cosine."""
    network = {name: np.zeros(shape) for name, shape in SHAPES.items()}
    network["0.weight"][0, 0] = network["0.weight"][1, 1] = 1
    network["2.weight"][1, 0] = network["2.weight"][2, 1] = 1
    return np.concatenate([tensor.ravel() for tensor in network.values()]) / RANGE + 0.5


def save_safetensors(path, tensors, metadata):
    """Writes a safetensors file: the length of a header, the header in JSON, the numbers."""
    header, data = {"__metadata__": metadata}, b""
    for name, tensor in tensors.items():
        numbers = np.ascontiguousarray(tensor, dtype="<f4").tobytes()
        offsets = [len(data), len(data) + len(numbers)]
        header[name] = {"dtype": "F32", "shape": list(tensor.shape), "data_offsets": offsets}
        data += numbers
    text = json.dumps(header).encode()
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text + data)


class Trial:
    """The distance that a network walks in SECONDS."""

    def __init__(self, seed):
        self.sim = limber.Sim(text=SCENE, seed=seed, log=None)
        legs = "{front_left,front_right,back_left,back_right}"
        self.targets = [
            self.sim.property(f"/physics/body/dog/motor/{legs}_{joint}/target") for joint in ("hip", "thigh", "knee")
        ]
        order = [address.split("/")[-2].rsplit("_", 1)[0] for address in self.targets[0].addresses]
        self.phases = np.array([PHASES[LEGS.index(leg)] for leg in order])
        self.is_back = np.array([float(leg.startswith("back")) for leg in order])
        self.side = np.array([1.0 if leg.endswith("left") else -1.0 for leg in order])
        self.position = self.sim.property("/physics/body/dog/part/trunk/position")
        self.rotation = self.sim.property("/physics/body/dog/part/trunk/rotation")
        self.sim.step(60)  # it stands
        self.start = self.sim.state()
        self.begin = self.position.read()[0].copy()

    def observations(self, tick, start):
        """One row for each leg: the phase of its step, the tilt of the trunk, and whether it is a back leg."""
        phase = 2 * np.pi * (PACE * tick * self.sim.timestep + self.phases + start)
        x, y, z, w = self.rotation.read()[0]
        pitch, roll = 2 * (x * z + w * y), 2 * (y * z - w * x)  # x and y of the trunk's upward axis
        rows = [np.sin(phase), np.cos(phase), np.full(4, pitch), roll * self.side, self.is_back]
        return np.array(rows, dtype=np.float32).T

    def distance(self, numbers):
        """The shortest of walks that begin at several phases of the step: a gait that is only lucky doesn't win."""
        network, shortest = network_of(numbers), np.inf
        for start in (0, 0.5, 0.25, 0.75):
            shortest = min(shortest, self.walk(network, start))
            if shortest < 0:
                break
        return shortest

    def walk(self, network, start):
        self.sim.restore(self.start)
        for tick in range(int(SECONDS / self.sim.timestep)):
            actions = min(1.0, tick * self.sim.timestep) * evaluate(network, self.observations(tick, start))
            for joint, target in enumerate(self.targets):
                target.write(actions[:, joint] * (self.side if joint == 0 else 1))
            self.sim.step()
            if self.position.read()[0, 2] < 0.28:  # it falls
                return tick * self.sim.timestep / SECONDS - 1.0
        x, y, _ = self.position.values[0] - self.begin
        return float(x - 0.5 * abs(y))


def scene_of(policy):
    """The scene that plays the policy."""
    phases = ", ".join(f"{leg} = {phase}" for leg, phase in zip(LEGS, PHASES))
    return f"""-- A policy that train_policy.py has trained moves the legs of a quadruped.
{SCENE}
local policy = sim:load_policy("{policy}")
local phases = {{ {phases} }}
local trunk, observations, actions = dog:part("trunk"), {{}}, {{}}
sim:on_step(function()
  local t = sim.time - 1
  if t < 0 then return end
  local up = trunk.rotation * vec3(0, 0, 1)
  for leg, start in pairs(phases) do
    local phase, side = 2 * math.pi * ({PACE} * t + start), leg:find("left") and 1 or -1
    observations[1], observations[2] = math.sin(phase), math.cos(phase)
    observations[3], observations[4], observations[5] = up.x, up.y * side, leg:find("back") and 1 or 0
    policy:evaluate(observations, actions)
    local ease = math.min(1, t)
    dog:motor(leg .. "_hip").target = ease * actions[1] * side
    dog:motor(leg .. "_thigh").target = ease * actions[2]
    dog:motor(leg .. "_knee").target = ease * actions[3]
  end
end)
sim:on_start(function() visuals.camera:follow(dog) end)
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--evaluations", type=int, default=640)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default="walk.safetensors")
    options = parser.parse_args()
    trial = Trial(options.seed)
    begin = time.time()
    numbers, distance = cma_es(trial, first_numbers(), 0.05, options.evaluations, np.random.default_rng(options.seed))
    tensors = network_of(numbers) | {"output_scale": SCALE}
    save_safetensors(options.out, tensors, {"activation": "tanh", "output": "tanh"})
    scene = os.path.splitext(options.out)[0] + ".lua"
    with open(scene, "w", encoding="utf-8") as file:
        file.write(scene_of(os.path.basename(options.out)))
    print(f"best: {distance:.2f} m in {SECONDS:g} s, after {time.time() - begin:.0f} s")
    print(f"limber {scene}")


if __name__ == "__main__":
    main()
