"""Questions about the present state."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _sorb
from ._columns import floats
from ._errors import QueryError
from ._results import Body, BodyLoads, Hit, Load, Probe

TARGETS = ("bodies", "sponges", "water")


class Questions:
    """Questions about the present state."""

    _world: _sorb.World

    @property
    def bodies(self) -> dict[str, Body]:
        """Poses and velocities of the bodies, by name in the order of the scene."""
        own = self._world.bodies()
        return {own[index][0]: Body(*own[index]) for index, _ in self._world.body_handles()}

    def body_loads(self) -> dict[str, BodyLoads]:
        """What acts on every body, by name; empty before the first step."""
        loads = [BodyLoads(**{name: Load(*own) for name, *own in body}) for body in self._world.body_loads()]
        names = [own[0] for own in self._world.bodies()]
        return {names[index]: loads[index] for index, _ in self._world.body_handles() if index < len(loads)}

    def measures(self) -> dict[str, Any]:
        """Masses, momenta, energies and errors of the present state; docs/measures.md explains them."""
        return {name: own[0] if len(own) == 1 else tuple(own) for name, own in self._world.measures()}

    def ledger(self) -> dict[str, Any]:
        """Where all water came from and went, in particles, and the mass of a particle [kg]."""
        counts, mass = self._world.ledger()
        return {**dict(counts), "particle_mass": mass}

    def cast_rays(
        self, origins: npt.ArrayLike, directions: npt.ArrayLike, length: npt.ArrayLike = 2000.0,
        targets: Iterable[str] = TARGETS,
    ) -> Hit:
        """What every ray meets first.

        Args:
            origins: where they begin, -1000 to 1000 m, shape (n, 3) or (3,).
            directions: of any length but zero, shape (n, 3) or (3,).
            length: 0 to 2000 m, shape (n,) or one for all.
            targets: of "bodies", "sponges" and "water".

        Raises:
            QueryError: a ray is not finite, has no direction, or a length out of range.
        """
        targets = tuple(targets)
        unknown = [name for name in targets if name not in TARGETS]
        if unknown:
            raise QueryError(f"targets = {unknown} are none of {', '.join(TARGETS)}", ["targets"])
        starts, ways = points_of(origins, 3, "origins"), points_of(directions, 3, "directions")
        count = max(len(starts), len(ways))
        rays = np.empty((count, 7), np.float32)
        rays[:, :3], rays[:, 3:6], rays[:, 6] = starts, ways, length
        bodies, sponges, water = (name in targets for name in TARGETS)
        rows = floats(self._world.cast_rays(rays.tobytes(), (bodies, sponges, water))).reshape(-1, 9)
        whole = rows[:, 7:].astype(np.int32)
        return Hit(rows[:, 0], rows[:, 1:4], rows[:, 4:7], whole[:, 0], whole[:, 1])

    def water_levels(self, places: npt.ArrayLike) -> npt.NDArray[np.float32]:
        """Height of the highest surface of water at every x and z [m]; NaN where there is none. `places` has the shape (n, 2).

        Raises:
            QueryError: a place is not finite or out of range -1000 to 1000 m.
        """
        return floats(self._world.water_levels(points_of(places, 2, "places").tobytes()))

    def probe(self, points: npt.ArrayLike) -> Probe:
        """What is at every point: the water around it, and the sponge that it lies in. `points` [m] has the shape (n, 3) or (3,).

        Raises:
            QueryError: a point is not finite or out of range -1000 to 1000 m.
        """
        rows = floats(self._world.probe(points_of(points, 3, "points").tobytes())).reshape(-1, 13)
        return Probe(
            *(rows[:, 0], rows[:, 1], rows[:, 2:5], rows[:, 5], rows[:, 6].astype(np.int32)),
            *(rows[:, 7], rows[:, 8], rows[:, 9:12], rows[:, 12]),
        )


def points_of(values: npt.ArrayLike, width: int, name: str) -> npt.NDArray[np.float32]:
    """Rows of so many numbers."""
    rows = np.atleast_2d(np.ascontiguousarray(values, np.float32))
    if rows.size == 0:
        rows = rows.reshape(0, width)
    if rows.ndim != 2 or rows.shape[1] != width:
        raise QueryError(f"{name} of shape {np.shape(values)}; expected (n, {width})", [name])
    return rows
