"""The default log of simulations: print() of scripts to standard output, warnings and errors to standard error.

Like the program, it limits repetition, so that a training with many episodes doesn't fill a terminal or a disk: lines
that differ in their numbers only have ten lines at once, then one a minute. print() has 2000 lines at once, then 200 a
second.
"""

from __future__ import annotations

import re
import sys
import threading
import time
from typing import Callable, Dict, Optional

_NUMBER = re.compile(r"(?<![\w'])[-+]?\d[\w.]*")


class _Bucket:
    """`burst` tokens at once, then one in each `interval` (s)."""

    def __init__(self, burst: int, interval: float, now: float) -> None:
        self.burst, self.interval = burst, interval
        self.tokens, self.filled = float(burst), now
        self.suppressed = 0

    def admit(self, now: float) -> Optional[int]:
        """The number of lines that were suppressed before this one; None: this one is suppressed."""
        self.tokens = min(float(self.burst), self.tokens + (now - self.filled) / self.interval)
        self.filled = now
        if self.tokens < 1:
            self.suppressed += 1
            return None
        self.tokens -= 1
        missing, self.suppressed = self.suppressed, 0
        return missing


class PrintLog:
    """A log function with rate limits, for all simulations that use it. `clock` returns seconds."""

    LINES, INTERVAL = 10, 60.0
    PRINTS, PRINTS_PER_SECOND = 2000, 200
    SOURCES = 256

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._sources: Dict[str, _Bucket] = {}  # the one that was used last is the last
        self._prints = _Bucket(self.PRINTS, 1 / self.PRINTS_PER_SECOND, clock())

    def __call__(self, level: str, text: str) -> None:
        if level == "info":
            return
        with self._lock:
            missing = self._admit(level, text)
        if missing is None:
            return
        if level == "print":
            if missing:
                print(f"limber: {missing} lines of print() were dropped", file=sys.stderr)
            print(text)
        else:
            more = f" (and {missing} more since the last one)" if missing else ""
            print(f"limber: {level}: {text}{more}", file=sys.stderr)

    def _admit(self, level: str, text: str) -> Optional[int]:
        now = self._clock()
        if level == "print":
            return self._prints.admit(now)
        source = _NUMBER.sub("#", text)
        bucket = self._sources.pop(source, None) or _Bucket(self.LINES, self.INTERVAL, now)
        self._sources[source] = bucket
        if len(self._sources) > self.SOURCES:
            del self._sources[next(iter(self._sources))]
        return bucket.admit(now)


print_log = PrintLog()
