# SPDX-License-Identifier: LGPL-2.1-or-later
"""FFDS_RepointReferences: makes what refers to the nominal part refer to the selected as-built one."""
from __future__ import annotations

from ...running import call, name_of, tell
from ...selection import chosen
from ...translating import tr
from ..command import Command, one_as_built


class RepointReferences(Command):
    """Changes the links of other objects, in one undo step."""

    NAME = "FFDS_RepointReferences"
    MENU = "Re-point references"
    TIP = "Let what refers to the nominal part, or to its faces and edges, refer to the selected as-built part"
    HELP = ("Sketches on a face, fillets, cuts, drawings, seams: what refers to the nominal part or to its faces, "
            "edges and vertices refers to the same ones of the selected as-built part from now on. What cannot be "
            "computed on it is left as it was.")
    KEYS = "F, O"
    NEEDS = "Select one as-built part first."

    def active(self) -> bool:
        """With one as-built part selected."""
        return one_as_built(chosen()) is not None

    def run(self) -> None:
        """Re-point, and say what was left as it was."""
        from ....objects.repointing import references

        part = one_as_built(chosen())
        call(part.Document, "Re-point references", f"repoint({name_of(part)})")
        left = ", ".join(dict.fromkeys(reference.item.Label for reference in references(part)))
        if left:
            tell(tr("{names} cannot be computed on {part} and still refer to {source}.").format(
                names=left, part=part.Label, source=part.Source.Label))
