"""VectorEnv: environments that are stepped together, in several processes with shared memory."""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import traceback
from multiprocessing.connection import Connection
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from .env import Box, Env

Make = Callable[[], Env]


def _array(memory: Any, shape: Tuple[int, ...], dtype: type) -> np.ndarray:
    return np.frombuffer(memory, dtype=dtype, count=int(np.prod(shape))).reshape(shape)


class _Shared:
    """The arrays that the processes share: one row for each environment."""

    def __init__(self, context: Any, count: int, observation: int, action: int) -> None:
        def raw(size: int, kind: Any) -> Any:
            return context.RawArray(kind, max(size, 1))

        self.shape = (count, observation, action)
        self.memory = [
            raw(count * observation, ctypes.c_double),
            raw(count * action, ctypes.c_double),
            raw(count, ctypes.c_double),
            raw(count, ctypes.c_uint8),
            raw(count, ctypes.c_uint8),
        ]

    def open(self) -> None:
        count, observation, action = self.shape
        self.observations = _array(self.memory[0], (count, observation), np.float64)
        self.actions = _array(self.memory[1], (count, action), np.float64)
        self.rewards = _array(self.memory[2], (count,), np.float64)
        self.terminated = _array(self.memory[3], (count,), np.uint8)
        self.truncated = _array(self.memory[4], (count,), np.uint8)


def _reset_one(env: Env, at: int, seed: Optional[int], options: Any, shared: _Shared) -> Dict[str, Any]:
    shared.observations[at], info = env.reset(seed=seed, options=options)
    shared.rewards[at] = shared.terminated[at] = shared.truncated[at] = 0
    return info


def _step_one(env: Env, at: int, shared: _Shared) -> Dict[str, Any]:
    if shared.terminated[at] or shared.truncated[at]:
        return _reset_one(env, at, None, None, shared)
    observation, shared.rewards[at], terminated, truncated, info = env.step(shared.actions[at])
    shared.observations[at], shared.terminated[at], shared.truncated[at] = observation, terminated, truncated
    return info


def _work(pipe: Connection, make: Make, first: int, count: int, shared: _Shared) -> None:
    """Runs the environments first .. first + count - 1 until the pipe is closed."""
    try:
        shared.open()
        envs = [make() for _ in range(count)]
        pipe.send(("ready", None))
        while True:
            command, data = pipe.recv()
            if command == "close":
                break
            if command == "reset":
                seeds, options = data
                infos = [_reset_one(env, first + i, seeds[i], options, shared) for i, env in enumerate(envs)]
            else:
                infos = [_step_one(env, first + i, shared) for i, env in enumerate(envs)]
            pipe.send(("done", infos))
        for env in envs:
            env.close()
    except (EOFError, KeyboardInterrupt):
        pass
    except Exception:  # is raised by the process that waits for the answer
        try:
            pipe.send(("error", traceback.format_exc()))
        except OSError:
            pass


class VectorEnv:
    """Environments that are stepped together, in several processes.

    make: a function without arguments that creates an Env. It is pickled, so it must be defined in a module.
    count: number of environments.
    processes: number of processes; None: the number of processors, at most `count`.

    reset() and step() have arrays with a row for each environment; the arrays that they return are valid until the next
    step, so copy what you keep. An environment that has ended is reset by the next step, which ignores its action and
    has the reward 0 (Gymnasium's AutoresetMode.NEXT_STEP). The results don't depend on the number of processes.

    The processes are started afresh ("spawn"), so they inherit nothing from simulations of this process; a script that
    creates a VectorEnv needs `if __name__ == "__main__":`. Call close(), or use `with`.
    """

    def __init__(self, make: Make, count: int, processes: Optional[int] = None) -> None:
        if count < 1:
            raise ValueError(f"count must be at least 1, got {count}")
        self.num_envs = count
        probe = make()
        self.single_observation_space: Box = probe.observation_space
        self.single_action_space: Box = probe.action_space
        probe.close()
        del probe
        self.observation_space = self._rows(self.single_observation_space)
        self.action_space = self._rows(self.single_action_space)
        context = multiprocessing.get_context("spawn")
        self._shared = _Shared(
            context, count, self.single_observation_space.shape[0], self.single_action_space.shape[0]
        )
        self._shared.open()
        bounds = np.linspace(0, count, min(processes or os.cpu_count() or 1, count) + 1).astype(int)
        self._ranges = list(zip(bounds[:-1].tolist(), bounds[1:].tolist()))
        self._pipes: List[Connection] = []
        self._processes: List[Any] = []
        memory = _Shared.__new__(_Shared)  # without the arrays, which are not pickled
        memory.shape, memory.memory = self._shared.shape, self._shared.memory
        for begin, end in self._ranges:
            own, other = context.Pipe()
            process = context.Process(target=_work, args=(other, make, begin, end - begin, memory), daemon=True)
            process.start()
            other.close()
            self._pipes.append(own)
            self._processes.append(process)
        self._collect()

    def _rows(self, space: Box) -> Box:
        return Box(np.tile(space.low, (self.num_envs, 1)), np.tile(space.high, (self.num_envs, 1)))

    def _collect(self) -> List[Dict[str, Any]]:
        infos: List[Dict[str, Any]] = []
        for pipe in self._pipes:
            try:
                kind, data = pipe.recv()
            except EOFError:
                kind, data = "error", "a process of the VectorEnv has ended"
            if kind == "error":
                self.close()
                raise RuntimeError(data)
            infos += data or []
        return infos

    def _request(self, requests: Sequence[Tuple[str, Any]]) -> List[Dict[str, Any]]:
        if not self._pipes:
            raise RuntimeError("the VectorEnv is closed")
        for pipe, request in zip(self._pipes, requests):
            pipe.send(request)
        return self._collect()

    def reset(
        self, *, seed: Union[int, Sequence[int], None] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[np.ndarray, List[Dict[str, Any]]]:
        """Resets all. seed: one for each; or a number, to which the index of the environment is added."""
        if isinstance(seed, (int, np.integer)):
            seeds: List[Optional[int]] = [int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = [None] * self.num_envs if seed is None else list(seed)
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed must have {self.num_envs} numbers, got {len(seeds)}")
        infos = self._request([("reset", (seeds[begin:end], options)) for begin, end in self._ranges])
        return self._shared.observations, infos

    def step(
        self, actions: Any
    ) -> Tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, List[Dict[str, Any]]]:
        """Steps all: (observations, rewards, terminated, truncated, infos)."""
        actions = np.asarray(actions, dtype=np.float64)
        if actions.shape != self._shared.actions.shape:
            raise ValueError(f"actions must have the shape {self._shared.actions.shape}, got {actions.shape}")
        self._shared.actions[:] = actions
        infos = self._request([("step", None)] * len(self._pipes))
        shared = self._shared
        return (
            shared.observations,
            shared.rewards,
            shared.terminated.astype(bool),
            shared.truncated.astype(bool),
            infos,
        )

    def close(self) -> None:
        """Ends the processes."""
        for pipe in self._pipes:
            try:
                pipe.send(("close", None))
            except OSError:
                pass
            pipe.close()
        for process in self._processes:
            process.join(5)
            if process.is_alive():
                process.terminate()
        self._pipes, self._processes = [], []

    def __enter__(self) -> "VectorEnv":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
