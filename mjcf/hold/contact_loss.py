"""When a contact counts as lost.

A contact that carries little force comes and goes. So it is lost where it carries none in the end and none in
the half second after; what is seen at one instant alone would depend on the time step.
"""

from .simulation import Simulation

__all__ = ["kept_contacts"]

_BACK_S = 0.5


def kept_contacts(simulation: Simulation, *, wait: bool = True) -> tuple[bool, ...]:
    """Whether each contact of the task carries force now or, where one does not, comes back in time.

    The simulation goes on, its targets and gravity as they are, until all touch or the time is up.

    Args:
        simulation: where it happens.
        wait: False looks at this instant alone.
    """
    touching = simulation.normal_forces() > 0.0
    sample_s = simulation.settings.sample_s
    for _ in range(round(_BACK_S / sample_s) if wait else 0):
        if touching.all():
            break
        simulation.step(simulation.steps(sample_s))
        touching |= simulation.normal_forces() > 0.0
    return tuple(touching.tolist())
