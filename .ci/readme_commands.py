"""Print the commands in the ``sh`` blocks of a README, one per line, in order."""

import re
import sys
from pathlib import Path

for block in re.findall(r"^```sh\n(.*?)^```", Path(sys.argv[1]).read_text("utf-8"), re.MULTILINE | re.DOTALL):
    print(block.replace("\\\n", " "), end="")
