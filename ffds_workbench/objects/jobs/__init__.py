# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is computed for a document: registrations, alignments, seams, prepared and simulated scans, each with its
inputs, and its result while the inputs stay the same. Nothing here is stored.
"""
