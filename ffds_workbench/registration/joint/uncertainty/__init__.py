# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far the result can be trusted: `covariance` of the control points, 95 % `bands`, `misfit` (the lattices' own
errors), `shared_noise` (errors that neighbouring points share), `observed_cells`, and the `assessment` that reports
them.
"""
from .assessment import assess
from .covariance import prior_cost
from .misfit import misfit

__all__ = ["assess", "misfit", "prior_cost"]
