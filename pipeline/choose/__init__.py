"""Policies that choose among candidate grasps: how they are trained, kept and used in a run."""

from .chooser import ModelChooser
from .dataset_source import provenance, training_situations
from .model_file import Model, Provenance, load_model, save_model
from .policies import check_policy, policy_names, prepare, train
from .situations import Situations, to_situations

__all__ = [
    "Model",
    "ModelChooser",
    "Provenance",
    "Situations",
    "check_policy",
    "load_model",
    "policy_names",
    "prepare",
    "provenance",
    "save_model",
    "to_situations",
    "train",
    "training_situations",
]
