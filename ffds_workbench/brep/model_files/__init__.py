# SPDX-License-Identifier: LGPL-2.1-or-later
"""Model files: `model_file` reads and writes them whole, `step_colours` keeps names and colours in a STEP file,
`document_colours` in a FreeCAD document. `reading` reads foreign files in a process of their own, with `reader`.
"""


__all__ = []
