# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the body deforms as one: `kriging` of a displacement in space, and the `body_rows` that it gives the solve."""
from .body_rows import BodyRows, add_body_rows, body_informs, body_rows

__all__ = ["BodyRows", "add_body_rows", "body_informs", "body_rows"]
