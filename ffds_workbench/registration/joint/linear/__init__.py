# SPDX-License-Identifier: LGPL-2.1-or-later
"""The sparse linear system: `system` (pattern, assembly, solution), `cholesky` (multifrontal factor and selected
inverse) and `dissection` (the elimination order).
"""
from .cholesky import FrontCholesky
from .system import Pattern, solve_normal_equations

__all__ = ["FrontCholesky", "Pattern", "solve_normal_equations"]
