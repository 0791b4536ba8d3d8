"""Tests of the Python package: values, states, the rules of Gymnasium's protocol, processes, threads."""

import contextlib
import gc
import io
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np

import limber
from limber.log import PrintLog

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


def make_env(**options):
    return limber.Env(
        text=ARM,
        actions=["/physics/body/arm/motor/*/target"],
        observations=["/physics/body/arm/joint/*/value", "/physics/body/arm/part/lower/position"],
        low=-1,
        high=1,
        ticks=2,
        max_steps=20,
        reward=lambda env: env.observations[1].values[0, 2],
        **options,
    )


def make_quitting_env():
    class Quitting(limber.Env):
        def is_terminated(self):
            os._exit(7)

    env = make_env()
    env.__class__ = Quitting
    return env


def make_rendering_env():
    return make_env(render_mode="rgb_array", camera={"width": 32, "height": 24, "quality": "low"})


def child_hash(sim, queue):
    """Runs in a forked child: the parent's simulation is rejected, an own one works."""
    try:
        sim.step()
        queue.put("not rejected")
    except limber.SimError:
        own = limber.Sim(text=ARM, seed=3)
        own.step(50)
        queue.put(own.hash())


def child_render(queue):
    """Runs in a forked child of a process that has drawn images."""
    try:
        limber.Sim(text=ARM).render(32, 32)
        queue.put("not rejected")
    except limber.SimError as error:
        queue.put(str(error))


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

    def test_render(self):
        scene = ARM + """
            visuals.look.floor = false
            visuals.background = vec3(0, 0, 0)
            visuals.camera:look_at(vec3(0, -4, 1.1), vec3(0, 0, 1.1))"""
        sim = limber.Sim(text=scene, seed=1)
        before = sim.hash()
        image = sim.render(160, 120, quality="low")
        self.assertEqual((image.shape, image.dtype), ((120, 160, 3), np.uint8))
        self.assertEqual(sim.hash(), before)
        # the arm is a vertical bar in the middle; from above it is a spot
        brightness = image.sum(axis=2).astype(int)
        self.assertGreater(brightness[30:90, 78:82].mean(), 3 * brightness[30:90, 20:60].mean())
        above = sim.render(160, 120, position=(0.01, 0, 6), target=(0, 0, 1), quality="low").sum(axis=2)
        self.assertGreater(above[60, 80], 3 * above[20:40, 78:82].mean())
        np.testing.assert_array_equal(sim.render(160, 120, quality="low"), image)
        for arguments in ({"width": 0}, {"quality": "best"}, {"position": (np.nan, 0, 0)}, {"fovy": 180}):
            with self.assertRaises(ValueError):
                sim.render(**arguments)

    def test_graphics_are_loaded_with_the_first_image(self):
        code = """
import limber
sim = limber.Sim(text="local a = 1")
sim.step(10)
loaded = lambda: any(name in open("/proc/self/maps").read() for name in ("libEGL", "libGL", "dri"))
assert not loaded()
try:
    sim.render(64, 48)
    assert loaded()
except limber.SimError as error:
    print(error)
"""
        for variables, text in (({}, ""), ({"__EGL_VENDOR_LIBRARY_DIRS": "/nowhere"}, "no OpenGL driver was found")):
            result = subprocess.run(
                [sys.executable, "-c", code], env={**os.environ, **variables}, capture_output=True, text=True
            )
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertIn(text, result.stdout)
            self.assertEqual(bool(text), bool(result.stdout))

    def test_render_after_a_fork(self):
        sim = limber.Sim(text=ARM)
        sim.render(32, 32, quality="low")
        context = multiprocessing.get_context("fork")
        queue = context.Queue()
        child = context.Process(target=child_render, args=(queue,))
        child.start()
        self.assertIn("forked", queue.get(timeout=120))
        child.join()

    def test_long_steps_are_interrupted(self):
        def interrupt(level, line):
            os.kill(os.getpid(), signal.SIGINT)

        signal.signal(signal.SIGINT, signal.default_int_handler)  # in case that it was ignored at the start
        text = ARM + "sim:on_step(function() if sim.tick == 100 then print('now') end end)"
        sim = limber.Sim(text=text, seed=1, log=interrupt)
        with self.assertRaises(KeyboardInterrupt):
            sim.step(10**9)
        ticks = sim.tick
        self.assertGreaterEqual(ticks, 100)
        self.assertLess(ticks, 10**6)
        sim.step(5)
        whole = limber.Sim(text=text, seed=1, log=None)
        whole.step(ticks + 5)
        self.assertEqual((sim.tick, sim.hash()), (ticks + 5, whole.hash()))

    def test_repeated_lines_are_limited(self):
        now = [0.0]
        log = PrintLog(lambda: now[0])
        out, err = io.StringIO(), io.StringIO()

        def lines(stream):
            text = stream.getvalue()
            stream.truncate(0)
            stream.seek(0)
            return text.splitlines()

        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            for i in range(100):
                log("warning", f"arm.lua:{i}: 'part_1' has {i}.5 m/s")
                log("error", "another source")
            written = lines(err)
            self.assertEqual(len(written), 20)
            self.assertEqual(written[0], "limber: warning: arm.lua:0: 'part_1' has 0.5 m/s")
            now[0] = 60
            log("warning", "arm.lua:3: 'part_1' has 1 m/s")
            log("warning", "arm.lua:3: 'part_2' has 1 m/s")  # another source
            self.assertEqual(
                lines(err),
                [
                    "limber: warning: arm.lua:3: 'part_1' has 1 m/s (and 90 more since the last one)",
                    "limber: warning: arm.lua:3: 'part_2' has 1 m/s",
                ],
            )
            for i in range(3000):
                log("print", str(i))
            self.assertEqual(lines(out), [str(i) for i in range(2000)])
            now[0] = 60.5
            for i in range(200):
                log("print", "later")
            self.assertEqual(lines(out), ["later"] * 100)
            self.assertEqual(lines(err), ["limber: 1000 lines of print() were dropped"])
            for i in range(1000):
                log("warning", f"source {chr(0x4E00 + i)}")
            self.assertLessEqual(len(log._sources), PrintLog.SOURCES)

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

    def test_render_modes(self):
        self.assertIsNone(make_env().render())
        camera = {"width": 64, "height": 48, "quality": "low"}
        env = make_env(render_mode="rgb_array", camera=camera)
        self.assertEqual(env.metadata["render_modes"], ["rgb_array"])
        self.assertAlmostEqual(env.metadata["render_fps"], 1 / (env.sim.timestep * 2))
        env.reset(seed=1)
        first = env.render()
        self.assertEqual((first.shape, first.dtype), ((48, 64, 3), np.uint8))
        for _ in range(10):
            env.step(env.action_space.high)
        self.assertGreater(np.abs(env.render().astype(int) - first).max(), 50)
        with self.assertRaisesRegex(ValueError, "rgb_array"):
            make_env(render_mode="human")

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
            with self.assertRaisesRegex(RuntimeError, r"worker 0 .*environment 0, process \d+\) failed:(.|\n)*finite"):
                envs.step(np.full((2, 2), np.nan))
            with self.assertRaisesRegex(RuntimeError, "closed"):
                envs.step(np.zeros((2, 2)))

    def test_workers_that_end_are_named(self):
        with limber.VectorEnv(make_env, 3, 2) as envs:
            envs.reset(seed=1)
            worker = envs._processes[1]
            os.kill(worker.pid, signal.SIGKILL)
            worker.join()
            with self.assertRaisesRegex(RuntimeError, rf"worker 1 .*environments 1 to 2, process {worker.pid}.*SIGKILL"):
                envs.step(np.zeros((3, 2)))
        with limber.VectorEnv(make_quitting_env, 1, 1) as envs:
            envs.reset(seed=1)
            with self.assertRaisesRegex(RuntimeError, "worker 0 .*exited with status 7"):
                envs.step(np.zeros((1, 2)))

    def test_vector_env_renders(self):
        with limber.VectorEnv(make_rendering_env, 2, 1) as envs:
            envs.reset(seed=1)
            images = envs.render()
            self.assertEqual([image.shape for image in images], [(24, 32, 3)] * 2)


if __name__ == "__main__":
    unittest.main()
