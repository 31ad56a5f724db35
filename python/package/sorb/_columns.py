"""Quantities of particles and nodes."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _sorb
from ._view import View


class Columns:
    """Quantities of particles and nodes, row by row."""

    _world: _sorb.World

    @property
    def particle_positions(self) -> View:
        """Positions of the particles [m], shape (n, 3). Rows change their order from step to step."""
        return View(self._world, "particle_positions")

    @property
    def particle_velocities(self) -> View:
        """Velocities of the particles [m/s], shape (n, 3)."""
        return View(self._world, "particle_velocities")

    @property
    def particle_ids(self) -> View:
        """Identities of the particles, shape (n,): the same number is the same particle for ever."""
        return View(self._world, "particle_ids")

    @property
    def node_positions(self) -> View:
        """Positions of the nodes of all sponges [m], shape (n, 3)."""
        return View(self._world, "node_positions")

    @property
    def node_velocities(self) -> View:
        """Velocities of the nodes [m/s], shape (n, 3)."""
        return View(self._world, "node_velocities")

    @property
    def node_saturations(self) -> View:
        """Saturation of the nodes, about 0 to 1, shape (n,); empty without fluid."""
        return View(self._world, "node_saturations")

    @property
    def node_sponges(self) -> View:
        """Number of the sponge of every node, shape (n,)."""
        return View(self._world, "node_sponges")

    @property
    def triangles(self) -> View:
        """Outer surface of the sponges, shape (n, 3): nodes of every triangle, counter-clockwise as seen from outside."""
        return View(self._world, "triangles")

    def particle_pressures(self) -> npt.NDArray[np.float32]:
        """Pressures of the particles in the last step [Pa], shape (n,); computed."""
        return floats(self._world.compute("particle_pressures"))

    def particle_densities(self) -> npt.NDArray[np.float32]:
        """Densities of the particles by summation [kg/m^3], shape (n,); computed."""
        return floats(self._world.compute("particle_densities"))

    def node_masses(self) -> npt.NDArray[np.float32]:
        """Masses of the dry nodes [kg], shape (n,); computed."""
        return floats(self._world.compute("node_masses"))


def floats(data: bytes) -> npt.NDArray[np.float32]:
    """Numbers out of bytes, which can be written."""
    return np.frombuffer(bytearray(data), np.float32)
