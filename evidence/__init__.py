"""What is proved of a grasp beside its verdict: forces that balance its load, and that nothing sinks in.

Evidence is never a filter: a grasp may hold without it, and forces that can balance need not be those that
servos bring about.
"""

from .clear import CertifiedClear, Plane, certify_clear
from .find_evidence import Evidence, find_evidence
from .grasp_form import grasp_form
from .not_certified import NotCertified
from .stable import CertifiedStable, certify_stable
from .wide_points import WidePoint

__all__ = [
    "CertifiedClear",
    "CertifiedStable",
    "Evidence",
    "NotCertified",
    "Plane",
    "WidePoint",
    "certify_clear",
    "certify_stable",
    "find_evidence",
    "grasp_form",
]
