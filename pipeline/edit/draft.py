"""A task in the making: pairs of regions that are chosen, placed on the surface, sized, and solved."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import trimesh

from ...base.numeric.arrays import Array
from ...errors import InputError, UnknownName
from ...geometry import Patch, PointRegion
from ...hands import Hand, HandRegion
from ...objects import (
    Contact,
    Fit,
    LiftTest,
    ObjectModel,
    ObjectRegion,
    PhysicalTest,
    PressTest,
    Task,
    describe_test,
    fit_patch,
    narrowed_limits,
)
from ...solver import SolveResult, solve

__all__ = ["Draft", "Pair", "surface_hit"]

# A fingertip's patch, or less on a small object.
_RADIUS_M = 0.008
_SHARE_OF_SIZE = 0.1


@dataclass(frozen=True, eq=False)
class Pair:
    """A contact in the making.

    Attributes:
        hand: the region of the hand.
        object: what it shall touch; None as long as that is open.
        radius_m: of a patch that is fitted to the surface, as in `fit_patch`.
        fit: the patch as it was fitted; None for a region that has a name, or none yet.
        align_within_deg: as of the contact in the task that was opened.
    """

    hand: HandRegion
    object: ObjectRegion | None = None
    radius_m: float = _RADIUS_M
    fit: Fit | None = None
    align_within_deg: float | None = None

    def __str__(self) -> str:
        if self.fit is not None:
            place = ", ".join(f"{1e3 * x:.0f}" for x in self.fit.centre)
            return f"{self.hand.name} at {place} mm"
        return f"{self.hand.name} on {self.object.name if self.object else '...'}"


class Draft:
    """What an editor edits; every change throws away configurations that were found before it.

    Args:
        hand: the hand.
        obj: the object.
        task: a task to begin with; without it there is one open pair.

    Attributes:
        hand: the hand.
        object: the object.
        opened: the task to begin with, as it was.
        pairs: the contacts, in the order of the task.
        limits: (n_independent, 2) of the joints, in rad or m.
        test: what the hand must do; a press without contacts presses with all.
        support: what the object stands on; None for nothing.
        result: what the solver found for the pairs as they are; None where it has not been asked.

    Raises:
        InputError: the hand has no regions.
    """

    def __init__(self, hand: Hand, obj: ObjectModel, task: Task | None = None):
        if not hand.regions:
            raise InputError(hand.name, "regions", "has none: a hand needs regions that can touch")
        self.hand, self.object, self.opened = hand, obj, task
        self.pairs: list[Pair] = []
        self.limits: Array = hand.limits.copy() if task is None else task.limits.copy()
        self.test: PhysicalTest = LiftTest() if task is None else task.test
        self.support: PointRegion | None = None if task is None else task.support
        self.result: SolveResult | None = None
        if task is None:
            self.add()
        else:
            self.pairs = [
                Pair(
                    contact.hand,
                    contact.object,
                    self._usual_radius_m,
                    align_within_deg=contact.align_within_deg,
                )
                for contact in task.contacts
            ]

    @property
    def _usual_radius_m(self) -> float:
        radius_m = min(_RADIUS_M, _SHARE_OF_SIZE * self.object.size_m)
        return round(2e3 * radius_m) / 2e3 if radius_m >= 1e-3 else radius_m  # steps of half a millimetre

    def add(self) -> int:
        """Adds a pair with a region of the hand that has none yet, a thumb's tip first; its number."""
        used = {pair.hand.name for pair in self.pairs}
        free = [region for name, region in self.hand.regions.items() if name not in used]
        links = {pair.hand.link for pair in self.pairs}
        free = free or list(self.hand.regions.values())

        def rank(region: HandRegion) -> tuple[bool, bool, bool]:
            finger, _, place = region.name.partition("/")
            return region.link in links, place != "tip", finger != "thumb"

        best = min(free, key=rank)
        self._changed([*self.pairs, Pair(best, radius_m=self._usual_radius_m)])
        return len(self.pairs) - 1

    def remove(self, number: int) -> None:
        """Takes a pair away; the last one stays.

        Raises:
            InputError: it is the last one.
        """
        if len(self.pairs) == 1:
            raise InputError("edit", "contacts", "a task needs at least one pair of regions")
        self._changed([pair for i, pair in enumerate(self.pairs) if i != number])

    def choose_hand(self, number: int, name: str) -> None:
        """Takes another region of the hand, by name.

        Raises:
            UnknownName: the hand has no such region.
        """
        if name == self.pairs[number].hand.name:
            return
        if name not in self.hand.regions:
            raise UnknownName("edit", "hand", f"region of hand {self.hand.name}", name, self.hand.regions)
        self._replace(number, hand=self.hand.regions[name])

    def choose_object(self, number: int, name: str) -> None:
        """Takes a region that the object has, by name.

        Raises:
            UnknownName: the object has no such region.
        """
        regions = self.object.regions
        if name not in regions:
            raise UnknownName("edit", "object", f"region of object {self.object.name}", name, regions)
        self._replace(number, object=ObjectRegion(name, regions[name]), fit=None)

    def place(self, number: int, at: Array) -> Fit:
        """Fits a patch to the surface around a point (3,) of the object, in m, as the pair's region.

        Raises:
            InputError: no patch of this size fits there; the pair stays as it was.
        """
        fit = self._fitted(at, self.pairs[number].radius_m)
        self._replace(number, object=ObjectRegion("inline", Patch(fit.patch)), fit=fit)
        return fit

    def resize(self, number: int, radius_m: float) -> Fit | None:
        """Fits the pair's patch anew with another radius, or keeps the radius for the next one.

        Raises:
            InputError: no patch of this size fits there; the pair stays as it was.
        """
        pair = self.pairs[number]
        if pair.fit is None:
            self.pairs[number] = replace(pair, radius_m=radius_m)
            return None
        fit = self._fitted(pair.fit.centre, radius_m)
        self._replace(number, object=ObjectRegion("inline", Patch(fit.patch)), fit=fit, radius_m=radius_m)
        return fit

    def limit(self, joint: str, lower: float, upper: float) -> None:
        """Narrows a joint, in rad or m.

        Raises:
            InputError: no such joint, or limits outside the hand's own.
        """
        found = narrowed_limits({joint: (lower, upper)}, self.hand, "edit", "limits")
        number = self.hand.independent_names.index(joint)
        self.limits[number] = found[number]
        self.result = None

    def choose_test(self, test: PhysicalTest) -> str:
        """Takes another test; a line that says what it asks. Configurations stay: they depend on none."""
        self.test = test
        return describe_test(self._whole_test())

    def choose_support(self, support: PointRegion | None) -> None:
        """Puts the object onto a plane, or onto nothing."""
        self.support, self.result = support, None

    def _whole_test(self) -> PhysicalTest:
        """The test with the contacts that press."""
        if isinstance(self.test, PressTest) and not self.test.contacts:
            return replace(self.test, contacts=tuple(range(len(self.pairs))))
        return self.test

    def task(self, name: str = "") -> Task:
        """The task as it stands.

        Raises:
            InputError: a pair is still open, or stands twice.
        """
        contacts: list[Contact] = []
        for i, pair in enumerate(self.pairs):
            if pair.object is None:
                raise InputError(
                    "edit", f"contact {i + 1}", f"{pair.hand.name} has no place yet: click on the object"
                )
            named = pair.hand.name, pair.object.name
            if named[1] != "inline" and named in [(c.hand.name, c.object.name) for c in contacts]:
                raise InputError("edit", f"contact {i + 1}", f"{named[0]} on {named[1]} stands twice")
            contacts.append(Contact(pair.hand, pair.object, pair.align_within_deg))
        old = self.opened
        return Task(
            name=name or ("" if old is None else old.name),
            hand=self.hand,
            object=self.object,
            contacts=contacts,
            limits=self.limits.copy(),
            description="" if old is None else old.description,
            test=self._whole_test(),
            support=self.support,
            T_palm_object=None if old is None else old.T_palm_object,
            max_normal_force_N=None if old is None else old.max_normal_force_N,
        )

    def solve(
        self, *, candidates: int, budget_s: float, should_stop: Callable[[], bool] | None = None
    ) -> SolveResult:
        """Looks for certified configurations of the task as it stands.

        Args:
            candidates: how many to look for.
            budget_s: time after which to stop.
            should_stop: asked between steps.

        Raises:
            InputError: see `task`.
        """
        pairs = list(self.pairs)
        result = solve(self.task(), candidates=candidates, budget_s=budget_s, should_stop=should_stop)
        # What was changed in the meantime is not what was solved.
        self.result = result if pairs == self.pairs else None
        return result

    def _fitted(self, at: Array, radius_m: float) -> Fit:
        return fit_patch(self.object.mesh, np.asarray(at, dtype=float), radius_m, source=self.object.name)

    def _replace(self, number: int, **changes: object) -> None:
        changed = replace(self.pairs[number], **changes)  # type: ignore[arg-type]
        self._changed([changed if i == number else pair for i, pair in enumerate(self.pairs)])

    def _changed(self, pairs: list[Pair]) -> None:
        self.pairs, self.result = pairs, None


def surface_hit(mesh: trimesh.Trimesh, origin: Array, direction: Array) -> Array | None:
    """The point (3,) where a ray first meets a mesh; None where it passes by.

    Args:
        mesh: the surface.
        origin: (3,) where the ray begins, in the frame of the mesh.
        direction: (3,) its direction.
    """
    corners = np.asarray(mesh.triangles)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    towards = normals @ direction
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = np.einsum("ij,ij->i", normals, corners[:, 0] - origin) / towards
    ahead = np.flatnonzero(np.isfinite(distance) & (distance > 0.0))
    points = origin + distance[ahead, None] * direction
    weights = trimesh.triangles.points_to_barycentric(corners[ahead], points)  # type: ignore[no-untyped-call]
    hit = ahead[np.all(weights >= -1e-9, axis=1)]
    if not len(hit):
        return None
    return np.asarray(origin + distance[hit].min() * direction)
