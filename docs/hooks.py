"""What MkDocs does with pages that are read in the repository, too."""

import re
from typing import Any

# Links to files outside docs/ lead somewhere in the repository; on the site they are names.
_OUTSIDE = re.compile(r"\[([^\]]+)\]\(\.\./([^)]+)\)")


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Turns links out of the documentation into names of files of the repository."""
    return _OUTSIDE.sub(
        lambda link: f"`{link[2]}`" if link[1] in link[2] else f"{link[1]} (`{link[2]}`)", markdown
    )
