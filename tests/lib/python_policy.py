"""Tests the example that trains a policy: the exported network computes the same actions in a scene as in NumPy."""

import os
import sys
import tempfile
import unittest

import numpy as np

import limber

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../python/examples"))
import train_policy  # noqa: E402

SCENE = """
local policy = sim:load_policy("walk.safetensors")
local ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = 0 })
sim:on_step(function()
  local actions = policy:evaluate { 0.6, -0.8, 0.05, -0.1, 1 }
  ball.position = vec3(actions[1], actions[2], actions[3])
end)
"""


class PolicyTest(unittest.TestCase):
    def test_the_exported_policy_has_the_actions_of_the_training(self):
        numbers = np.random.default_rng(5).uniform(size=len(train_policy.first_numbers()))
        network = train_policy.network_of(numbers)
        with tempfile.TemporaryDirectory() as folder:
            metadata = {"activation": "tanh", "output": "tanh"}
            path = os.path.join(folder, "walk.safetensors")
            train_policy.save_safetensors(path, network | {"output_scale": train_policy.SCALE}, metadata)
            scene = os.path.join(folder, "scene.lua")
            with open(scene, "w", encoding="utf-8") as file:
                file.write(SCENE)
            sim = limber.Sim(scene, seed=1, log=None)
            sim.step(2)
            actions = sim.property("/physics/body/ball/part/ball/position").read()[0]
        expected = train_policy.evaluate(network, np.array([[0.6, -0.8, 0.05, -0.1, 1]], dtype=np.float32))[0]
        np.testing.assert_allclose(actions, expected, atol=2e-6)

    def test_the_training_finds_a_gait_and_writes_its_scene(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "walk.safetensors")
            sys.argv = ["train_policy.py", "--evaluations", "20", "--out", path]
            train_policy.main()
            sim = limber.Sim(os.path.join(folder, "walk.lua"), seed=1, log=None)
            position = sim.property("/physics/body/dog/part/trunk/position")
            begin = position.read()[0].copy()
            sim.step(180)
            self.assertEqual(sim.tick, 180)
            self.assertGreater(np.linalg.norm(position.read()[0] - begin), 0.01)


if __name__ == "__main__":
    unittest.main()
