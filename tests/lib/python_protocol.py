"""Tests of the Python package: values, states, the rules of Gymnasium's protocol, processes, threads."""

import gc
import multiprocessing
import os
import signal
import sys
import threading
import unittest

import numpy as np

import limber

ARM = """
local arm = sim:add_body("arm")
local rod = sim:add_box_shape("rod", vec3(0.05, 0.05, 0.4))
arm:add_part("base", rod, { position = vec3(0, 0, 0.7), motion = "static" })
arm:add_part("upper", rod, { position = vec3(0, 0, 1.1), mass = 1 })
arm:add_part("lower", rod, { position = vec3(0, 0, 1.5), mass = 1 })
arm:add_motor(arm:add_joint("one", "base", "upper", { position = vec3(0, 0, 0.9), axis = vec3(0, 1, 0) }))
arm:add_motor(arm:add_joint("two", "upper", "lower", { position = vec3(0, 0, 1.3), axis = vec3(0, 1, 0) }))
sim:on_step(function() arm:part("lower"):apply_force(vec3(math.random() - 0.5, 0, 0)) end)
"""


def make_env():
    return limber.Env(
        text=ARM,
        actions=["/physics/body/arm/motor/*/target"],
        observations=["/physics/body/arm/joint/*/value", "/physics/body/arm/part/lower/position"],
        low=-1,
        high=1,
        ticks=2,
        max_steps=20,
        reward=lambda env: env.observations[1].values[0, 2],
    )


def child_hash(sim, queue):
    """Runs in a forked child: the parent's simulation is rejected, an own one works."""
    try:
        sim.step()
        queue.put("not rejected")
    except limber.SimError:
        own = limber.Sim(text=ARM, seed=3)
        own.step(50)
        queue.put(own.hash())


class SimTest(unittest.TestCase):
    def test_values_share_one_array(self):
        sim = limber.Sim(text=ARM, seed=1)
        angles = sim.property("/physics/body/arm/joint/*/value")
        targets = sim.property("/physics/body/arm/motor/*/target")
        array = angles.values
        targets.values[:] = 0.3, -0.4
        targets.write(targets.values)
        sim.step(120)
        self.assertIs(angles.read(), array)
        np.testing.assert_allclose(array, [0.3, -0.4], atol=0.05)
        self.assertEqual(angles.unit, targets.unit)
        self.assertFalse(angles.writable)
        targets.write(0.1)
        np.testing.assert_array_equal(targets.read(), [0.1, 0.1])
        self.assertEqual(sim.property("/physics/body/arm/part/*/position").values.shape, (3, 3))

    def test_errors(self):
        sim = limber.Sim(text=ARM)
        with self.assertRaisesRegex(KeyError, "motor"):
            sim.property("/physics/body/arm/motr/one/target")
        targets = sim.property("/physics/body/arm/motor/*/target")
        for bad in ([1, np.nan], [1, 2, 3], "text"):
            with self.assertRaises(ValueError):
                targets.write(bad)
        with self.assertRaises(ValueError):
            sim.property("/physics/body/arm/joint/*/value").write([0, 0])
        with self.assertRaisesRegex(limber.SimError, "wrong.lua:2"):
            limber.Sim("wrong.lua", text="local a = 1\na.b.c = 2")
        with self.assertRaises(ValueError):
            limber.Sim(text=ARM, seed=-1)
        with self.assertRaisesRegex(ValueError, "gravity"):
            sim.send("/physics/sim/gravit", 0.0)

    def test_restore_and_reset_repeat(self):
        sim = limber.Sim(text=ARM, seed=5)
        state = sim.state()
        sim.step(100)
        expected = sim.hash()
        sim.restore(state)
        sim.step(100)
        self.assertEqual(sim.hash(), expected)
        sim.reset(6)
        sim.step(100)
        self.assertNotEqual(sim.hash(), expected)
        sim.reset(5)
        sim.step(100)
        self.assertEqual(sim.hash(), expected)
        with self.assertRaises(limber.SimError):
            sim.restore(state)

    def test_log_and_messages(self):
        lines = []
        text = "print('hello') osc:on('/add', function(a, b) osc:send('/sum', a + b) end)"
        sim = limber.Sim(text=text, log=lambda level, line: lines.append((level, line)))
        self.assertIn(("print", "hello"), lines)
        sim.send("/add", 1, 2.5)
        self.assertEqual(sim.events(), [("/sum", (3.5,))])
        self.assertEqual(sim.events(), [])

    def test_texts_that_are_not_utf_8(self):
        lines = []
        text = "print('a\\255') sim:on_start(function() osc:send('/bytes', 'b\\255') end)"
        sim = limber.Sim(text=text, log=lambda level, line: lines.append((level, line)))
        self.assertIn(("print", "a\ufffd"), lines)
        sim.step()
        self.assertEqual(sim.events(), [("/bytes", ("b\ufffd",))])

    def test_log_functions_that_raise(self):
        def interrupt(level, line):
            raise KeyboardInterrupt

        signal.signal(signal.SIGINT, signal.default_int_handler)  # in case that it was ignored at the start
        with self.assertRaises(KeyboardInterrupt):
            limber.Sim(text="print('hello')", log=interrupt)
            for _ in range(1000):
                pass

    def test_objects_outlive_the_variable(self):
        sim = limber.Sim(text=ARM)
        angles, state = sim.property("/physics/body/arm/joint/*/value"), sim.state()
        del sim
        gc.collect()
        self.assertEqual(angles.read().shape, (2,))
        del state, angles

    def test_threads(self):
        expected = limber.Sim(text=ARM, seed=2)
        expected.step(200)
        hashes = []

        def run():
            sim = limber.Sim(text=ARM, seed=2)
            sim.step(200)
            hashes.append(sim.hash())

        threads = [threading.Thread(target=run) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(hashes, [expected.hash()] * 4)

    def test_fork(self):
        expected = limber.Sim(text=ARM, seed=3)
        expected.step(50)
        context = multiprocessing.get_context("fork")
        queue = context.Queue()
        child = context.Process(target=child_hash, args=(expected, queue))
        child.start()
        self.assertEqual(queue.get(timeout=120), expected.hash())
        child.join()

    def test_subinterpreters_are_rejected(self):
        try:
            import _xxsubinterpreters as interpreters  # Python 3.11, 3.12
        except ImportError:
            import _interpreters as interpreters
        one = interpreters.create()
        code = f"import sys\nsys.path = {sys.path!r}\nimport limber._core"
        try:
            failure = interpreters.run_string(one, code)
        except Exception as error:
            failure = error
        self.assertRegex(str(failure), "subinterpreter|does not support|one interpreter per process")

    def test_memory_stays(self):
        def resident():
            with open("/proc/self/statm", encoding="ascii") as file:
                return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

        env = make_env()
        env.reset(seed=1)

        def run(steps):
            for _ in range(steps):
                if env.step(env.action_space.sample())[3]:
                    env.reset()

        run(3000)
        before = resident()
        run(int(os.environ.get("LIMBER_SOAK_STEPS", "6000")))
        self.assertLess(resident() - before, 4 << 20)


class EnvTest(unittest.TestCase):
    def test_protocol(self):
        env = make_env()
        self.assertEqual(env.action_space.shape, (2,))
        with self.assertRaises(RuntimeError):
            env.step(np.zeros(2))
        first, info = env.reset(seed=4)
        self.assertIsInstance(info, dict)
        self.assertTrue(env.observation_space.contains(first))
        env.action_space.seed(1)
        actions = [env.action_space.sample() for _ in range(20)]
        runs = []
        for _ in range(3):
            start, _ = env.reset(seed=4)
            np.testing.assert_array_equal(start, first)
            run = [env.step(action) for action in actions]
            self.assertEqual([r[2] for r in run], [False] * 20)
            self.assertEqual([r[3] for r in run], [False] * 19 + [True])
            for observation, reward, terminated, truncated, info in run:
                self.assertTrue(env.observation_space.contains(observation))
                self.assertIsInstance(reward, float)
                self.assertIsInstance(terminated, bool)
                self.assertIsInstance(truncated, bool)
                self.assertIsInstance(info, dict)
            runs.append(np.array([r[0] for r in run]))
        np.testing.assert_array_equal(runs[0], runs[1])
        np.testing.assert_array_equal(runs[0], runs[2])
        with self.assertRaises(RuntimeError):
            env.step(actions[0])
        with self.assertRaises(ValueError):
            env.reset(seed=4)
            env.step(np.zeros(3))
        without_seed, _ = env.reset()
        np.testing.assert_array_equal(without_seed, first)

    def test_vector_env_is_independent_of_processes(self):
        results = []
        for processes in (1, 2):
            with limber.VectorEnv(make_env, 3, processes) as envs:
                observations, _ = envs.reset(seed=10)
                envs.action_space.seed(0)
                run = [observations.copy()]
                for _ in range(25):
                    observations, rewards, terminated, truncated, infos = envs.step(envs.action_space.sample())
                    self.assertEqual(len(infos), 3)
                    self.assertEqual(truncated.dtype, bool)
                    run.append(observations.copy())
                results.append(np.array(run))
        np.testing.assert_array_equal(results[0], results[1])

    def test_errors_of_workers_are_raised(self):
        with limber.VectorEnv(make_env, 2, 2) as envs:
            envs.reset(seed=1)
            with self.assertRaisesRegex(RuntimeError, "must be finite|finite|NaN"):
                envs.step(np.full((2, 2), np.nan))


if __name__ == "__main__":
    unittest.main()
