# SPDX-License-Identifier: LGPL-2.1-or-later
"""``python -m ffds_workbench.cli``, which the launcher runs."""
import sys

from .main import INTERRUPTED, main

if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("ffds: Interrupted, nothing was written.", file=sys.stderr)
        sys.exit(INTERRUPTED)
