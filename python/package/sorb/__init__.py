"""An absorbent sponge, the water it drinks and the bodies that squeeze it.

    import sorb

    world = sorb.World("ball_drop")
    world.run(frames=30)
    print(world.measures()["absorbed_mass"], "kg of water in the sponge")

Units are SI, Y is up. The same scene and the same commands give the same bits on every run, on any number of threads.
"""

from ._errors import CommandError, Error, QueryError, ReplayError, SceneError, StateError, StepError
from ._results import Body, BodyLoads, Clock, FrameReport, Hit, Load, Probe, StepReport
from ._scene import presets, scene
from ._sorb import Snapshot
from ._sorb import version as __version__
from ._sweep import sweep
from ._view import View
from ._world import World, verify, write_png

__all__ = [
    "Body",
    "BodyLoads",
    "Clock",
    "CommandError",
    "Error",
    "FrameReport",
    "Hit",
    "Load",
    "Probe",
    "QueryError",
    "ReplayError",
    "SceneError",
    "Snapshot",
    "StateError",
    "StepError",
    "StepReport",
    "View",
    "World",
    "__version__",
    "presets",
    "scene",
    "sweep",
    "verify",
    "write_png",
]
