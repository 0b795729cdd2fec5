"""At which share of Coulomb's critical load a box slips between two fingertips of a hand, its servos and all.

Usage: ./run bench coulomb_hand [--hand HAND] [--contacts REGION REGION] [--mass KG ...] [--seconds S]

A box is pinched on the middles of two opposite faces by a squeeze as it is planned for any grasp: servos
press, pads and joints yield. Then, without gravity, a force along the faces acts in one of four directions,
or a torque about the line of the pinch. The normal forces are those measured in the simulation under that
load. By Coulomb's law the box slips from friction times their sum on, and turns from the sum of friction
times normal force times arm on, the arm of a contact made of its spin friction and of its distance from the
middle. A load is held unless both fingertips slide along the box by 1 mm, or it spins on both by 2.3 deg,
from the first bit of the load to the end of the time given; one alone may, until the other bears its share.
The loads between which that changes are found by bisection; the forces under both are taken to be those
under the one that holds. Masses make squeezes of other forces.
"""

import argparse

import holdfast as hf
import numpy as np
import trimesh
from holdfast.base.numeric.arrays import Array
from holdfast.base.text.console import format_table
from holdfast.mjcf import Grasp, HoldSettings, preset_settings
from holdfast.mjcf.hold.lift import Lift
from holdfast.mjcf.hold.simulation import Simulation
from holdfast.mjcf.model import OBJECT_BODY
from holdfast.objects import Task

FRICTION = 0.6
SIZE_M, REGION_M = (0.04, 0.06, 0.03), 0.001
PRESETS = ("holdfast", "no_noslip")
CANDIDATES = 4
RAMP_S, SAMPLE_S = 0.5, 0.01
SLIDES_M, SLIDES_RAD = 1e-3, 0.04
HIGHEST, RESOLUTION = 2.0, 0.005
LOADS = {
    "pulled along +x": (1.0, 0.0, 0.0),
    "pulled along -x": (-1.0, 0.0, 0.0),
    "pulled along +y": (0.0, 1.0, 0.0),
    "pulled along -y": (0.0, -1.0, 0.0),
    "spun": None,
}


def pinch_task(hand: str, regions: tuple[str, str], mass_kg: float) -> Task:
    """A box to be pinched on the middles of its faces z = +-SIZE/2."""
    r, z = REGION_M, 0.5 * SIZE_M[2]
    top = np.array([[[x, -r, z], [x, r, z]] for x in (-r, r)])
    bottom = np.array([[[x, r, -z], [x, -r, -z]] for x in (-r, r)])
    box = hf.load_object(trimesh.creation.box(SIZE_M), mass_kg=mass_kg, friction=FRICTION)
    return hf.Task(hand=hand, object=box, contacts=dict(zip(regions, (top, bottom), strict=True)))


def pinch_grasp(task: Task) -> Grasp:
    """The first pinch that is clear and has a squeeze."""
    for configuration in hf.solve(task, candidates=CANDIDATES, seed=1):
        ready = hf.make_grasp(configuration)
        if ready:
            return ready.grasp
    raise SystemExit(f"bench coulomb_hand: no pinch with {task.hand.name} is clear and can be squeezed")


def squeezed(grasp: Grasp, settings: HoldSettings) -> Simulation:
    """The pinch in its squeeze, without gravity."""
    lift = Lift(grasp, settings)
    lift.squeeze()
    lift.simulation.model.opt.gravity[:] = 0.0
    return lift.simulation


class Pinch:
    """A squeezed pinch, to be loaded again and again."""

    def __init__(self, grasp: Grasp, settings: HoldSettings):
        self.grasp = grasp
        self._simulation = squeezed(grasp, settings)
        self._squeezed = self._simulation.full_state()
        model, task = self._simulation.model, grasp.configuration.task
        self._body = model.body(OBJECT_BODY).id
        self._tips = [model.body(task.hand.links[contact.hand.link].name).id for contact in task.contacts]

    def normals_N(self) -> Array:
        """Normal forces (2,) as things are now."""
        return self._simulation.normal_forces()

    def critical(self, direction: tuple[float, ...] | None) -> float:
        """Largest force in N, or without a direction torque in N m, by Coulomb's law as things are now."""
        normals_N = self._simulation.normal_forces()
        if direction is not None:
            return float(FRICTION * normals_N.sum())
        return float(FRICTION * normals_N @ np.hypot(self.grasp.squeeze.spin_arms_m, self._offsets()))

    def _offsets(self) -> Array:
        """Distances (2,) in m of the contacts from the line about which the box turns."""
        model, data, points = self._simulation.model, self._simulation.data, []
        for tip in self._tips:
            touches = data.contact[: data.ncon]
            own = [c for c in touches if {int(model.geom_bodyid[g]) for g in c.geom} == {self._body, tip}]
            points.append(np.mean([c.pos for c in own], axis=0))
        flat = (np.array(points) @ self._rotation())[:, :2]
        return np.linalg.norm(flat - flat.mean(axis=0), axis=1)

    def _rotation(self) -> Array:
        return self._simulation.data.xmat[self._body].reshape(3, 3).copy()

    def slips(self, direction: tuple[float, ...] | None, load: float, seconds: float) -> bool:
        """Whether the squeezed box slips under a load in a direction (3,) of its frame, or a torque."""
        simulation, data = self._simulation, self._simulation.data
        simulation.restore(self._squeezed)
        wrench = np.zeros(6)
        if direction is None:
            wrench[3:] = self._rotation() @ (0.0, 0.0, load)
        else:
            wrench[:3] = self._rotation() @ (load * np.array(direction))
        slid = np.zeros(2)
        spun = np.zeros(2)
        count = round((RAMP_S + seconds) / SAMPLE_S)
        for k in range(1, count + 1):
            data.xfrc_applied[self._body] = min(1.0, k * SAMPLE_S / RAMP_S) * wrench
            simulation.step(simulation.steps(SAMPLE_S))
            normals_N, speeds = simulation.contact_speeds()
            slid += SAMPLE_S * speeds
            spun += SAMPLE_S * self._spins()
            if not normals_N.all() or slid.min() > SLIDES_M or np.abs(spun).min() > SLIDES_RAD:
                return True
        return False

    def _spins(self) -> Array:
        """How fast (2,) in rad/s the box spins on each fingertip, about its z axis."""
        # MuJoCo keeps angular velocities of bodies in the first half of `cvel`.
        turning = self._simulation.data.cvel[[self._body, *self._tips], :3] @ self._rotation()[:, 2]
        return turning[0] - turning[1:]


def boundary(pinch: Pinch, direction: tuple[float, ...] | None, seconds: float) -> tuple[float, float, Array]:
    """Shares of the critical load that were seen to hold and to slip, and the normal forces (2,) then."""
    first = pinch.critical(direction)
    low, high = 0.0, HIGHEST * first
    if not pinch.slips(direction, high, seconds):
        raise SystemExit(f"bench coulomb_hand: it holds {HIGHEST} times the critical load")
    while high - low > RESOLUTION * first:
        middle = 0.5 * (low + high)
        if pinch.slips(direction, middle, seconds):
            high = middle
        else:
            low = middle
    pinch.slips(direction, low, seconds)
    critical = pinch.critical(direction)
    return low / critical, high / critical, pinch.normals_N()


def both(normals_N: Array) -> str:
    return " + ".join(f"{force:.2f}" for force in normals_N)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--hand", default="sa")
    parser.add_argument("--contacts", nargs=2, default=("index/tip", "thumb/tip"), metavar="REGION")
    parser.add_argument("--mass", nargs="+", type=float, default=(0.3, 1.0), metavar="KG")
    parser.add_argument("--seconds", type=float, default=2.0, help="under the load")
    arguments = parser.parse_args()
    rows = []
    for mass_kg in arguments.mass:
        task = pinch_task(arguments.hand, tuple(arguments.contacts), mass_kg)
        grasp = pinch_grasp(task)
        for name in PRESETS:
            pinch = Pinch(grasp, preset_settings(name, task))
            before = both(pinch.normals_N())
            for title, direction in LOADS.items():
                low, high, normals_N = boundary(pinch, direction, arguments.seconds)
                rows.append((name, before, title, both(normals_N), f"{low:.3f}", f"{high:.3f}"))
    header = ("settings", "squeezed (N)", "load", "pressed under it (N)", "holds at", "slips at")
    print(format_table(header, rows))
    print("shares of the critical load by Coulomb's law with the normal forces measured under it")


if __name__ == "__main__":
    main()
