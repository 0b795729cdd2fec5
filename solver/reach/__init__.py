"""The best grasp of a task with its hand: statics of the regions, and where the hand reaches them."""

from .best import BestWithHand, best_with_hand
from .form import hand_form

__all__ = ["BestWithHand", "best_with_hand", "hand_form"]
