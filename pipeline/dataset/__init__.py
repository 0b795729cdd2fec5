"""Data sets of choices: candidates of many objects and hands, tried under hidden draws."""

from .make import DatasetResult, make_dataset
from .plan import DatasetPlan

__all__ = ["DatasetPlan", "DatasetResult", "make_dataset"]
