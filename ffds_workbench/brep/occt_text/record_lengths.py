# SPDX-License-Identifier: LGPL-2.1-or-later
"""How many tokens the geometry records of a BREP text have: where one ends and the next begins."""
from __future__ import annotations

# Tokens after the type digit of the records whose length is fixed, and where the basis record of the others starts.
_CURVE_2D_LENGTH = {"1": 4, "2": 7, "3": 8, "4": 7, "5": 8}
_CURVE_3D_LENGTH = {"1": 6, "2": 13, "3": 14, "4": 13, "5": 14}
_SURFACE_LENGTH = {"1": 12, "2": 13, "3": 14, "4": 13, "5": 14}


def curve_2d_end(tokens: list[str], start: int) -> int:
    """Position after the 2-D curve record that begins at ``start``."""
    return _curve_end(tokens, start, _CURVE_2D_LENGTH, 2)


def curve_3d_end(tokens: list[str], start: int) -> int:
    """Position after the 3-D curve record that begins at ``start``."""
    return _curve_end(tokens, start, _CURVE_3D_LENGTH, 3)


def _curve_end(tokens: list[str], start: int, fixed: dict[str, int], dimension: int) -> int:
    kind = tokens[start]
    if kind in fixed:
        return start + 1 + fixed[kind]
    if kind == "6":
        rational, degree = int(tokens[start + 1]), int(tokens[start + 2])
        return start + 3 + (degree + 1) * (dimension + rational)
    if kind == "7":
        rational, poles, knots = int(tokens[start + 1]), int(tokens[start + 4]), int(tokens[start + 5])
        return start + 6 + poles * (dimension + rational) + 2 * knots
    if kind == "8":
        return _curve_end(tokens, start + 3, fixed, dimension)
    if kind == "9":
        return _curve_end(tokens, start + 2 + (3 if dimension == 3 else 0), fixed, dimension)
    raise ValueError(f"unknown curve type {kind}")


def surface_end(tokens: list[str], start: int) -> int:
    """Position after the surface record that begins at ``start``."""
    kind = tokens[start]
    if kind in _SURFACE_LENGTH:
        return start + 1 + _SURFACE_LENGTH[kind]
    if kind == "6":
        return curve_3d_end(tokens, start + 4)
    if kind == "7":
        return curve_3d_end(tokens, start + 7)
    if kind == "8":
        rational_u, rational_v, degree_u, degree_v = map(int, tokens[start + 1 : start + 5])
        return start + 5 + (degree_u + 1) * (degree_v + 1) * (3 + (rational_u or rational_v))
    if kind == "9":
        rational_u, rational_v, *_ = map(int, tokens[start + 1 : start + 7])
        poles_u, poles_v, knots_u, knots_v = map(int, tokens[start + 7 : start + 11])
        return start + 11 + poles_u * poles_v * (3 + (rational_u or rational_v)) + 2 * (knots_u + knots_v)
    if kind == "10":
        return surface_end(tokens, start + 5)
    if kind == "11":
        return surface_end(tokens, start + 2)
    raise ValueError(f"unknown surface type {kind}")
