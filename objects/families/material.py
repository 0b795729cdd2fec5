"""Materials that members of families are made of."""

from dataclasses import dataclass

__all__ = [
    "ALUMINIUM",
    "GLASS",
    "OAK",
    "PET",
    "POLYPROPYLENE",
    "STAINLESS_STEEL",
    "STONEWARE",
    "WATER",
    "Material",
]


@dataclass(frozen=True)
class Material:
    """A material.

    Attributes:
        name: for people.
        density: in kg/m^3.
        rgba: colour for pictures.
        source: where the density comes from.
    """

    name: str
    density: float
    rgba: tuple[float, float, float, float]
    source: str

    def __str__(self) -> str:
        return f"{self.name}, {self.density:g} kg/m^3 ({self.source})"


_CALLISTER = "Callister, Materials Science and Engineering, table B.1"

OAK = Material("red oak", 640.0, (0.72, 0.53, 0.34, 1.0), _CALLISTER)
POLYPROPYLENE = Material("polypropylene", 905.0, (0.30, 0.52, 0.66, 1.0), _CALLISTER)
PET = Material("PET", 1350.0, (0.66, 0.80, 0.84, 1.0), _CALLISTER)
GLASS = Material("soda-lime glass", 2500.0, (0.70, 0.82, 0.78, 1.0), _CALLISTER)
ALUMINIUM = Material("aluminium 6061", 2710.0, (0.78, 0.79, 0.81, 1.0), _CALLISTER)
STAINLESS_STEEL = Material("stainless steel 304", 8000.0, (0.74, 0.75, 0.77, 1.0), _CALLISTER)
STONEWARE = Material("stoneware", 2300.0, (0.86, 0.84, 0.78, 1.0), "dense stoneware has 2200 to 2400")
WATER = Material("water", 998.0, (0.6, 0.7, 0.9, 1.0), "at 20 deg C")
