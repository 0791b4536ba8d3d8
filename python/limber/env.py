"""Env: a simulation with the protocol of Gymnasium environments, which need not be installed."""

from __future__ import annotations

from typing import Any, Callable, Dict, Optional, Sequence, Tuple

import numpy as np

from . import Property, Sim


class Box:
    """A space of arrays with bounds, like gymnasium.spaces.Box."""

    def __init__(self, low: np.ndarray, high: np.ndarray, seed: Optional[int] = None) -> None:
        self.low = np.asarray(low, dtype=np.float64)
        self.high = np.asarray(high, dtype=np.float64)
        self.shape: Tuple[int, ...] = self.low.shape
        self.dtype = self.low.dtype
        self._random = np.random.default_rng(seed)

    def seed(self, seed: Optional[int] = None) -> None:
        """Seeds sample()."""
        self._random = np.random.default_rng(seed)

    def sample(self) -> np.ndarray:
        """Returns a random element: uniform where both bounds are finite, else normal, clipped to the bounds."""
        bounded = np.isfinite(self.low) & np.isfinite(self.high)
        low, high = np.where(bounded, self.low, 0.0), np.where(bounded, self.high, 1.0)
        uniform = self._random.uniform(low, high)
        normal = np.clip(self._random.normal(size=self.shape), self.low, self.high)
        return np.where(bounded, uniform, normal)

    def contains(self, x: Any) -> bool:
        """True if x is an array of this shape within the bounds."""
        array = np.asarray(x)
        return array.shape == self.shape and bool(np.all(array >= self.low) and np.all(array <= self.high))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Box) and np.array_equal(self.low, other.low) and np.array_equal(self.high, other.high)

    def __repr__(self) -> str:
        return f"Box(shape={self.shape})"


Reward = Callable[["Env"], float]
Test = Callable[["Env"], bool]


class Env:
    """A scene as an environment: actions set properties, observations read properties.

    scene, seed, text: see Sim.
    actions: addresses of the properties that an action sets, such as "/physics/body/dog/motor/*/target".
    observations: addresses of the properties that an observation consists of, in this order.
    ticks: ticks per step.
    low, high: the bounds of actions, numbers or arrays; None: the ranges of the properties.
    reward: the reward of a step, from the environment; 0 without it.
    terminated: true if the episode has ended by itself, such as a fall.
    max_steps: the episode is truncated after this number of steps; 0: never.
    render_mode: "rgb_array": render() returns an image; None: it returns None.
    camera: arguments of Sim.render() for render(): width, height, position, target, fovy, quality.

    `sim`, `actions` and `observations` (lists of Property) may be used between steps. Subclasses may override
    `compute_reward`, `is_terminated`, `info` and `on_reset`. Random numbers of an environment: `np_random`.
    """

    metadata: Dict[str, Any] = {"render_modes": ["rgb_array"]}
    spec = None

    def __init__(
        self,
        scene: Optional[str] = None,
        *,
        actions: Sequence[str],
        observations: Sequence[str],
        seed: Optional[int] = None,
        text: Optional[str] = None,
        ticks: int = 1,
        low: Any = None,
        high: Any = None,
        reward: Optional[Reward] = None,
        terminated: Optional[Test] = None,
        max_steps: int = 0,
        render_mode: Optional[str] = None,
        camera: Optional[Dict[str, Any]] = None,
        **options: Any,
    ) -> None:
        if ticks < 1:
            raise ValueError(f"ticks must be at least 1, got {ticks}")
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise ValueError(f"render_mode must be 'rgb_array' or None, got {render_mode!r}")
        self.render_mode, self.camera = render_mode, dict(camera or {})
        self.sim = Sim(scene, seed, text=text, **options)
        self.metadata = {**self.metadata, "render_fps": 1 / (self.sim.timestep * ticks)}
        self.actions = [self.sim.property(address) for address in actions]
        self.observations = [self.sim.property(address) for address in observations]
        for action in self.actions:
            if not action.writable:
                raise ValueError(f"actions: {action.addresses[0]} is read-only")
        self.ticks, self.max_steps = ticks, max_steps
        self._reward, self._terminated = reward, terminated
        own_low, own_high = self._ranges(self.actions)
        self.action_space = Box(
            own_low if low is None else np.broadcast_to(np.asarray(low, float), own_low.shape),
            own_high if high is None else np.broadcast_to(np.asarray(high, float), own_high.shape),
        )
        self.observation_space = Box(*self._ranges(self.observations))
        self._observation = np.empty(self.observation_space.shape)
        self.np_random = np.random.default_rng(seed)
        self.steps = 0
        self._needs_reset = True
        self._start = self.sim.state()

    @staticmethod
    def _ranges(properties: Sequence[Property]) -> Tuple[np.ndarray, np.ndarray]:
        low, high = [], []
        for one in properties:
            width = 1 if one.values.ndim == 1 else one.values.shape[1]
            ranges = [one.range(i) for i in range(width)] * len(one.addresses)
            low += [r[0] for r in ranges]
            high += [r[1] for r in ranges]
        return np.array(low, float), np.array(high, float)

    @property
    def unwrapped(self) -> "Env":
        return self

    def compute_reward(self) -> float:
        """The reward of the last step."""
        return 0.0 if self._reward is None else float(self._reward(self))

    def is_terminated(self) -> bool:
        """True if the episode has ended by itself."""
        return False if self._terminated is None else bool(self._terminated(self))

    def info(self) -> Dict[str, Any]:
        """Further data about the last step."""
        return {"time": self.sim.time}

    def on_reset(self, options: Dict[str, Any]) -> None:
        """Changes the start of an episode, for example with np_random."""

    def observe(self) -> np.ndarray:
        """Returns a new array with the present observation."""
        at = 0
        for one in self.observations:
            values = one.read()
            self._observation[at : at + values.size] = values.ravel()
            at += values.size
        return self._observation.copy()

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[np.ndarray, Dict[str, Any]]:
        """Begins an episode: runs the scene again with the seed, or without one returns to its start."""
        if seed is not None:
            self.np_random = np.random.default_rng(seed)
            self.sim.reset(seed)
            self._start = self.sim.state()
        else:
            self.sim.restore(self._start)
        self.steps = 0
        self._needs_reset = False
        self.on_reset(options or {})
        return self.observe(), self.info()

    def step(self, action: Any) -> Tuple[np.ndarray, float, bool, bool, Dict[str, Any]]:
        """Sets the action, advances by `ticks`, and returns (observation, reward, terminated, truncated, info)."""
        if self._needs_reset:
            raise RuntimeError("step() before reset()")
        action = np.asarray(action, dtype=np.float64)
        if action.shape != self.action_space.shape:
            raise ValueError(f"the action must have the shape {self.action_space.shape}, got {action.shape}")
        action = np.clip(action, self.action_space.low, self.action_space.high)
        at = 0
        for one in self.actions:
            one.write(action[at : at + one.values.size])
            at += one.values.size
        self.sim.step(self.ticks)
        self.steps += 1
        terminated = self.is_terminated()
        truncated = 0 < self.max_steps <= self.steps
        self._needs_reset = terminated or truncated
        return self.observe(), self.compute_reward(), terminated, truncated, self.info()

    def render(self) -> Optional[np.ndarray]:
        """With the render mode "rgb_array", an image (height, width, 3) of the present state."""
        return self.sim.render(**self.camera) if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        """Ends the environment."""
        self._needs_reset = True
