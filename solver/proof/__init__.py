"""The log of a refutation, which `holdfast.check_proof` replays."""

from .log import BoxRecord, BoxTrace, ProofWriter, form_data

__all__ = ["BoxRecord", "BoxTrace", "ProofWriter", "form_data"]
