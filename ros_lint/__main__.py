"""``python -m ros_lint``."""

import sys

from ros_lint.cli import main

sys.exit(main())
