"""Grasps made elsewhere, judged: how their files are to be read, what is wrong, and what lies near them."""

from .faults import Fault
from .fixed_files import write_fixed
from .judge import Judged, JudgeSettings
from .nearby import Nearby, NearbyVerdict
from .page import write_page
from .record import as_record
from .sized import GivenObject
from .verify import ReadPool, Verification, Verified, verify
from .words import reading_lines

__all__ = [
    "Fault",
    "GivenObject",
    "JudgeSettings",
    "Judged",
    "Nearby",
    "NearbyVerdict",
    "ReadPool",
    "Verification",
    "Verified",
    "as_record",
    "reading_lines",
    "verify",
    "write_fixed",
    "write_page",
]
