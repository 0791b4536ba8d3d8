"""Limber, the simulator of articulated bodies, as a library.

>>> import limber
>>> sim = limber.Sim("scripts/quadruped.lua", seed=1)
>>> angles = sim.property("/physics/body/dog/joint/*/value")
>>> sim.step(60)
>>> angles.read()            # a NumPy array of 12 numbers, rad

Several simulations may run in a process, on one thread each; a step lets other Python threads run. After a fork, a
child process creates its own simulations. Subinterpreters are rejected.
"""

from __future__ import annotations

import os
from typing import Callable, Optional, Union

from . import _core
from ._core import Property, SimError, State, data_folder
from .log import print_log

__version__: str = _core.version
__all__ = ["Box", "Env", "Property", "Sim", "SimError", "State", "VectorEnv", "__version__", "data_folder"]

Log = Callable[[str, str], None]


class Sim(_core.Sim):
    """A simulation of a scene.

    scene: a scene file (.lua).
    seed: the random seed, 0 to 2^53; None: that of the scene.
    text: the scene's text instead of a file; `scene` then is its name, in the folder where it finds other files.
    threads: threads of each physics step; the result is the same for any number.
    log: called with (level, text) for each log line; level is "info", "warning", "error" or "print". None: no log. The
        default prints, with limits for lines that are repeated (limber.log).
    data: the folder with Limber's scripts/ and urdf/; None: that of the installation.

    Raises SimError if the scene has an error; the text has file and line.
    """

    def __init__(
        self,
        scene: Union[str, os.PathLike, None] = None,
        seed: Optional[int] = None,
        *,
        text: Optional[str] = None,
        threads: int = 1,
        log: Optional[Log] = print_log,
        data: Union[str, os.PathLike, None] = None,
    ) -> None:
        if seed is not None and not 0 <= seed <= 2**53:
            raise ValueError(f"seed must be 0 to 2^53, got {seed}")
        file = None if scene is None else os.fspath(scene)
        folder = None if data is None else os.fspath(data)
        super().__init__(file, text, seed, folder, threads, log)


from .env import Box, Env  # noqa: E402
from .vector_env import VectorEnv  # noqa: E402
