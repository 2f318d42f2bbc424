"""``python -m firetwin`` is the command ``firetwin``."""

import sys

from .cli import main

sys.exit(main())
