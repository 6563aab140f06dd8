# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report for people: what it says (`content`), the part with its colours (`scene`), its pictures (`pictures`), and
the two files that hold all of it (`html_file`, `pdf_file`).
"""
