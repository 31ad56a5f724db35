"""A sweep on a local Ray cluster of two workers, one of which is killed: nothing lost, nothing twice, the same table.

Not part of pytest, because Ray is large: `pip install ray`, then `python python/tests/on_ray.py`. CI runs it where Ray can be installed.
"""

import os
import pathlib
import signal
import sys
import tempfile

# The cluster is on this machine, and tells nobody of it.
os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")

import ray  # noqa: E402

import sorb  # noqa: E402

GRID = {"bodies.ball.density": [2000, 3000, 4000, 5000], "resolution": [0.2, 0.3]}


def main() -> None:
    flag = pathlib.Path(tempfile.mkdtemp()) / "killed"

    def absorbed(world: sorb.World) -> float:
        """The first worker that comes here is killed."""
        try:
            flag.touch(exist_ok=False)
        except FileExistsError:
            return world.measures()["absorbed_mass"]
        os.kill(os.getpid(), signal.SIGKILL)
        raise AssertionError("killed")

    ray.init(num_cpus=2, include_dashboard=False)
    found = sorb.sweep("ball_drop", GRID, absorbed, frames=2, on="ray")
    assert flag.exists(), "no worker was killed"
    pairs = [(row["run"], row["digest"], row["measure"], row["error"]) for row in found]
    for processes in (1, 2):
        expected = sorb.sweep("ball_drop", GRID, "absorbed_mass", frames=2, processes=processes)
        assert pairs == [(row["run"], row["digest"], row["absorbed_mass"], "") for row in expected], pairs
    print(f"{len(found)} runs on Ray as in one and two processes, though a worker was killed")


if __name__ == "__main__":
    sys.exit(main())
