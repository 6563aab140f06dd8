# SPDX-License-Identifier: LGPL-2.1-or-later
"""The entry of FreeCAD's Test workbench: whether FFDS works in this FreeCAD, in a few seconds.

The example has a noise of 0.05 mm; what is asked of the result allows twice that. All tests are under ``tests``.
"""
from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

import FreeCAD

NOISE = 0.05


class FFDSTest(unittest.TestCase):
    """The example, from the document object to the file."""

    def setUp(self) -> None:
        """A document with the bracket and its scan."""
        from . import actions

        self.document = FreeCAD.newDocument("FFDS_test")
        self.part, self.scan = actions.load_example(self.document)

    def tearDown(self) -> None:
        """Leave nothing open."""
        FreeCAD.closeDocument(self.document.Name)

    def test_a_face_is_deformed_and_the_topology_stays(self) -> None:
        """One face of the example is deformed to the scan and written."""
        from . import actions

        item = actions.make_as_built(self.part, self.scan, faces=["Face9"])
        self.assertTrue(item.isValid() and item.Shape.isValid())
        self.assertEqual([len(item.Shape.Faces), len(item.Shape.Edges), len(item.Shape.Vertexes)],
                         [len(self.part.Shape.Faces), len(self.part.Shape.Edges), len(self.part.Shape.Vertexes)])
        self.assertLess(item.MeanAfter.Value, 2 * NOISE)
        with tempfile.TemporaryDirectory() as folder:
            actions.export_as_built(item, str(Path(folder) / "as_built.step"))

    def test_nonsense_is_refused_with_a_sentence(self) -> None:
        """A part is no scan."""
        from ..errors import InputError
        from . import actions

        with self.assertRaises(InputError) as refusal:
            actions.make_as_built(self.part, self.part)
        self.assertTrue(str(refusal.exception).endswith("."))
