# SPDX-License-Identifier: LGPL-2.1-or-later
"""How long the stages of a job took."""
from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[str], None]


class Stopwatch:
    """Times named stages and calls a progress callback with what is being done.

    Parameters
    ----------
    progress : called with a text at the start of each stage, or None
    """

    def __init__(self, progress: Progress | None = None) -> None:
        self._progress = progress
        self._stages: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str, text: str) -> Iterator[None]:
        """Time a stage; stages of the same name add up."""
        self.tell(text)
        start = time.perf_counter()
        try:
            yield
        finally:
            self._stages[name] = self._stages.get(name, 0.0) + time.perf_counter() - start

    def tell(self, text: str) -> None:
        """Say what is being done now."""
        if self._progress is not None:
            self._progress(text)

    def times(self) -> dict[str, float]:
        """Seconds per stage, and of all of them."""
        return {**self._stages, "total": sum(self._stages.values())}
