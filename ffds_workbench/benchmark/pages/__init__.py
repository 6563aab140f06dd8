# SPDX-License-Identifier: LGPL-2.1-or-later
"""How results are shown: pages in HTML and Markdown, and the style of the pictures."""
