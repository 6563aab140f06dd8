# SPDX-License-Identifier: LGPL-2.1-or-later
"""What many parts tell of their process: mathematics over arrays, which knows neither files nor FreeCAD.

`scatter` has the mean part and what varies beyond the measurement, `modes` the shapes in which parts differ, `trend`
where a run of figures changes and whether groups differ, `charts` and `capability` what quality people ask for, and
`outliers` the parts unlike the others, with the reason.
"""
from .capability import Capability, capability
from .charts import ControlChart, ewma_chart, means_chart, scatter_chart
from .modes import Mode, Modes, find_modes
from .outliers import Outlier, find_outliers
from .scatter import OwnerScatter, SeriesPlaces, SeriesScatter, find_scatter, owner_scatter
from .trend import Change, GroupDifference, find_change, group_difference

__all__ = ["Capability", "Change", "ControlChart", "GroupDifference", "Mode", "Modes", "Outlier", "OwnerScatter",
           "SeriesPlaces", "SeriesScatter", "capability", "ewma_chart", "find_change", "find_modes", "find_outliers",
           "find_scatter", "group_difference", "means_chart", "owner_scatter", "scatter_chart"]
