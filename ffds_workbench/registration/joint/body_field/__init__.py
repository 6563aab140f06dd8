# SPDX-License-Identifier: LGPL-2.1-or-later
"""The body deforms as a whole: `kriging` of its displacement in space, and the `body_rows` that follow for the
solve."""
from .body_rows import BodyRows, add_body_rows, body_informs, body_rows

__all__ = ["BodyRows", "add_body_rows", "body_informs", "body_rows"]
