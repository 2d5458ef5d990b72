"""``python -m roughcontact``: the command ``rc``."""

import sys

from roughcontact._command import main

sys.exit(main())
