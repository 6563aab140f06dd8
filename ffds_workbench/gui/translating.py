# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts in the user's language. What is marked here is collected by ``resources/scripts/translations.py``.

The layers below speak English and know no Qt. What they say is recognised by its template, ``The scan {0} is empty.``,
which the same script collects from their sources, and is said in the user's language with the same values.
"""
from __future__ import annotations

import functools
import re
import xml.etree.ElementTree as ElementTree

import FreeCAD

from .. import RESOURCES

TRANSLATIONS = RESOURCES / "translations"
_SENTENCE = "Sentence"
_PLACE = re.compile(r"\{\d+\}")


def tr(text: str) -> str:
    """A text of the panels and dialogs; put values in afterwards, by ``.format``."""
    return FreeCAD.Qt.translate("FFDS", text)


def said(sentence: str) -> str:
    """What a layer below said, in the user's language; unchanged where that has no words for it."""
    for template, pattern in _templates():
        found = pattern.fullmatch(sentence)
        if found is not None:
            return FreeCAD.Qt.translate(_SENTENCE, template).format(*map(said, found.groups()))
    return sentence


@functools.cache
def _templates() -> list[tuple[str, re.Pattern[str]]]:
    """The templates, those with most letters of their own first."""
    root = ElementTree.parse(next(TRANSLATIONS.glob("FFDS_*.ts"))).getroot()
    texts = [message.findtext("source") or "" for context in root.iter("context")
             if context.findtext("name") == _SENTENCE for message in context.iter("message")]
    texts.sort(key=lambda text: -len(_PLACE.sub("", text)))
    return [(text, re.compile("(.*?)".join(map(re.escape, _PLACE.split(text))), re.DOTALL)) for text in texts]
