"""Certified stable: true forces inside the friction cones balance a task's load at the true configuration.

The contacts' certificate says that a true solution lies close to a state; where exactly is not known, and so
neither is its grasp matrix G. It is enclosed over all places that the solution may have. With forces f0 that
balance a load w nearly, and M about the pseudoinverse of G, let q = |I - G M| < 1 in the largest row sum:
then G M is regular, some z with |z| <= |G f0 + w| / (1 - q) makes G (f0 + M z) + w = 0 exactly, and f0 + M z
differs from f0 by |M| |z| at most (Neumaier, "Interval methods for systems of equations", 1990, section 3.7).
Cones, efforts and limits are then asked of all forces so close to f0, in balls, wherever the solution is.

That is tried with contacts as points first, and where these carry nothing with the force points of wide ones
(`wide_points`), about which the statement then assumes more.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arguments import check_instance
from ..base.numeric.arrays import Array
from ..base.text.significant import significant
from ..geometry import perpendicular
from ..mjcf import HoldSettings, Squeeze, kind_of_test
from ..mjcf.model import payload
from ..objects import Task
from ..solver import Configuration, SolutionRadii, State, solution_radii
from ..solver.interval import Balls
from .contact_areas import ContactAreas
from .force_rows import ForceRows, force_rows
from .not_certified import NotCertified
from .slack_forces import SlackProblem, largest_slack
from .true_contacts import TrueContacts, true_places
from .wide_points import WidePoint, find_wide_points, owners_of, spread_over, why_not_within

__all__ = ["CertifiedStable", "certify_forces", "certify_stable", "find_forces"]

_EXACTLY = SolutionRadii(0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class CertifiedStable:
    """The statement that true forces balance the load, with what shows it.

    It speaks of the contacts that the task names, with friction in a soft finger's cone at their points and,
    where `wide` has any, at points of the area over which they can be pressed, and of rigid bodies at rest;
    that the servos' targets bring such forces about, it does not say.

    Attributes:
        slack_N: what every contact may lose at least, in every load, before it slips: normal force less the
            length of (f_1 / mu, f_2 / mu, tau / (mu arm)), summed over its points.
        effort_share: the largest share of any servo's effort that is used.
        forces: (k, m, 4) for each load and force point, those of the n contacts first, the force on the
            object in the palm frame in N and the torque about the inward normal in N m; the true ones are
            within `error_N` of these.
        error_N: in N, and for torques in N m.
        radii: how close to the state the true solution is.
        friction: sliding coefficient.
        spin_arms_m: (n,) arm at which friction resists spin at each contact.
        settings: of the hold test whose load is balanced.
        wide: the force points beside the contacts' own.
    """

    slack_N: float
    effort_share: float
    forces: Array
    error_N: float
    radii: SolutionRadii
    friction: float
    spin_arms_m: Array
    settings: HoldSettings
    wide: tuple[WidePoint, ...] = ()

    def __bool__(self) -> bool:
        """True: it is certified."""
        return True

    def __str__(self) -> str:
        over = ", wide contacts pressed over their area" if self.wide else ""
        return f"certified stable, {significant(self.slack_N, 3)} N of slack{over}"

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
    task, settings, arms_m = configuration.task, squeeze.settings, squeeze.spin_arms_m
    around = _near(task, state, radii, settings)
    found = _certified(around, radii, arms_m, ())
    if isinstance(found, CertifiedStable) or kind_of_test(task) == "press":
        return found  # in a press a stand takes up whatever does not balance
    wide = find_wide_points(around, state)
    return _certified(around, radii, arms_m, wide) if wide else found


def find_forces(
    task: Task, state: State, settings: HoldSettings, spin_arms_m: Array, wide: tuple[WidePoint, ...] = ()
) -> Array | NotCertified:
    """Forces (k, m, 4), as `CertifiedStable` has them, of the largest slack at a state, in floats.

    Args:
        task: the task.
        state: of a configuration.
        settings: of the hold test.
        spin_arms_m: (n,) see `CertifiedStable`.
        wide: force points beside those of the n contacts.
    """
    here = _near(task, state, _EXACTLY, settings)
    return _forces(here, _Rows.of(here, wide), spin_arms_m)


def certify_forces(
    task: Task,
    state: State,
    radii: SolutionRadii,
    settings: HoldSettings,
    spin_arms_m: Array,
    forces: Array,
    wide: tuple[WidePoint, ...] = (),
) -> CertifiedStable | NotCertified:
    """Shows that true forces near `forces` (k, m, 4) balance the load wherever the solution is.

    Args:
        task: the task.
        state: of a configuration.
        radii: how close to it the true solution is.
        settings: of the hold test.
        spin_arms_m: (n,) see `CertifiedStable`.
        forces: as `find_forces` gives them.
        wide: the force points beside those of the n contacts.
    """
    around = _near(task, state, radii, settings)
    return _shown(around, _Rows.of(around, wide), radii, spin_arms_m, forces, wide)


def _near(task: Task, state: State, radii: SolutionRadii, settings: HoldSettings) -> ContactAreas:
    return ContactAreas(task, settings, true_places(task, state, radii))


class _Rows(NamedTuple):
    """What forces must do, and the points at which they act."""

    rows: ForceRows
    points: TrueContacts

    @classmethod
    def of(cls, around: ContactAreas, wide: tuple[WidePoint, ...]) -> "_Rows":
        """Those of the contacts and the force points beside them."""
        task, settings = around.task, around.settings
        points, owners = spread_over(around.contacts, wide), owners_of(wide, len(task.contacts))
        return cls(force_rows(task, settings, payload(task, settings), around.at, points, owners), points)


def _certified(
    around: ContactAreas, radii: SolutionRadii, spin_arms_m: Array, wide: tuple[WidePoint, ...]
) -> CertifiedStable | NotCertified:
    at = _Rows.of(around, wide)
    forces = _forces(around, at, spin_arms_m)
    if isinstance(forces, NotCertified):
        return forces
    return _shown(around, at, radii, spin_arms_m, forces, wide)


def _forces(near: ContactAreas, at: _Rows, spin_arms_m: Array) -> Array | NotCertified:
    """Forces of the largest slack in the middle of all states near one."""
    task, settings = near.task, near.settings
    rows, contacts = at
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
            contact=rows.contact,
            least=rows.least,
            most=rows.most,
            mu=mu,
            mu_t=mu * spin_arms_m[rows.contact],
        )
    )
    if not slack.min() > 0.0:
        return NotCertified("stable", _unbalanced(task, settings, int(np.argmin(slack))))
    return (found.reshape(len(found), -1) @ to_palm.T).reshape(found.shape)


def _shown(
    around: ContactAreas,
    at: _Rows,
    radii: SolutionRadii,
    spin_arms_m: Array,
    forces: Array,
    wide: tuple[WidePoint, ...],
) -> CertifiedStable | NotCertified:
    task, settings = around.task, around.settings
    reason = why_not_within(around, wide)
    if reason:
        return NotCertified("stable", reason)
    rows, contacts = at
    f0 = forces.reshape(len(forces), -1)
    errors = _errors(rows, f0)
    if errors is None:
        return NotCertified("stable", "the grasp matrix is known too badly")
    near = Balls.within(f0, errors)
    mu = settings.sliding_friction(task.object)
    slack = _slack(near, contacts, mu, Balls.exact(mu) * spin_arms_m[rows.contact], rows)
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
        wide=wide,
    )


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
    """What every contact may lose at least; not above zero where any of `forces` (k, 4 m) may lie outside."""
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
    in_cone = np.nextafter(np.nextafter(normal.lower - rows.least, -np.inf) - length, -np.inf)
    if not (in_cone > 0.0).all():
        return float(in_cone.min())
    of_contact = Balls.exact((rows.contact == np.arange(rows.contact.max() + 1)[:, None]).astype(float)).T
    may_lose = (Balls.exact(in_cone) @ of_contact).lower
    allowed = (rows.most - normal @ of_contact).lower if np.isfinite(rows.most) else np.array(np.inf)
    return float(min(may_lose.min(), allowed.min()))


def _unbalanced(task: Task, settings: HoldSettings, load: int) -> str:
    kind = kind_of_test(task)
    if kind == "lift":
        direction = ", ".join(f"{significant(x, 3)}" for x in settings.directions[load])
        return f"no forces within cones and efforts balance the weight along ({direction})"
    what = "the torque of the hinge" if kind == "turn" else "what is to be pressed"
    return f"no forces within cones and efforts bring about {what}"
