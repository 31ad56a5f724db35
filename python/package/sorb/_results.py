"""What questions and steps answer with."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt


class StepReport(NamedTuple):
    """Result of a step."""

    time: float
    """Time after the step [s]."""
    step: float
    """Length of the step [s]."""
    bound: str
    """What limited it, such as `courant`."""
    maximum_speed: float
    """Largest speed of particles and nodes after the step [m/s]."""


class FrameReport(NamedTuple):
    """Result of a frame."""

    time: float
    """Time after the frame [s]."""
    steps: int
    """Steps of the frame."""
    shortest_step: float
    """Shortest step of the frame [s]; infinite if there was none."""
    bound: str
    """What limited most of the steps."""
    maximum_speed: float
    """Largest speed of particles and nodes in the frame [m/s]."""


class Clock(NamedTuple):
    """Simulated time."""

    time: float
    """Time since the start [s]."""
    steps: int
    """Steps taken."""
    frames: int
    """Frames completed."""


class Body(NamedTuple):
    """Pose and velocity of a body."""

    name: str
    """Its name in the scene."""
    position: tuple[float, float, float]
    """Centre of mass [m]."""
    rotation: tuple[float, float, float, float]
    """Rotation from its frame to the world, a quaternion of unit length: x, y, z, w."""
    linear_velocity: tuple[float, float, float]
    """Velocity of the centre of mass [m/s]."""
    angular_velocity: tuple[float, float, float]
    """Angular velocity, in the frame of the world [rad/s]."""


class Load(NamedTuple):
    """Force and torque about the centre of mass of a body."""

    force: tuple[float, float, float]
    """Force [N]."""
    torque: tuple[float, float, float]
    """Torque [N m]."""


class BodyLoads(NamedTuple):
    """What acts on a body beside its weight: means over the steps of the last frame."""

    fluid: Load
    """By the fluid."""
    sponges: Load
    """By sponges."""
    host: Load
    """By forces that were commanded."""
    contact: Load
    """By other bodies and the walls; zero for bodies that are not dynamic."""


class Hit(NamedTuple):
    """What rays meet; one row a ray."""

    distance: npt.NDArray[np.float32]
    """Distance from the origin [m], shape (n,); NaN for a ray that meets nothing."""
    point: npt.NDArray[np.float32]
    """The place [m], shape (n, 3)."""
    normal: npt.NDArray[np.float32]
    """Outward normal there, of unit length, shape (n, 3)."""
    surface: npt.NDArray[np.int32]
    """0 nothing, 1 a body, 2 a sponge, 3 water; shape (n,)."""
    number: npt.NDArray[np.int32]
    """Number of the body or sponge in the scene; shape (n,)."""


class Probe(NamedTuple):
    """What is at points; one row a point."""

    filled: npt.NDArray[np.float32]
    """Share of the space around that is water, about 0 to 1; shape (n,)."""
    density: npt.NDArray[np.float32]
    """Mass of water over space around [kg/m^3]; shape (n,)."""
    velocity: npt.NDArray[np.float32]
    """Mean velocity of the water around [m/s]; shape (n, 3)."""
    pressure: npt.NDArray[np.float32]
    """Mean pressure of the water around [Pa]; shape (n,)."""
    sponge: npt.NDArray[np.int32]
    """Number of the sponge that the point lies in, or -1 and zeros below; shape (n,)."""
    saturation: npt.NDArray[np.float32]
    """Water-filled pore volume over pore volume, about 0 to 1; shape (n,)."""
    pore_pressure: npt.NDArray[np.float32]
    """Pressure of the water in the pores [Pa]; shape (n,)."""
    sponge_velocity: npt.NDArray[np.float32]
    """Velocity of the sponge [m/s]; shape (n, 3)."""
    volume_ratio: npt.NDArray[np.float32]
    """Volume of the sponge over that at rest [1]; shape (n,)."""
