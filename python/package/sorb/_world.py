"""A scene in motion."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _sorb
from ._columns import Columns
from ._errors import CommandError, Error, QueryError
from ._questions import Questions
from ._results import Clock, FrameReport, StepReport
from ._scene import Scene, plain, source_of, texts_of

# The number of a body or sponge, or {"index": .., "generation": ..} where others had the number before.
Handle = Union[int, dict[str, int]]


class World(Columns, Questions):
    """A scene in motion.

    Args:
        scene: name of a scene of the library (`presets`), path of a `.toml` or `.json` file, or a dictionary with the same keys.
        overrides: keys and values to change: `{"fluid.spacing": 0.004, "sponges.sponge.permeability": 1e-10}`.
        quality: "fast", "balanced" or "accurate"; default: the keys of the scene.
        resolution: refines the scene, 0.1 to 8; twice the resolution has 8 times the particles and nodes.
        threads: number of threads, 1 to 1024; default: one per core. Has no effect on results.
        simd: SIMD level; default: the best of the machine. Has no effect on results.
        backend: "cpu", "gpu" or "auto"; "gpu" needs a build with the feature `gpu`.
        keys: as `overrides`, with `__` for a dot: `fluid__spacing=0.004`.

    While a world steps, the interpreter lock is released. One thread at a time uses a world; another one gets a `RuntimeError`. Worlds can
    be pickled and copied, and continue with the same bits.

    Raises:
        SceneError: the scene, a key or a value is wrong; its text names all.
    """

    def __init__(
        self,
        scene: Scene,
        overrides: Mapping[str, Any] | None = None,
        *,
        quality: str | None = None,
        resolution: float = 1.0,
        threads: int | None = None,
        simd: str | None = None,
        backend: str = "cpu",
        **keys: Any,
    ) -> None:
        kind, text = source_of(scene)
        changes = texts_of(overrides, keys)
        self._world = _sorb.World.build(kind, text, quality, changes, resolution, threads, simd, backend)

    @classmethod
    def _of(cls, world: _sorb.World) -> World:
        own = cls.__new__(cls)
        own._world = world
        return own

    @classmethod
    def restore(
        cls, save: bytes, *, threads: int | None = None, simd: str | None = None, backend: str = "cpu"
    ) -> World:
        """The world of a save, which continues with the same bits.

        Raises:
            StateError: the bytes are no save, truncated, altered, or of another version.
        """
        return cls._of(_sorb.World.restore(save, threads, simd, backend))

    # Steps.

    def step(self) -> StepReport:
        """Takes one step, as long as stability allows.

        Raises:
            StepError: the state is no longer finite, or would need steps below `time.minimum_step`.
            BufferError: arrays of this world are still in use (`View`).
        """
        return StepReport(*self._world.step())

    def advance_frame(self) -> FrameReport:
        """Takes as many steps as fill a frame of `1 / time.frame_rate` seconds; raises as `step`."""
        return FrameReport(*self._world.advance_frame())

    def run(
        self,
        *,
        frames: int | None = None,
        seconds: float | None = None,
        each: Callable[[World, FrameReport], Any] | None = None,
    ) -> World:
        """Takes frames: so many, or until so many seconds more have passed, or those that `time.duration` leaves. Ends between two
        frames when the user interrupts (Ctrl-C). Raises as `step`.

        Args:
            frames: number of frames.
            seconds: simulated time; the last frame ends at it or after it.
            each: called after every frame with the world and the report of the frame. `False` ends the run.

        Returns:
            the world.
        """
        if frames is None:
            rate = self.scene["time"]["frame_rate"]
            span = seconds if seconds is not None else self.scene["time"]["duration"] - self.clock.time
            # Rates and durations have 24 bits: 6000 frames may be 6000.0004.
            frames = max(int(np.ceil(span * rate - 1e-3)), 0)
        elif seconds is not None:
            raise ValueError("give frames or seconds, not both")
        for _ in range(frames):
            report = self.advance_frame()
            if each is not None and each(self, report) is False:
                break
        return self

    @property
    def clock(self) -> Clock:
        """Simulated time, steps and frames."""
        return Clock(*self._world.clock())

    @property
    def time(self) -> float:
        """Simulated time since the start [s]."""
        return self.clock.time

    @property
    def scene(self) -> dict[str, Any]:
        """The scene that the world was built from."""
        own: dict[str, Any] = json.loads(self._world.scene())
        return own

    # Commands.

    def push(self, command: str | Mapping[str, Any], **fields: Any) -> None:
        """Pushes a command; the next step begins with all of them, in their order.

            world.push("impulse", body="ball", impulse=[0, 1, 0], angular_impulse=[0, 0, 0])
            world.push({"remove": {"region": {"sphere": {"centre": [0, 0.1, 0], "radius": 0.05}}}})

        Bodies go by name, number or handle. docs/embedding.md lists the commands, src/command/mod.rs their fields with ranges.

        Raises:
            CommandError: a value is out of range, or there is no such body or node; nothing has changed.
        """
        own = {command: fields} if isinstance(command, str) else dict(command)
        own = plain(own, "", CommandError)
        for kind, values in own.items():
            if isinstance(values, dict) and isinstance(values.get("body"), str):
                values["body"] = self._handle_of(values["body"], f"{kind}.body")
        self._world.push(json.dumps(own))

    def move(
        self,
        body: str | Handle,
        position: Sequence[float],
        rotation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        duration: float | None = None,
    ) -> None:
        """Moves a kinematic body to a pose at constant velocity and rate.

        Args:
            body: name, number or handle.
            position: of its centre, -1000 to 1000 m.
            rotation: quaternion of unit length: x, y, z, w.
            duration: time to get there, 0.000001 to 100000 s; default: a frame.

        Raises:
            CommandError: as `push`.
        """
        if duration is None:
            duration = 1.0 / self.scene["time"]["frame_rate"]
        self.push("pose", body=body, position=position, rotation=rotation, duration=duration)

    def pour(
        self, minimum: Sequence[float], maximum: Sequence[float], velocity: Sequence[float] = (0.0, 0.0, 0.0)
    ) -> None:
        """Pours water into a box along the axes, from its lowest to its highest corner [m], with a velocity [m/s].

        Raises:
            CommandError: as `push`, or there is no room.
        """
        self.push("pour", region={"box": {"minimum": minimum, "maximum": maximum}}, velocity=velocity)

    def emit(self, emitter: Mapping[str, Any]) -> int:
        """Begins a stream of water with the keys of `emitters` in a scene; its number, for `push("end_flow", number=...)`."""
        return self._begin("emit", "emitter", emitter)

    def drain(self, drain: Mapping[str, Any]) -> int:
        """Opens a drain with the keys of `drains` in a scene; its number."""
        return self._begin("drain", "drain", drain)

    def add_body(self, body: Mapping[str, Any]) -> Handle:
        """Adds a body with the keys of `bodies` in a scene; its handle, for `push("remove_body", body=...)`.

        Raises:
            CommandError: as `push`, or it is in a sponge or in water.
        """
        handle = _handle(*self._world.next_body())
        self.push({"add_body": {"body": handle, "description": body}})
        return handle

    def add_sponge(self, sponge: Mapping[str, Any]) -> Handle:
        """Adds a sponge with the keys of `sponges` in a scene; its handle, for `push("remove_sponge", sponge=...)`. Rows of nodes change.

        Raises:
            CommandError: as `push`, or it is in a body or in another sponge.
        """
        handle = _handle(*self._world.next_sponge())
        self.push({"add_sponge": {"sponge": handle, "description": sponge}})
        return handle

    def _begin(self, kind: str, name: str, flow: Mapping[str, Any]) -> int:
        number = self._world.next_flow()
        self.push({kind: {"number": number, name: flow}})
        return number

    def _handle_of(self, name: str, key: str) -> Handle:
        names = [body[0] for body in self._world.bodies()]
        found = {names[index]: _handle(index, generation) for index, generation in self._world.body_handles()}
        if name not in found:
            raise CommandError(f"command: `{key}` = {name!r} is no body; bodies: {', '.join(found)}", [key])
        return found[name]

    # States.

    @property
    def digest(self) -> int:
        """Digest of the state: equal ones continue with the same bits."""
        return self._world.digest()

    def save(self, *, compressed: bool = False) -> bytes:
        """The state with its scene: the bytes of a file that `sorb run --from` reads.

        Raises:
            StateError: the world has failed.
        """
        return self._world.save(compressed)

    def resume(self, save: bytes) -> None:
        """Returns to a save of the same scene, without building anything anew.

        Raises:
            StateError: the save is of another scene, or not usable; nothing has changed.
        """
        self._world.resume(save)

    def snapshot(self, into: _sorb.Snapshot | None = None) -> _sorb.Snapshot:
        """Copies the state into a snapshot, in the memory of `into` if it is given."""
        snapshot = into if into is not None else _sorb.Snapshot()
        self._world.snapshot_into(snapshot)
        return snapshot

    def rollback(self, snapshot: _sorb.Snapshot) -> None:
        """Returns to a snapshot of this world.

        Raises:
            StateError: it is empty, or of another scene.
        """
        self._world.rollback(snapshot)

    def record(self, every: int | None = 60) -> None:
        """Begins a recording: from now on it takes all commands, steps and frames.

        Args:
            every: frames from a save in it to the next; `None`: no saves.
        """
        self._world.record(every)

    def end_recording(self) -> bytes:
        """Ends the recording: the bytes of a file that `sorb replay` and `verify` play."""
        return self._world.end_recording()

    def copy(self) -> World:
        """A copy, which continues with the same bits. A recording stays with this world."""
        return self._of(self._world.copy())

    __copy__ = copy

    def __deepcopy__(self, memo: dict[int, Any]) -> World:
        return self.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        return World.restore, (self.save(),)

    # Pictures.

    def picture(
        self,
        width: int = 640,
        height: int = 480,
        *,
        view: str = "realistic",
        eye: Sequence[float] | None = None,
        target: Sequence[float] | None = None,
        field_of_view_degrees: float | None = None,
    ) -> npt.NDArray[np.uint8]:
        """Draws the world on the CPU: sRGB, rows from top to bottom, shape (height, width, 3).

        Args:
            width, height: 1 to 16384 pixels.
            view: "realistic", "fast", "particles", "nodes", "superimposed", "saturation", "pressure", "speed" or "cutaway".
            eye, target: places of the camera, and in the middle of the picture [m]; default: the camera of the scene.
            field_of_view_degrees: vertical, 1 to 150; default: that of the scene.

        Raises:
            QueryError: a size or a view is out of range.
            SceneError: the camera is.
        """
        for name, size in (("width", width), ("height", height)):
            if not 1 <= size <= 16384:
                raise QueryError(f"{name} = {size} is out of range 1 to 16384 pixels", [name])
        camera = (_place(eye), _place(target), field_of_view_degrees)
        pixels = self._world.picture((width, height), view, camera)
        return np.frombuffer(bytearray(pixels), np.uint8).reshape(height, width, 3)

    def __repr__(self) -> str:
        scene, clock = self.scene, self.clock
        particles, nodes = len(self.particle_ids), len(self.node_sponges)
        return f"<sorb.World {scene['name']}, {particles} particles, {nodes} nodes, {clock.time:.3f} s>"


def verify(recording: bytes, *, threads: int | None = None, simd: str | None = None, backend: str = "cpu") -> int:
    """Plays a recording to its end, and compares every frame; the number of frames and single steps.

    Raises:
        ReplayError: a frame differs; the text names it, and the first column, row and both values.
        StateError: the bytes are no recording, truncated or altered.
    """
    return _sorb.verify(recording, threads, simd, backend)


def write_png(path: str | os.PathLike[str], picture: npt.ArrayLike) -> None:
    """Writes a picture of shape (height, width, 3) as a PNG file.

    Raises:
        Error: it has another shape, or the file cannot be written.
    """
    pixels = np.ascontiguousarray(picture, np.uint8)
    if pixels.ndim != 3 or pixels.shape[2] != 3:
        raise Error(f"a picture of shape {pixels.shape}; expected (height, width, 3)")
    _sorb.write_png(os.fspath(path), pixels.shape[1], pixels.shape[0], pixels.tobytes())


def _handle(index: int, generation: int) -> Handle:
    return index if generation == 0 else {"index": index, "generation": generation}


def _place(values: Sequence[float] | None) -> tuple[float, float, float] | None:
    if values is None:
        return None
    x, y, z = (float(value) for value in values)
    return x, y, z
