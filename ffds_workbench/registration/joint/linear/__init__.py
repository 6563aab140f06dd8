# SPDX-License-Identifier: LGPL-2.1-or-later
"""The sparse linear system: `normal_equations` that rows are added to, `system` (their pattern and solution),
`cholesky` (multifrontal factor and selected inverse), `elimination_order` (nested dissection) and `memory` (what all of
it takes).
"""
from .cholesky import FrontCholesky
from .memory import refuse_too_large
from .normal_equations import NormalEquations
from .system import Pattern, SomeBlocks, solve_normal_equations

__all__ = ["FrontCholesky", "NormalEquations", "Pattern", "SomeBlocks", "refuse_too_large", "solve_normal_equations"]
