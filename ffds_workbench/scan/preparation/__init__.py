# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scan preparation: what users would otherwise do in another program before registration.

`steps` runs them all, `settings` holds what is wanted and what was done; one module per step: `fusing` with its
`poses`, `crop`, `table`, `clutter` (things that stand apart, and single points), `thinning` with normals. Lengths that
are not given come from the scan: its `spacing`, its size. `library` loads open3d when a step needs it; nothing else of
FFDS does, but for the peers it is measured against.
"""
from .settings import PreparationSettings, PreparedScan, PreparationStep, PartSurface
from .steps import prepare

__all__ = ["PreparationSettings", "PreparedScan", "PreparationStep", "PartSurface", "prepare"]
