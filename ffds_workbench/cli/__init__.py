# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line ``./ffds``. Each command is a few lines on top of `api`."""
