# SPDX-License-Identifier: LGPL-2.1-or-later
"""German is complete and shown, the preferences page is there and means something, the Test workbench knows FFDS."""
from __future__ import annotations

import importlib.util
import re
import xml.etree.ElementTree as ElementTree

import FreeCAD
import FreeCADGui as Gui
import pytest
from PySide2 import QtCore, QtWidgets

from ffds_workbench import ROOT
from ffds_workbench.gui.commands import COMMANDS
from ffds_workbench.gui.commands.deform_faces import DeformFaces
from ffds_workbench.gui.preferences import Preferences, preferences
from ffds_workbench.gui.translating import TRANSLATIONS


@pytest.fixture
def collected():
    """The texts of the sources, as the developers' script collects them."""
    path = ROOT / "resources" / "scripts" / "translations.py"
    spec = importlib.util.spec_from_file_location("translations", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.texts()


def test_german_is_complete_and_compiled(collected):
    root = ElementTree.parse(TRANSLATIONS / "FFDS_de.ts").getroot()
    known = {(context.findtext("name"), item.findtext("source")): item.findtext("translation")
             for context in root.iter("context") for item in context.iter("message")}
    assert set(known) == set(collected), "run resources/scripts/translations.py"
    translator = QtCore.QTranslator()
    assert translator.load(str(TRANSLATIONS / "FFDS_de.qm"))
    for (context, text), german in known.items():
        assert german
        assert set(re.findall(r"\{\w+\}", text)) == set(re.findall(r"\{\w+\}", german)), text
        assert translator.translate(context, text) == german, "run resources/scripts/translations.py LRELEASE"


def test_every_command_explains_itself():
    for command in COMMANDS:
        assert len(command().GetResources()["WhatsThis"]) > 60


def test_the_window_speaks_german(hands, plate_document):
    translator = QtCore.QTranslator()
    translator.load(str(TRANSLATIONS / "FFDS_de.qm"))
    QtWidgets.QApplication.installTranslator(translator)
    try:
        Gui.Selection.addSelection(plate_document.Plate, "Face6")
        hands.command(DeformFaces)
        hands.until(lambda: "Abweichung" in hands.find("FfdsFigures").text(), 20)
        assert hands.find("FfdsWhole").text() == "Ganzes Teil"
        hands.screenshot("german")
        hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    finally:
        QtWidgets.QApplication.removeTranslator(translator)
    hands.until(lambda: not Gui.Control.activeDialog(), 5)


def test_the_preferences_page_sets_what_a_new_panel_starts_from(hands, plate_document):
    def set_and_accept(dialog) -> None:
        hands.screenshot("preferences")
        box = dialog.findChild(QtWidgets.QDoubleSpinBox, "stiffness")
        box.setValue(2.5)
        dialog.findChild(QtWidgets.QComboBox, "isometry").setCurrentIndex(1)
        dialog.findChild(QtWidgets.QDialogButtonBox).button(QtWidgets.QDialogButtonBox.Ok).click()

    try:
        hands.answer(set_and_accept)
        Gui.showPreferences("FFDS", 0)
        assert (preferences().stiffness, preferences().isometry) == (2.5, "on")
        Gui.Selection.addSelection(plate_document.Plate, "Face6")
        hands.command(DeformFaces)
        assert hands.find("FfdsStiffnessValue").text() == "2.5"
        hands.click(hands.button(QtWidgets.QDialogButtonBox.Cancel))
    finally:
        FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod").RemGroup("FFDS")
    hands.until(lambda: not Gui.Control.activeDialog(), 5)
    assert preferences() == Preferences()


def test_the_test_workbench_knows_ffds():
    assert "ffds_workbench.objects.selftest" in FreeCAD.__unit_test__
