# SPDX-License-Identifier: LGPL-2.1-or-later
"""The sparse linear system: `system` (pattern, assembly, solution), `cholesky` (multifrontal factor and selected
inverse) and `dissection` (the elimination order).
"""
from .cholesky import FrontCholesky
from .system import Pattern, solve

__all__ = ["FrontCholesky", "Pattern", "solve"]
