# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands of displacement fields: `field` takes them, `morph` applies them,
`compensate` makes up for them.
"""
