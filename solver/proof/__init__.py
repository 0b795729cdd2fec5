"""The log of a refutation, which `holdfast.check_proof` replays."""

from .log import BoxRecord, BoxTrace, LogWriter, ProofWriter, form_data

__all__ = ["BoxRecord", "BoxTrace", "LogWriter", "ProofWriter", "form_data"]
