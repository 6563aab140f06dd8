# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measurements that anyone can rerun. ``./ffds benchmark NAME`` calls ``run(folder, progress)`` of the module NAME."""

NAMES = ("accuracy", "alignment", "calibrate", "topology", "speed", "real", "paper", "peers", "scaling", "sizes",
         "world", "series", "fuzz", "compensation", "summary")
