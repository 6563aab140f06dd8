# SPDX-License-Identifier: LGPL-2.1-or-later
"""The two ways in which a request is turned down; the command line maps them to exit codes."""


class FfdsError(Exception):
    """Base of the errors whose message is one clear sentence for the user."""

    exit_code = 3


class InputError(FfdsError):
    """The request cannot be read: a bad file, option, unit or name (exit code 2)."""

    exit_code = 2


class RefusedError(FfdsError):
    """The request was understood, but an honest result cannot be given (exit code 3)."""

    exit_code = 3
