"""How clear is clear, and how hard retraction tries."""

from dataclasses import dataclass

from ..arguments import check_instance, check_number, check_whole_number

__all__ = ["RetractionSettings", "checked_settings"]


@dataclass(frozen=True)
class RetractionSettings:
    """Thresholds and budgets of a retraction.

    Values that can't be used raise an `InputError`.

    Attributes:
        depth_m: a pair that should not touch and is no deeper than this still counts as clear.
        contact_depth_m: how deep the bodies of an intended contact may sink into each other.
        margin_m: distance asked for between bodies that should not touch; above zero it replaces `depth_m`.
        max_steps: accepted steps of one descent.
        restarts: descents after the first, each from another point of the contact manifold.
        near_restarts: how many of these start from where a push, then walks along the contacts lead; the
            others search anew, and come last.
        trust_m: longest step of one coordinate, in m of motion that it causes.
        seed: seed of the restarts.
    """

    depth_m: float = 1e-4
    contact_depth_m: float = 1e-4
    margin_m: float = 0.0
    max_steps: int = 40
    restarts: int = 24
    near_restarts: int = 3
    trust_m: float = 0.02
    seed: int = 0

    def __post_init__(self) -> None:
        for name in ("depth_m", "contact_depth_m", "margin_m"):
            check_number(f"RetractionSettings.{name}", getattr(self, name), least=0.0)
        for name in ("max_steps", "restarts", "near_restarts", "seed"):
            check_whole_number(f"RetractionSettings.{name}", getattr(self, name), least=0)
        check_number("RetractionSettings.trust_m", self.trust_m, above=0.0)

    def required_m(self, intended: bool) -> float:
        """Least signed distance at which a pair counts as clear."""
        if intended:
            return -self.contact_depth_m
        return self.margin_m if self.margin_m > 0.0 else -self.depth_m

    def target_m(self, intended: bool) -> float:
        """Least signed distance that a retraction aims for: no depth at all, except at contacts."""
        return -self.contact_depth_m if intended else self.margin_m


def checked_settings(settings: RetractionSettings | None) -> RetractionSettings:
    """The settings that were given, or the defaults for None.

    Raises:
        InputError: it is something else.
    """
    if settings is None:
        return RetractionSettings()
    return check_instance("settings", settings, RetractionSettings, "RetractionSettings")
