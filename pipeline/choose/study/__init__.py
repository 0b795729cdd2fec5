"""Policies compared on what they have not seen: figures, intervals, and the page that shows them."""

from .page import render_page
from .study import Study, default_policies, study_data, study_models
from .summary import headline, tables

__all__ = ["Study", "default_policies", "headline", "render_page", "study_data", "study_models", "tables"]
