# SPDX-License-Identifier: LGPL-2.1-or-later
"""``python -m ffds_workbench.cli``, which the launcher runs; an interruption counts from the first import on."""
import sys

try:
    from .main import main

    sys.exit(main())
except KeyboardInterrupt:
    print("ffds: Interrupted; nothing half-written is left.", file=sys.stderr)
    sys.exit(130)
