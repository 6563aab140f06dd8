# SPDX-License-Identifier: LGPL-2.1-or-later
"""Prints the OPENBLAS_CORETYPE to run tests under once more, or nothing where there is no other to run.

The kernels of OpenBLAS differ in the last bits of a sum. Haswell's, which Zen shares and most desktops use, multiply
and add in one step; those of the newest servers add in other blocks; Prescott's, which any x86-64 can run, do neither.
"""
from __future__ import annotations

import ctypes
from pathlib import Path

import numpy  # noqa: F401 (loads BLAS)


def own() -> str:
    """The kernels that OpenBLAS has chosen for this processor, "" where there is no OpenBLAS."""
    for library in {line.split()[-1] for line in Path("/proc/self/maps").read_text().splitlines() if "blas" in line}:
        core = getattr(ctypes.CDLL(library), "openblas_get_corename", None)
        if core is not None:
            core.restype = ctypes.c_char_p
            return core().decode()
    return ""


def other(own: str, flags: set[str]) -> str:
    """Kernels that a processor with those flags can run, and that are not its own."""
    can_run = {"Haswell": {"avx2", "fma"} <= flags and own != "Zen", "Prescott": "pni" in flags}
    return next((name for name, can in can_run.items() if can and own and name != own), "")


if __name__ == "__main__":
    print(other(own(), set(Path("/proc/cpuinfo").read_text().split())))
