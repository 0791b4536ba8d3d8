"""Trains the gait of a quadruped: a random search, then a small CMA-ES from its best. NumPy only.

    python3 train_gait.py [--evaluations 600] [--seed 1] [--out gait.lua]

The result is a scene; play it with `limber gait.lua`. The same seed gives the same scene.
"""

import argparse
import time

import numpy as np

import limber

SECONDS = 6.0
SCENE = """
sim:add_body("floor"):add_part("floor", sim:add_plane_shape("floor"), { friction = 1 })
local dog = sim:load_urdf("urdf/quadruped.urdf", { name = "dog", position = vec3(0, 0, 0.40) })
for part in dog:parts() do part.friction = 0.9 end
"""
LEGS = ("front_left", "front_right", "back_left", "back_right")
PHASES = np.array([0.0, 0.5, 0.5, 0.0])  # diagonal legs step together

# name, smallest and largest value of each parameter
PARAMETERS = (
    ("pace", 0.8, 3.0),          # steps of each leg per second
    ("swing", 0.0, 0.6),         # thigh, rad
    ("lift", 0.0, 0.9),          # knee in the air, rad
    ("lag", -0.25, 0.25),        # of the knee behind the thigh, in steps
    ("lean", -0.3, 0.3),         # mean angle of the thigh, rad
    ("bend", -0.4, 0.4),         # mean angle of the knee, rad
    ("sway", -0.2, 0.2),         # hip, rad
    ("back", -0.25, 0.25),       # of the back legs behind the front ones, in steps
)
LOW = np.array([low for _, low, _ in PARAMETERS])
HIGH = np.array([high for _, _, high in PARAMETERS])


class Trial:
    """The distance that a gait walks in SECONDS, measured from the same state each time."""

    def __init__(self, seed):
        self.sim = limber.Sim(text=SCENE, seed=seed, log=None)
        joints = "{front_left,front_right,back_left,back_right}"
        self.targets = {
            joint: self.sim.property(f"/physics/body/dog/motor/{joints}_{joint}/target")
            for joint in ("hip", "thigh", "knee")
        }
        order = [address.split("/")[-2].rsplit("_", 1)[0] for address in self.targets["hip"].addresses]
        self.phases = np.array([PHASES[LEGS.index(leg)] for leg in order])
        self.is_back = np.array([leg.startswith("back") for leg in order])
        self.trunk = self.sim.property("/physics/body/dog/part/trunk/position")
        self.sim.step(60)  # it stands
        self.start = self.sim.state()
        self.begin = self.trunk.read()[0].copy()

    def distance(self, gait):
        pace, swing, lift, lag, lean, bend, sway, back = LOW + (HIGH - LOW) * np.clip(gait, 0, 1)
        self.sim.restore(self.start)
        phases = self.phases + back * self.is_back
        for tick in range(int(SECONDS / self.sim.timestep)):
            phase = 2 * np.pi * (pace * tick * self.sim.timestep + phases)
            ease = min(1.0, tick * self.sim.timestep)
            self.targets["hip"].write(ease * sway * np.sin(phase))
            self.targets["thigh"].write(ease * (lean + swing * np.sin(phase)))
            self.targets["knee"].write(ease * (bend + lift * np.maximum(0, np.cos(phase - 2 * np.pi * lag))))
            self.sim.step()
            if self.trunk.read()[0, 2] < 0.2:  # it has fallen
                return float(self.trunk.values[0, 0] - self.begin[0]) - 1.0
        x, y, _ = self.trunk.values[0] - self.begin
        return float(x - 0.5 * abs(y))


def random_search(trial, count, random):
    """Returns the best of `count` random gaits, and its distance."""
    gaits = random.uniform(size=(count, len(PARAMETERS)))
    distances = [trial.distance(gait) for gait in gaits]
    best = int(np.argmax(distances))
    return gaits[best], distances[best]


def cma_es(trial, mean, step, count, random):
    """CMA-ES (Hansen 2016) with a full covariance matrix; returns the best gait of `count`, and its distance."""
    n = len(mean)
    size = 4 + int(3 * np.log(n))
    weights = np.log(size / 2 + 0.5) - np.log(np.arange(1, size // 2 + 1))
    weights /= weights.sum()
    mass = 1 / np.sum(weights**2)
    c_sigma, d_sigma = (mass + 2) / (n + mass + 5), 1 + 2 * max(0, np.sqrt((mass - 1) / (n + 1)) - 1)
    d_sigma += c_sigma
    c_path = (4 + mass / n) / (n + 4 + 2 * mass / n)
    c_one = 2 / ((n + 1.3) ** 2 + mass)
    c_rank = min(1 - c_one, 2 * (mass - 2 + 1 / mass) / ((n + 2) ** 2 + mass))
    expected = np.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n))
    covariance, path, path_sigma = np.eye(n), np.zeros(n), np.zeros(n)
    best, best_distance = mean, -np.inf
    for generation in range(1, count // size + 1):
        values, axes = np.linalg.eigh(covariance)
        scale = np.sqrt(np.maximum(values, 1e-20))
        steps = (random.normal(size=(size, n)) * scale) @ axes.T
        gaits = mean + step * steps
        outside = np.sum((gaits - np.clip(gaits, 0, 1)) ** 2, axis=1)
        distances = np.array([trial.distance(gait) for gait in gaits])
        order = np.argsort(-(distances - outside), kind="stable")
        if distances[order[0]] > best_distance:
            best, best_distance = np.clip(gaits[order[0]], 0, 1), distances[order[0]]
        change = weights @ steps[order[: len(weights)]]
        mean = mean + step * change
        whitened = axes @ ((axes.T @ change) / scale)
        path_sigma = (1 - c_sigma) * path_sigma + np.sqrt(c_sigma * (2 - c_sigma) * mass) * whitened
        norm = np.linalg.norm(path_sigma)
        steady = norm / np.sqrt(1 - (1 - c_sigma) ** (2 * generation)) < (1.4 + 2 / (n + 1)) * expected
        path = (1 - c_path) * path + steady * np.sqrt(c_path * (2 - c_path) * mass) * change
        rank = sum(w * np.outer(s, s) for w, s in zip(weights, steps[order]))
        covariance = (1 - c_one - c_rank) * covariance + c_one * np.outer(path, path) + c_rank * rank
        step *= np.exp(c_sigma / d_sigma * (norm / expected - 1))
        print(f"generation {generation}: best {best_distance:.2f} m, step {step:.3f}")
    return best, best_distance


def scene_of(gait):
    """The scene that plays the gait."""
    values = LOW + (HIGH - LOW) * np.clip(gait, 0, 1)
    lines = [f"local {name} = {value:.6f}" for (name, _, _), value in zip(PARAMETERS, values)]
    phases = ", ".join(f"{leg} = {phase}" for leg, phase in zip(LEGS, PHASES))
    return "-- A gait of the quadruped that train_gait.py has found.\n" + SCENE + "\n".join(lines) + f"""
local phases = {{ {phases} }}
sim:on_step(function()
  local t = sim.time - 1
  if t < 0 then return end
  local ease = math.min(1, t)
  for leg, start in pairs(phases) do
    local phase = 2 * math.pi * (pace * t + start + (leg:sub(1, 4) == "back" and back or 0))
    dog:motor(leg .. "_hip").target = ease * sway * math.sin(phase)
    dog:motor(leg .. "_thigh").target = ease * (lean + swing * math.sin(phase))
    dog:motor(leg .. "_knee").target = ease * (bend + lift * math.max(0, math.cos(phase - 2 * math.pi * lag)))
  end
end)
sim:on_start(function() visuals.camera:follow(dog) end)
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--evaluations", type=int, default=600)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default="gait.lua")
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    trial = Trial(options.seed)
    begin = time.time()
    gait, distance = random_search(trial, options.evaluations // 3, random)
    print(f"random search: {distance:.2f} m in {SECONDS:g} s")
    found, found_distance = cma_es(trial, gait, 0.15, options.evaluations - options.evaluations // 3, random)
    if found_distance > distance:
        gait, distance = found, found_distance
    with open(options.out, "w", encoding="utf-8") as file:
        file.write(scene_of(gait))
    print(f"best: {distance:.2f} m in {SECONDS:g} s, after {time.time() - begin:.0f} s")
    print(f"limber {options.out}")


if __name__ == "__main__":
    main()
