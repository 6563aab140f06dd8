# SPDX-License-Identifier: LGPL-2.1-or-later
"""Other programs on the same clouds: their environments, and the worker that runs one method in a process of its own.
"""
