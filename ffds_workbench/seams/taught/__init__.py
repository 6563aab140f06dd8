# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths taught on the nominal model, carried along to the as-built one: `carry` (file in, file out), `attach` (each
pose held by what is near it), and the files, `taught_csv` and `taught_krl`.
"""
