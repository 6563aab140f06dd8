# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the deformation panel says of its preview: figures and a legend, a sentence, and a way out of it."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..qt import QtWidgets
from ..translating import tr
from ..widgets import named, warning, wrapped
from .legend import Legend


class Findings(QtWidgets.QWidget):
    """Figures with their legend, or a sentence instead, or both."""

    def __init__(self) -> None:
        super().__init__()
        self._figures, self._message = wrapped("FfdsFigures"), warning("FfdsMessageLabel")
        self._figures.setToolTip(tr("Distances of the scan from the faces, and the share of the faces that it shows"))
        self._legend = named(Legend(), "FfdsLegend", tr("Deviation of the scan from the deformed faces"))
        self._other_side = named(QtWidgets.QPushButton(), "FfdsOtherSide",
                                 tr("Deform the face on the side of the sheet that the scan shows"))
        self._take_other_side: Callable[[], None] | None = None
        self._other_side.clicked.connect(lambda: self._take_other_side and self._take_other_side())
        self._other_side.setVisible(False)
        column = QtWidgets.QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        for widget in (self._figures, self._legend, self._message, self._other_side):
            column.addWidget(widget)

    def say(self, sentence: str) -> None:
        """Show a sentence below the settings."""
        self._message.setText(sentence)
        self._message.setVisible(bool(sentence))

    def offer(self, face: str, take: Callable[[], None]) -> None:
        """Offer to take another face, until the next figures or sentence."""
        self._take_other_side = take
        self._other_side.setText(tr("Take {face} instead").format(face=face))
        self._other_side.setVisible(True)

    def show_figures(self, figures: tuple | None, sentence: str, after: Any = None, limit: float = 1.0) -> None:
        """Show (mean, p95 before; mean, p95 after; coverage), or a sentence instead."""
        self._other_side.setVisible(False)
        self._legend.setVisible(figures is not None)
        self._figures.setVisible(figures is not None)
        self.say(sentence)
        if figures is None:
            return
        rows = "".join(f"<tr><td>{name}</td><td align='right'>{mean:.3f}</td>"
                       f"<td align='right'>{p95:.3f}</td></tr>"
                       for name, mean, p95 in ((tr("before"), *figures[:2]), (tr("after"), *figures[2:4])))
        self._figures.setText(
            f"<table width='100%'><tr><td>{tr('Deviation')},&nbsp;mm</td><td align='right'>{tr('mean')}</td>"
            f"<td align='right'>95&nbsp;%</td></tr>"
            f"{rows}</table>" + tr("The scan shows {share} % of it").format(share=f"{100 * figures[4]:.0f}"))
        self._legend.show_deviations(after, limit)
