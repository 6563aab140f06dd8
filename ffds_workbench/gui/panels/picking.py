# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which part, and which faces of it, the deformation panel is on: what clicks and selections mean to it."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD

from ...brep import workpiece
from ...errors import InputError
from ...objects.as_built import is_as_built
from ...objects.scans import scan_cloud
from ...objects.sources import read_source, standing_for
from ...registration.face import observed_faces
from ..selection import Chosen, face_at, parts_shown
from ..translating import said, tr
from ..view3d.rubber_band import faces_within
from .deformation_form import DeformationForm


def one_shown(document: Any) -> Any:
    """The visible part of a document where it has but one.

    Raises
    ------
    InputError : there are none, or several
    """
    found = parts_shown(document)
    if len(found) != 1:
        raise InputError(tr("Pick the part in the 3D view."))
    return found[0]


def faces_in_box(document_name: str, box: Any, part: Any, scan: Any) -> list[str]:
    """Names of the faces of a part in a box on the screen: those that the scan shows, or all where it shows none."""
    source = read_source(part)
    standing = source.model.shape.copy()
    standing.Placement = FreeCAD.Placement(FreeCAD.Matrix(*source.T_document_part.ravel().tolist()))
    inside = faces_within(document_name, box, standing)
    if scan is None:
        return inside
    faces = workpiece.read(source.model.shape)
    shown = observed_faces([faces.geometry(index) for index in range(len(faces.faces))],
                           source.to_part(scan_cloud(scan)).points)
    return [name for name in inside if faces.index(name) in shown] or inside


class Picking:
    """What is picked.

    Parameters
    ----------
    item : the as-built part that is being changed, or None
    form : takes the scan and the frozen faces

    Attributes
    ----------
    source : the nominal part, None before one is picked
    faces : names of its faces
    hint : what to say of the last pick, "" for nothing
    """

    def __init__(self, item: Any, form: DeformationForm) -> None:
        self._item, self._form = item, form
        self.source: Any = None if item is None else item.Source
        self.faces: tuple[str, ...] = ()
        self.hint = ""

    def take(self, selected: Chosen, adding: bool = False) -> None:
        """Take over the part, the faces and the scan of a selection; what cannot be used is said.

        Where a scan was clicked, the faces below the clicks are meant.
        """
        self.hint = ""
        if selected.scans:
            self._form.set_scan(selected.scans[-1])
        try:
            if selected.refusal:
                raise InputError(selected.refusal)
            picked: dict[Any, list[str]] = {}
            for part in selected.parts:
                picked.setdefault(self._meant(part), []).extend(selected.faces[part.Name])
            for place in selected.places if not any(picked.values()) else ():
                below = face_at(selected.scans[-1].Document, place)
                if below is not None and (not picked or self._meant(below[0]) in picked):
                    picked.setdefault(self._meant(below[0]), []).append(below[1])
            if len(picked) > 1:
                raise InputError(tr("Faces of two parts are selected: choose those of one."))
            for part, faces in picked.items():
                self.pick(part, tuple(dict.fromkeys(faces)), adding)
            if selected.others:
                raise InputError(tr("{name} is neither a face nor a point cloud: pick faces of a part, and a scan."
                                    ).format(name=selected.others[0]))
        except InputError as refusal:
            self.hint = said(str(refusal))

    def _meant(self, part: Any) -> Any:
        """The part to deform where ``part`` was picked: for a result its nominal one, whose faces are named alike."""
        if not is_as_built(part) or part.Source is None:
            return standing_for(part)
        if part is not self._item:
            self.hint = tr("{part} is a result: its nominal part {source} is deformed anew.").format(
                part=part.Label, source=part.Source.Label)
        return part.Source

    def pick(self, part: Any, faces: Sequence[str], adding: bool) -> None:
        """Take faces of a part; ``adding`` adds them to the others, or takes those away that are picked.

        Raises
        ------
        InputError : another part is being changed
        """
        if self._item is not None and part is not self.source:
            raise InputError(tr("{part} is made from {source}: pick faces of one of these two.").format(
                part=self._item.Label, source=self.source.Label))
        if part is not self.source:
            self.source, self.faces = part, ()
        if self._form.picks_frozen:
            self._form.toggle_frozen(faces)
        elif faces and adding:
            self.faces = tuple(name for name in dict.fromkeys((*self.faces, *faces))
                               if name not in self.faces or name not in faces)
        elif faces:
            self.faces = tuple(faces)

    def take_other_side(self, named: str, shown: str) -> None:
        """Take the face that the scan shows instead of the one on the other side of its sheet."""
        self.faces = tuple(dict.fromkeys(shown if name == named else name for name in self.faces))

    def show(self) -> None:
        """Say in the form what is picked."""
        self._form.show_picked(self.source.Label if self.source is not None else "", self.faces)
