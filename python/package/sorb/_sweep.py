"""Sweeps: one scene with many settings, in processes or on Ray, as a table."""

from __future__ import annotations

import csv
import hashlib
import itertools
import json
import multiprocessing
import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from pathlib import Path
from typing import Any, NamedTuple, Union

from ._errors import Error, SceneError
from ._scene import Scene, plain, scene
from ._world import World

Row = dict[str, Any]
Measure = Union[None, str, Sequence[str], Callable[[World], Any]]

END = ("digest", "wall_seconds", "error")


class _Job(NamedTuple):
    """One run, as it goes to another process."""

    number: int
    settings: dict[str, Any]
    source: Scene
    options: dict[str, Any]
    frames: int | None
    seconds: float | None
    measure: Measure


def sweep(
    source: Scene,
    grid: Mapping[str, Iterable[Any]] | Iterable[Mapping[str, Any]],
    measure: Measure = None,
    *,
    frames: int | None = None,
    seconds: float | None = None,
    processes: int = 1,
    on: str = "processes",
    out: str | os.PathLike[str] | None = None,
    shard: tuple[int, int] = (0, 1),
    **options: Any,
) -> list[Row]:
    """Runs a scene with many settings.

        sorb.sweep("ball_drop", {"sponges.sponge.permeability": [1e-10, 1e-9], "resolution": [0.5, 0.7]}, "absorbed_mass", seconds=0.5)

    A run depends on its settings alone, so that the table is the same on any number of processes, but for `wall_seconds`. Scripts need
    `if __name__ == "__main__":` around the call, because processes import them; a `measure` that is a function must be in a module.

    Args:
        source: a scene, as `World` takes it.
        grid: for every key its values, of which all combinations run, or the settings of every run. Keys are those of scenes, and
            "resolution" and "quality".
        measure: names of measures (`World.measures`), of which vectors become three numbers such as `sponge_centre_x`, or a function that
            takes the world at the end and returns a number or a dictionary; default: all measures that are numbers.
        frames, seconds: length of a run, as `World.run` takes it.
        processes: number of processes, at least 1. In more than one, worlds have one thread each unless `threads` is given.
        on: "processes" of this machine, or "ray": a Ray cluster, which retries runs of workers that are lost.
        out: path of the table as CSV; beside it goes the same as `.parquet` if pyarrow is installed, and the runs as they end
            (`.jsonl`). Runs that are there are not run again, so that a sweep that was ended continues.
        shard: of i and n: every n-th run from the i-th on, for jobs of a cluster. Give every shard an `out` of its own. The command
            `sorb sweep` makes one table of all shards.
        options: `overrides`, `quality`, `resolution`, `threads` and keys, as `World` takes them.

    Returns:
        a row for every run in the order of the grid: `run`, its settings, its measures, `digest`, `wall_seconds`, and `error`, which is
        empty unless the run failed. Failed runs do not end the sweep, and run again when it continues.

    Raises:
        SceneError: the scene, or the settings of a run are wrong; nothing has run.
        Error: the file is of another sweep.
    """
    part, parts = shard
    if not 0 <= part < parts or processes < 1 or on not in ("processes", "ray"):
        raise Error(f"shard = {shard}, processes = {processes}, on = {on!r}: out of range", ["shard", "processes", "on"])
    if processes > 1 or on == "ray":
        options.setdefault("threads", 1)
    jobs = [
        _Job(number, settings, source, options, frames, seconds, measure)
        for number, settings in enumerate(_settings(grid))
        if number % parts == part
    ]
    # Every mistake in a setting is found before anything runs.
    scenes = [scene(source, **_arguments(job, threads=False)) for job in jobs]
    journal = _Journal(Path(os.fspath(out)), _identity(scenes, jobs)) if out is not None else None
    done = dict(journal.rows) if journal else {}
    left = [job for job in jobs if job.number not in done]
    for row in _rows(left, processes, on):
        done[row["run"]] = row
        if journal:
            journal.add(row)
    table = [done[job.number] for job in jobs]
    if journal:
        journal.finish(table)
    return table


def _settings(grid: Mapping[str, Iterable[Any]] | Iterable[Mapping[str, Any]]) -> list[dict[str, Any]]:
    if isinstance(grid, Mapping):
        values = [list(plain(list(own), key, SceneError)) for key, own in grid.items()]
        return [dict(zip(grid, combination)) for combination in itertools.product(*values)]
    return [plain(own, "", SceneError) for own in grid]


def _arguments(job: _Job, threads: bool = True) -> dict[str, Any]:
    """Arguments of a world: settings replace options."""
    named = {key: value for key, value in job.settings.items() if key in ("resolution", "quality")}
    keys = {key: value for key, value in job.settings.items() if key not in named}
    options = dict(job.options)
    if not threads:
        for name in ("threads", "simd", "backend"):
            options.pop(name, None)
    return {**options, **named, "overrides": {**(options.get("overrides") or {}), **keys}}


def _run(job: _Job) -> Row:
    """One run: its row. What goes wrong is part of it."""
    start = time.perf_counter()
    measures: dict[str, Any] = {}
    digest, error = "", ""
    try:
        world = World(job.source, **_arguments(job))
        world.run(frames=job.frames, seconds=job.seconds)
        measures, digest = _measured(world, job.measure), f"{world.digest:016x}"
    except Exception as failure:  # noqa: BLE001 - of the simulation or of the function of the caller
        error = f"{type(failure).__name__}: {failure}"
    wall = round(time.perf_counter() - start, 3)
    return {"run": job.number, **job.settings, **measures, "digest": digest, "wall_seconds": wall, "error": error}


def _measured(world: World, measure: Measure) -> dict[str, Any]:
    if callable(measure):
        value = measure(world)
        found: dict[str, Any] = plain(value if isinstance(value, Mapping) else {"measure": value}, "", Error)
        return found
    own = world.measures()
    if measure is None:
        return {name: value for name, value in own.items() if isinstance(value, float)}
    names = [measure] if isinstance(measure, str) else list(measure)
    unknown = [name for name in names if name not in own]
    if unknown:
        raise Error(f"no measure {unknown}; measures: {', '.join(own)}", unknown)
    found = {}
    for name in names:
        vector = isinstance(own[name], tuple)
        found.update(zip((f"{name}_{axis}" for axis in "xyz"), own[name]) if vector else [(name, own[name])])
    return found


def _rows(jobs: list[_Job], processes: int, on: str) -> Iterator[Row]:
    """Rows in the order in which the runs end."""
    if on == "ray":
        yield from _on_ray(jobs)
    elif processes == 1:
        yield from map(_run, jobs)
    else:
        # A process that is forked from one with threads may hang.
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(min(processes, max(len(jobs), 1)), mp_context=context) as pool:
            left: set[Future[Row]] = {pool.submit(_run, job) for job in jobs}
            while left:
                ended, left = wait(left, return_when=FIRST_COMPLETED)
                yield from (future.result() for future in ended)


def _on_ray(jobs: list[_Job]) -> Iterator[Row]:
    import ray  # type: ignore[import-not-found, import-untyped, unused-ignore]

    if not ray.is_initialized():
        ray.init()
    left = []
    for job in jobs:
        run = ray.remote(num_cpus=job.options["threads"] or 1, max_retries=5)(_run)
        left.append(run.remote(job))
    while left:
        ended, left = ray.wait(left)
        yield from ray.get(ended)


def _identity(scenes: list[dict[str, Any]], jobs: list[_Job]) -> str:
    """What a sweep computes: its scenes, its length and its measure by name."""
    own = [(job.number, job.frames, job.seconds, getattr(job.measure, "__qualname__", job.measure)) for job in jobs]
    return hashlib.sha256(json.dumps([scenes, own]).encode()).hexdigest()


class _Journal:
    """The runs of a sweep as they end, one a line. A line that was cut off by an end by force is no run."""

    def __init__(self, table: Path, identity: str) -> None:
        self.table = table
        self.path = table.with_name(table.name + ".jsonl")
        self.rows: dict[int, Row] = {}
        table.parent.mkdir(parents=True, exist_ok=True)
        lines = self.path.read_text().splitlines() if self.path.exists() else []
        entries = [entry for entry in map(_entry, lines) if entry is not None]
        if entries and entries[0].get("sweep") != identity:
            raise Error(f"{self.path} is of another sweep: remove it, or choose another `out`", ["out"])
        self.rows = {entry["run"]: entry for entry in entries[1:] if not entry["error"]}
        kept = [{"sweep": identity}, *self.rows.values()]
        self.path.write_text("".join(json.dumps(entry) + "\n" for entry in kept))

    def add(self, row: Row) -> None:
        with self.path.open("a") as file:
            file.write(json.dumps(row) + "\n")

    def finish(self, rows: list[Row]) -> None:
        """Writes the table."""
        names = list(dict.fromkeys(name for row in rows for name in row if name not in END))
        with self.table.open("w", newline="") as file:
            writer = csv.DictWriter(file, [*names, *END], restval="")
            writer.writeheader()
            writer.writerows({name: _cell(value) for name, value in row.items()} for row in rows)
        try:
            import pyarrow  # type: ignore[import-not-found, import-untyped, unused-ignore]
            import pyarrow.parquet  # type: ignore[import-not-found, import-untyped, unused-ignore]
        except ImportError:
            return
        columns = {name: [row.get(name) for row in rows] for name in (*names, *END)}
        pyarrow.parquet.write_table(pyarrow.table(columns), self.table.with_suffix(".parquet"))


def _cell(value: Any) -> Any:
    """A value in a table: text and numbers as they are, all else as JSON, as `sorb sweep` of the command has them."""
    plain_value = isinstance(value, (str, int, float)) and not isinstance(value, bool)
    return value if plain_value else json.dumps(value, separators=(",", ":"))


def _entry(line: str) -> dict[str, Any] | None:
    try:
        entry: dict[str, Any] = json.loads(line)
    except ValueError:
        return None
    return entry
