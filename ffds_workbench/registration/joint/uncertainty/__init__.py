# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much the result can be trusted: `covariance` of the control points, 95 % `bands`, `shared_noise` (errors that
neighbouring points share), `observed_cells`, and the `assessment` that reports them.
"""
from .assessment import assess

__all__ = ["assess"]
