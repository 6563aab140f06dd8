# SPDX-License-Identifier: LGPL-2.1-or-later
"""Displacement fields as jobs: `taking` them from models and meshes, `measuring` through few points, `applying` them to
a model, `compensating` for what parts deviate by, `writing`.
"""
