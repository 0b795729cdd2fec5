"""Policies that choose among candidate grasps: how they are trained, kept, compared and used in a run."""

from .dataset_source import provenance, training_situations
from .model_file import Model, Provenance, load_model, save_model
from .page import render_page
from .policies import check_policy, policy_names, prepare, train
from .situations import Situations, to_situations
from .study import Study, default_policies, study_data, study_models
from .summary import headline, tables

__all__ = [
    "Model",
    "Provenance",
    "Situations",
    "Study",
    "check_policy",
    "default_policies",
    "headline",
    "load_model",
    "policy_names",
    "prepare",
    "provenance",
    "render_page",
    "save_model",
    "study_data",
    "study_models",
    "tables",
    "to_situations",
    "train",
    "training_situations",
]
