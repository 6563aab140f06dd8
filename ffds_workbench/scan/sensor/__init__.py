# SPDX-License-Identifier: LGPL-2.1-or-later
"""The virtual sensor: scans of any shape, deformed or not, with their ground truth. Everything is seeded."""
from .settings import SensorSettings, View
from .simulate import SimulatedScan, simulate
from .target import Scene
from .truth import Truth, make_truth

__all__ = ["SensorSettings", "SimulatedScan", "Scene", "Truth", "View", "make_truth", "simulate"]
