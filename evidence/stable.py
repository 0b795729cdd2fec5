"""Certified stable: true forces inside the friction cones balance a task's load at the true configuration.

The contacts' certificate says that a true solution lies close to a state; where exactly is not known, and so
neither is its grasp matrix G. It is enclosed over all places that the solution may have. With forces f0 that
balance a load w nearly, and M about the pseudoinverse of G, let q = |I - G M| < 1 in the largest row sum:
then G M is regular, some z with |z| <= |G f0 + w| / (1 - q) makes G (f0 + M z) + w = 0 exactly, and f0 + M z
differs from f0 by |M| |z| at most (Neumaier, "Interval methods for systems of equations", 1990, section 3.7).
Cones, efforts and limits are then asked of all forces so close to f0, in balls, wherever the solution is.
"""

from dataclasses import dataclass

import numpy as np

from ..arguments import check_instance
from ..arrays import Array
from ..geometry import perpendicular
from ..mjcf import HoldSettings, Squeeze, kind_of_test
from ..mjcf.model import payload
from ..objects import Task
from ..significant import significant
from ..solver import Configuration, SolutionRadii, State, solution_radii
from ..solver.interval import Balls
from .force_rows import ForceRows, force_rows
from .not_certified import NotCertified
from .slack_forces import SlackProblem, largest_slack
from .true_contacts import TrueContacts, true_contacts, true_places

__all__ = ["CertifiedStable", "certify_forces", "certify_stable", "find_forces"]


@dataclass(frozen=True, eq=False)
class CertifiedStable:
    """The statement that true forces balance the load, with what shows it.

    It speaks of the contacts that the task names, as points with friction in a soft finger's cone, and of
    rigid bodies at rest; that the servos' targets bring such forces about, it does not say.

    Attributes:
        slack_N: what every contact may lose at least, in every load, before it slips: normal force less the
            length of (f_1 / mu, f_2 / mu, tau / (mu arm)).
        effort_share: the largest share of any servo's effort that is used.
        forces: (k, n, 4) for each load and contact the force on the object in the palm frame in N and the
            torque about the inward normal in N m; the true ones are within `error_N` of these.
        error_N: in N, and for torques in N m.
        radii: how close to the state the true solution is.
        friction: sliding coefficient.
        spin_arms_m: (n,) arm at which friction resists spin at each contact.
        settings: of the hold test whose load is balanced.
    """

    slack_N: float
    effort_share: float
    forces: Array
    error_N: float
    radii: SolutionRadii
    friction: float
    spin_arms_m: Array
    settings: HoldSettings

    def __bool__(self) -> bool:
        """True: it is certified."""
        return True

    def __str__(self) -> str:
        return f"certified stable, {significant(self.slack_N, 3)} N of slack"

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self}>"


def certify_stable(
    configuration: Configuration, squeeze: Squeeze, *, state: State | None = None
) -> CertifiedStable | NotCertified:
    """Finds forces with the largest slack and shows that true ones near them balance the load.

    Args:
        configuration: with its certificate of existence.
        squeeze: gives the settings of the hold test, and the arms at which friction resists spin.
        state: about which everything is enclosed, such as the configuration's as it is written; None for the
            configuration's own.
    """
    check_instance("configuration", configuration, Configuration, "a Configuration")
    state = state or configuration.state
    radii = solution_radii(configuration, state)
    if radii is None:
        return NotCertified("stable", "the contacts themselves are not certified")
    task = configuration.task
    forces = find_forces(task, state, squeeze.settings, squeeze.spin_arms_m)
    if isinstance(forces, NotCertified):
        return forces
    return certify_forces(task, state, radii, squeeze.settings, squeeze.spin_arms_m, forces)


def find_forces(task: Task, state: State, settings: HoldSettings, spin_arms_m: Array) -> Array | NotCertified:
    """Forces (k, n, 4), as `CertifiedStable` has them, of the largest slack at a state, in floats."""
    exactly = SolutionRadii(0.0, 0.0, 0.0, 0.0)
    rows, contacts = _rows(task, state, exactly, settings)
    frames = np.array([np.vstack([n, perpendicular(n)]) for n in contacts.inward.mid])
    n = len(frames)
    # From contact vectors to forces in the palm frame.
    turn = np.zeros((n, 4, n, 4))
    for i, frame in enumerate(frames):
        turn[i, :3, i, :3] = frame.T
        turn[i, 3, i, 3] = 1.0
    to_palm = turn.reshape(4 * n, 4 * n)
    mu = settings.sliding_friction(task.object)
    slack, found = largest_slack(
        SlackProblem(
            A=rows.A.mid @ to_palm,
            b=rows.b.mid,
            T=rows.T.mid @ to_palm,
            effort=rows.effort,
            least=rows.least,
            most=rows.most,
            mu=mu,
            mu_t=mu * spin_arms_m,
        )
    )
    if not slack.min() > 0.0:
        return NotCertified("stable", _unbalanced(task, settings, int(np.argmin(slack))))
    return (found.reshape(len(found), -1) @ to_palm.T).reshape(found.shape)


def certify_forces(
    task: Task, state: State, radii: SolutionRadii, settings: HoldSettings, spin_arms_m: Array, forces: Array
) -> CertifiedStable | NotCertified:
    """Shows that true forces near `forces` (k, n, 4) balance the load wherever the solution is."""
    rows, contacts = _rows(task, state, radii, settings)
    f0 = forces.reshape(len(forces), -1)
    errors = _errors(rows, f0)
    if errors is None:
        return NotCertified("stable", "the grasp matrix is known too badly")
    near = Balls.within(f0, errors)
    mu = settings.sliding_friction(task.object)
    slack = _slack(near, contacts, mu, Balls.exact(mu) * spin_arms_m, rows)
    used = (near @ rows.T.T).most / rows.effort
    share = float(np.nextafter(used.max(initial=0.0), np.inf))
    if not slack > 0.0:
        return NotCertified("stable", "true forces may lie outside the friction cones or the limits of force")
    if not share < 1.0:
        return NotCertified("stable", "true forces may ask more of a servo than it has")
    return CertifiedStable(
        slack_N=slack,
        effort_share=share,
        forces=forces,
        error_N=float(errors.max()),
        radii=radii,
        friction=mu,
        spin_arms_m=spin_arms_m,
        settings=settings,
    )


def _rows(
    task: Task, state: State, radii: SolutionRadii, settings: HoldSettings
) -> tuple[ForceRows, TrueContacts]:
    at = true_places(task, state, radii)
    contacts = true_contacts(task, at)
    return force_rows(task, settings, payload(task, settings), at, contacts), contacts


def _errors(rows: ForceRows, f0: Array) -> Array | None:
    """How far (k, 4 n) some forces that balance exactly are from f0 at most; None where it isn't known."""
    m = rows.A.shape[0]
    if m == 0:
        return np.zeros(f0.shape)
    M = np.asarray(np.linalg.pinv(rows.A.mid), dtype=np.float64)
    off = rows.A @ M - np.eye(m)
    q = float(Balls.exact(off.most).sum(axis=1).upper.max())
    missed = (Balls.exact(f0) @ rows.A.T - rows.b).most.max(axis=1)
    if not q < 1.0 or not np.isfinite(missed).all():
        return None
    z = (Balls.exact(missed) / (1.0 - Balls.exact(q))).upper
    reach = Balls.exact(np.abs(M)).sum(axis=1).upper
    return np.asarray(np.nextafter(z[:, None] * reach, np.inf))


def _slack(forces: Balls, contacts: TrueContacts, mu: float, mu_t: Balls, rows: ForceRows) -> float:
    """What every contact may lose at least; below zero where something of `forces` (k, 4 n) lies outside."""
    k, n = forces.shape[0], mu_t.shape[0]
    f = Balls(forces.mid.reshape(k, n, 4), forces.rad.reshape(k, n, 4))
    F, torque = f[..., :3], f[..., 3]
    normal = (F * contacts.inward).sum(axis=2)
    along = Balls(normal.mid[..., None], normal.rad[..., None]) * contacts.inward
    # Upper bounds of the squares; a root of a ball that touches zero is not known, one of a float is.
    sideways = Balls.exact((F - along).most) / mu
    spin = Balls.exact(torque.most) / mu_t
    squares = (sideways * sideways).sum(axis=2) + spin * spin
    length = np.nextafter(np.sqrt(squares.upper), np.inf)
    in_cone = np.nextafter(normal.lower - rows.least, -np.inf) - length
    allowed = np.nextafter(rows.most - normal.upper, -np.inf)
    return float(np.nextafter(min(in_cone.min(), allowed.min()), -np.inf))


def _unbalanced(task: Task, settings: HoldSettings, load: int) -> str:
    kind = kind_of_test(task)
    if kind == "lift":
        direction = ", ".join(f"{significant(x, 3)}" for x in settings.directions[load])
        return f"no forces within cones and efforts balance the weight along ({direction})"
    what = "the torque of the hinge" if kind == "turn" else "what is to be pressed"
    return f"no forces within cones and efforts bring about {what}"
