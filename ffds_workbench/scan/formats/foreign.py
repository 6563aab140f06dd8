# SPDX-License-Identifier: LGPL-2.1-or-later
"""Formats that libraries read where they are installed: LAS and LAZ by laspy, OBJ by trimesh.

Both keep doubles, unlike open3d, which reads the coordinates of OBJ in single precision.
"""
from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputError

_CHUNK = 1_000_000
_LAS_HEADER, _LAS_RECORD = 104, 54
"""Bytes at the beginning of a LAS file that are looked at here, and of the shortest record between them and the points.
"""
_LARGEST_GAIN = 64
"""Points that a byte of a compressed file may stand for; scans of real things take some bytes a point."""


def las(path: Path) -> NDArray[np.float64]:
    """The points of a LAS or LAZ file, (n, 3), scaled and shifted as its header says.

    Raises
    ------
    InputError : laspy is not installed, or the file is damaged or cut off
    """
    laspy = _library("laspy", path, "laspy and, for .laz, lazrs (pip install laspy lazrs)")
    with path.open("rb") as stream:
        try:
            _check_las_header(stream.read(_LAS_HEADER))
            stream.seek(0)
            with laspy.open(stream, closefd=False, read_evlrs=False) as reader:
                count, least = reader.header.point_count, reader.header.point_format.size
                if count > path.stat().st_size * (_LARGEST_GAIN if reader.header.are_points_compressed else 1 / least):
                    raise ValueError("more points than there can be")
                chunks = [np.column_stack([chunk.x, chunk.y, chunk.z]) for chunk in reader.chunk_iterator(_CHUNK)]
        except (MemoryError, OSError):
            raise
        except laspy.errors.LaspyException as error:
            raise InputError(f"The scan {path} cannot be read: {' '.join(str(error).split())[:150]}.") from error
        except Exception as error:  # of the decompressor and of numpy, where the bytes make no sense
            raise _damaged(path) from error
    points = np.concatenate([np.empty((0, 3)), *chunks])
    if len(points) < count:
        raise InputError(f"The scan {path} is cut off: its header promises {count} points, {len(points)} are there.")
    return points


def obj(path: Path) -> NDArray[np.float64]:
    """The vertices of a Wavefront OBJ file, (n, 3), with or without faces between them.

    Raises
    ------
    InputError : trimesh is not installed, or the file is damaged
    """
    trimesh = _library("trimesh", path, "trimesh (pip install trimesh)")
    text = path.read_bytes().decode("utf-8", errors="replace")
    vertices = "\n".join(line for line in text.splitlines() if line.startswith(("v ", "v\t")))  # no faces, no materials
    try:
        loaded = trimesh.load(trimesh.util.wrap_as_stream(vertices), file_type="obj", process=False)
        return np.asarray(loaded.vertices, dtype=float).reshape(-1, 3)
    except (MemoryError, OSError):
        raise
    except Exception as error:  # whatever a library says of a text that makes no sense
        raise _damaged(path) from error


def _check_las_header(header: bytes) -> None:
    """Refuse a number of records that do not fit before the points (ValueError): laspy would count to four billion."""
    first_point, records = (int.from_bytes(header[at : at + 4], "little") for at in (96, 100))
    if records * _LAS_RECORD > first_point:
        raise ValueError("more records than there can be")


def _library(name: str, path: Path, what: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise InputError(f"The scan {path} needs {what}, which is not installed: install it, or save the scan as .ply "
                         f"or .e57.") from error


def _damaged(path: Path) -> InputError:
    return InputError(f"The scan {path} is damaged or cut off: its points cannot be read.")
