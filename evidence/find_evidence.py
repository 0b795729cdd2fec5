"""Everything that can be proved of a grasp beside its verdict, about its configuration as it is written."""

from dataclasses import dataclass

from ..mjcf import Squeeze
from ..objects import Task
from ..retraction import Approach, RetractionSettings
from ..solver import ContactManifold, State, certify_state
from .clear import CertifiedClear, certify_clear
from .not_certified import NotCertified
from .stable import CertifiedStable, certify_stable

__all__ = ["Evidence", "find_evidence"]


@dataclass(frozen=True, eq=False)
class Evidence:
    """What was proved, and what was not.

    Attributes:
        stable: that true forces balance the load; None where there is no squeeze, and so nothing is known of
            what the contacts may bear.
        clear: that nothing sinks in deeper than it may.
    """

    stable: CertifiedStable | NotCertified | None
    clear: CertifiedClear | NotCertified


def find_evidence(
    task: Task,
    state: State,
    *,
    squeeze: Squeeze | None = None,
    approach: Approach | None = None,
    retraction: RetractionSettings | None = None,
) -> Evidence:
    """Certifies the contacts anew near a state, and then what follows about that state.

    Args:
        task: the task.
        state: of a configuration of the task; the approach ends there to the last bit.
        squeeze: gives the settings of the hold test; None where there is none.
        approach: how the fingers get there; None where that is not known.
        retraction: what counts as clear.
    """
    certified = certify_state(ContactManifold(task), state)
    return Evidence(
        None if squeeze is None else certify_stable(certified, squeeze, state=state),
        certify_clear(certified, approach, state=state, retraction=retraction),
    )
