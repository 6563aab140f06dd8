# SPDX-License-Identifier: LGPL-2.1-or-later
"""The life of a process that registers parts: a setup, then parts, until there is nobody left to work for."""
from __future__ import annotations

import os
import queue
import threading
from dataclasses import replace
from multiprocessing.connection import Connection
from typing import Any

from .. import find_freecad
from ..errors import FfdsError
from .part_process import resident_memory


def serve(descriptor: int) -> None:
    """Take parts from a connection, one after the other; the model is read when the first one comes."""
    connection, waiting = Connection(descriptor), queue.SimpleQueue[Any]()
    threading.Thread(target=_listen, args=(connection, waiting), daemon=True).start()
    setup = waiting.get()
    find_freecad.activate()
    from .part import PreparedSeries

    prepared: PreparedSeries | None = None
    while True:
        job = waiting.get()
        try:
            prepared = prepared or PreparedSeries(setup)
            connection.send(replace(prepared.do(job), memory=resident_memory(os.getpid())))
        except FfdsError as error:
            connection.send(error)


def _listen(connection: Connection, waiting: queue.SimpleQueue[Any]) -> None:
    """Pass on what comes; who has nobody left to work for ends at once."""
    while True:
        try:
            waiting.put(connection.recv())
        except (EOFError, OSError):
            os._exit(1)
