"""The dam break of `dam_16.toml` and `dam_37.toml` with pySPlisHSPlasH (DFSPH), as JSON: `splishsplash.py N STEP TOLERANCE`.

N particles across the base, steps of at most STEP seconds, a mean density error of TOLERANCE. `pip install pysplishsplash`; where its own
libGLdispatch does not suit that of the system, set LD_PRELOAD to the latter.
"""

import json
import os
import sys
import tempfile
import time

import pysplishsplash as splash
from pysplishsplash import Exec

BASE = 0.5
TANK = (1.5, 1.2, 0.5)
END = 0.5


def cube(path):
    """A unit cube around the origin."""
    corners = [(x - 0.5, y - 0.5, z - 0.5) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    with open(path, "w") as file:
        for corner in corners:
            file.write("v {} {} {}\n".format(*corner))
        for a, b, c, d in faces:
            file.write(f"f {a + 1} {b + 1} {c + 1}\nf {a + 1} {c + 1} {d + 1}\n")


def scene(across, step, tolerance, mesh):
    spacing = BASE / across
    radius = 0.5 * spacing
    # The first particle of a block is a spacing from its start, the last a spacing from its end.
    end = [BASE + radius, 2 * BASE + radius, BASE + radius]
    return {
        "Configuration": {
            "particleRadius": radius,
            "simulationMethod": 4,
            "gravitation": [0, -9.81, 0],
            "timeStepSize": min(step, 0.001),
            "cflMethod": 1,
            "cflFactor": 1,
            "cflMaxTimeStepSize": step,
            "maxIterations": 100,
            "maxError": 100 * tolerance,
            "enableDivergenceSolver": True,
            "maxIterationsV": 100,
            "maxErrorV": 0.1,
            "boundaryHandlingMethod": 2,
            "enableZSort": True,
        },
        "Materials": [{"id": "Fluid", "density0": 1000}],
        "RigidBodies": [
            {
                "geometryFile": mesh,
                "translation": [0.5 * extent for extent in TANK],
                # With walls a spacing from the outer particles the column bursts: their volume maps add up to 60 % to the density.
                "scale": [extent + 4 * radius for extent in TANK],
                "isDynamic": False,
                "isWall": True,
                "mapInvert": True,
                "mapThickness": 0.0,
                "mapResolution": [30, 24, 10],
            }
        ],
        "FluidBlocks": [{"denseMode": 0, "start": [-radius] * 3, "end": end, "id": "Fluid"}],
    }


def main():
    across, step, tolerance = int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
    folder = tempfile.mkdtemp()
    mesh, path = os.path.join(folder, "cube.obj"), os.path.join(folder, "dam.json")
    cube(mesh)
    with open(path, "w") as file:
        json.dump(scene(across, step, tolerance, mesh), file)
    # What it prints would end up in the JSON.
    stdout = os.dup(1)
    os.dup2(2, 1)
    program = Exec.SimulatorBase()
    program.init(useGui=False, sceneFile=path, outputDir=folder, initialPause=False, stopAt=END)
    program.initSimulation()
    simulation = splash.Simulation.getCurrent()
    fluid = simulation.getFluidModel(0)
    clock = splash.TimeManager.getCurrent()
    particles = fluid.numActiveParticles()
    fronts, wall = [], 0.0
    start = time.perf_counter()

    def after_step():
        nonlocal start, wall
        wall += time.perf_counter() - start
        along = sorted(fluid.getPosition(index)[0] for index in range(particles))
        # The outermost row across the tank, so that single drops do not count.
        fronts.append([clock.getTime(), along[-across] + 0.5 * BASE / across])
        start = time.perf_counter()

    program.setTimeStepCB(after_step)
    program.setValueFloat(program.STOP_AT, END)
    program.runSimulation()
    result = {"particles": particles, "steps": len(fronts), "wall_s": wall, "fronts": fronts}
    os.write(stdout, (json.dumps(result) + "\n").encode())


main()
