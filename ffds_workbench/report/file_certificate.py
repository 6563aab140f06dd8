# SPDX-License-Identifier: LGPL-2.1-or-later
"""The certificate of a written file: the shape that is read back, compared with the nominal one."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import Part

from ..brep.model_files.read_back import ReadBack
from ..brep.validity import listed
from ..errors import RefusedError
from .certificate import Certificate, Condition, condition
from .meshing import Mesh, mesh


@dataclass(frozen=True)
class FileCertificate:
    """A file as it reads back.

    Attributes
    ----------
    back : what was read, compared number by number with what was written
    before, after : the condition of the nominal shape, and of what was read
    meshes : of the nominal shape, None where that of what was read lacks nothing, and of what was read
    """

    back: ReadBack
    before: Condition
    after: Condition
    meshes: tuple[Mesh | None, Mesh]

    @property
    def lost(self) -> list[str]:
        """One sentence for everything that the nominal shape has and the file does not, and what to do; empty where
        nothing is lost."""
        nominal, own = self.meshes
        sentences = []
        if self.before.closed and not self.after.closed:
            sentences.append("The shape is no longer closed.")
        if nominal is not None:
            sentences += [f"Face{face + 1} gives no triangles." for face in own.empty if face not in nominal.empty]
        if sentences and self.back.suffix in (".step", ".stp"):
            sentences.append("Write .brep or .FCStd, which store the shape as it is.")
        return sentences

    @property
    def notes(self) -> list[str]:
        """One sentence for everything that is looser than the nominal shape, but closed and valid."""
        nominal, own = self.meshes
        sentences = Certificate(self.before, self.after).looser()
        if self.before.invalid:
            still = listed(self.after.invalid) if self.after.invalid else "nothing"
            sentences.append(f"The nominal model is not valid in {listed(self.before.invalid)} (Part: Check geometry "
                             f"lists why); of the as-built one {still} is not.")
        if nominal is not None and own.open_edges and not nominal.open_edges:
            sentences.append(f"The mesh of the file has {own.open_edges} open edges.")
        return sentences

    def line(self) -> str:
        """What was read back, in a line."""
        kept = "OTHER NUMBERS, " if self.back.differences(self.before.topology) else "numbers kept, "
        return (f"Read back from {self.back.suffix}: {kept}{'valid' if self.after.valid else 'NOT VALID'}, "
                f"{'closed' if self.after.closed else 'open'}; largest edge gap {self.after.max_edge_gap:.1e} mm, "
                f"tolerance {self.after.max_tolerance:.1e} mm")

    def as_dict(self) -> dict[str, Any]:
        """The report's ``topology.written`` block; lengths in mm."""
        read, written = self.after.topology, self.before.topology
        return {"format": self.back.suffix.lstrip("."), "counts": read.counts,
                "numbers_kept": not self.back.differences(written),
                "turned_faces": _names("Face", written.reversed_faces, read.reversed_faces),
                "turned_edges": _names("Edge", written.edge_starts, read.edge_starts),
                "edge_offset": self.back.edge_offset, "valid": self.after.valid, "closed": self.after.closed,
                "max_edge_gap": self.after.max_edge_gap, "max_tolerance": self.after.max_tolerance,
                "faces_without_mesh": [f"Face{face + 1}" for face in self.meshes[1].empty],
                "open_mesh_edges": self.meshes[1].open_edges, "notes": self.notes}


def _names(kind: str, before: tuple, after: tuple) -> list[str]:
    pairs = enumerate(zip(before, after, strict=True), 1)
    return [f"{kind}{number}" for number, (was, is_now) in pairs if was != is_now]


def certify_file(nominal: Part.Shape, before: Condition, back: ReadBack) -> FileCertificate:
    """Judge what was read back beside the nominal shape and its condition.

    Raises
    ------
    RefusedError : a shell is open, or a face gives no triangles, that is closed or does in the nominal shape
    """
    own = mesh(back.shape)
    lacks = bool(own.empty or own.open_edges)
    result = FileCertificate(back, before, condition(back.shape), (mesh(nominal.copy()) if lacks else None, own))
    if result.lost:
        raise RefusedError(f"The {back.suffix} file does not contain the complete model and was not kept: "
                           + " ".join(result.lost))
    return result
