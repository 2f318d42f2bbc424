"""Check the wording of the tree: see report.py."""

import sys

from report import main

sys.exit(main())
