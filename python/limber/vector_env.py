"""VectorEnv: environments that are stepped together, in several processes with shared memory."""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import signal
import traceback
from multiprocessing.connection import Connection
from typing import Any, Callable, Dict, List, NoReturn, Optional, Sequence, Tuple, Union

import numpy as np

from .env import Box, Env

Make = Callable[[], Env]

_JOIN_SECONDS = 5


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
            if command == "render":
                infos = [env.render() for env in envs]
            elif command == "reset":
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


def _cause(process: Any) -> str:
    """Why a process has ended."""
    process.join(_JOIN_SECONDS)
    code = process.exitcode
    if code is None:
        return "has closed its connection, but still runs"
    if code >= 0:
        return f"has exited with status {code}; its own messages are above"
    try:
        name = signal.Signals(-code).name
    except ValueError:
        name = f"signal {-code}"
    hint = "; was memory short?" if name == "SIGKILL" else ""
    return f"was ended by {name}{hint}"


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

    def _collect(self) -> List[Any]:
        infos: List[Any] = []
        for worker, pipe in enumerate(self._pipes):
            try:
                kind, data = pipe.recv()
            except (EOFError, OSError):
                self._fail(worker, _cause(self._processes[worker]))
            if kind == "error":
                self._fail(worker, f"failed:\n{data}")
            infos += data or []
        return infos

    def _fail(self, worker: int, why: str) -> NoReturn:
        """Raises the error of a worker, and ends all of them: the environments don't fit together any more."""
        begin, end = self._ranges[worker]
        which = f"environment {begin}" if end == begin + 1 else f"environments {begin} to {end - 1}"
        pid = self._processes[worker].pid
        self.close()
        raise RuntimeError(f"worker {worker} of the VectorEnv ({which}, process {pid}) {why}")

    def _request(self, requests: Sequence[Tuple[str, Any]]) -> List[Any]:
        if not self._pipes:
            raise RuntimeError("the VectorEnv is closed")
        for worker, (pipe, request) in enumerate(zip(self._pipes, requests)):
            try:
                pipe.send(request)
            except OSError:
                # the error that the worker has reported before it ended, or else its exit
                if not pipe.poll():
                    self._fail(worker, _cause(self._processes[worker]))
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

    def render(self) -> Tuple[Optional[np.ndarray], ...]:
        """The image of each environment, by its render mode."""
        return tuple(self._request([("render", None)] * len(self._pipes)))

    def close(self) -> None:
        """Ends the processes."""
        for pipe in self._pipes:
            try:
                pipe.send(("close", None))
            except OSError:
                pass
            pipe.close()
        for process in self._processes:
            process.join(_JOIN_SECONDS)
            if process.is_alive():
                process.terminate()
        self._pipes, self._processes = [], []

    def __enter__(self) -> "VectorEnv":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
