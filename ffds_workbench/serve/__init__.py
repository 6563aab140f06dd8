# SPDX-License-Identifier: LGPL-2.1-or-later
"""Registrations over HTTP, for a cell: files come in whole, jobs are kept on the disk, parts are done as in a series.

`uploads` takes files in, `jobs` keeps what was asked for and what became of it, `runner` hands jobs to Dask, and `app`
is what HTTP sees of it.
"""
