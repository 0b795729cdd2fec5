"""Which systems the program runs on."""

import os
import sys

from ...errors import HoldfastError

__all__ = ["require_supported_platform"]


def require_supported_platform() -> None:
    """Refuses systems that nothing was tested on; $HOLDFAST_UNTESTED lets those try that might do.

    Raises:
        HoldfastError: Windows, whose file locks and signals are others; another system than Linux, untested.
    """
    if sys.platform == "win32":
        raise HoldfastError("Windows is not supported: run it in the Windows Subsystem for Linux")
    if sys.platform != "linux" and not os.environ.get("HOLDFAST_UNTESTED"):
        raise HoldfastError(f"{sys.platform} is untested, Linux is supported: HOLDFAST_UNTESTED=1 tries it")
