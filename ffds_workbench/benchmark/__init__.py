# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measurements that anyone can rerun: accuracy, topology, speed. Run them with ``./ffds benchmark``."""
