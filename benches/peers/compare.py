"""The same dam break with sorb, salva and pySPlisHSPlasH, by turns: time of a step and error of the front.

    cargo build --release -p sorb-cli
    cargo build --release --manifest-path benches/peers/salva/Cargo.toml --target-dir target/salva
    pip install pysplishsplash
    python benches/peers/compare.py [--across 16] [--tolerance 5e-4] [--turns 3]

A program that cannot be started is left out, with its error. The front is compared with the film of Martin and Moyce (1952) until it is
at the end of the tank, with one fitted delay of the gate.
"""

import argparse
import csv
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PEERS = ROOT / "benches" / "peers"
BASE = 0.5
# Front (their Table 2): t sqrt(2 g / a), x / a.
FRONT = [
    (0.41, 1.11), (0.84, 1.22), (1.19, 1.44), (1.43, 1.67), (1.63, 1.89), (1.83, 2.11), (1.98, 2.33), (2.20, 2.56), (2.32, 2.78),
]
# Longest steps, with which all codes meet the tolerance.
STEPS = {16: 0.0025, 37: 0.001081}


def sorb(across, step, tolerance):
    """`sorb run`; the front comes from a second run that writes positions."""
    command = [ROOT / "target" / "release" / "sorb", "run", PEERS / f"dam_{across}.toml", "--quiet", "--set", "time.duration=0.5"]
    command += ["--set", f"fluid.density_tolerance={tolerance}"]
    with tempfile.TemporaryDirectory() as folder:
        out = ["--json", "--out", folder]
        result = json.loads(subprocess.run(command + out, check=True, capture_output=True, text=True).stdout)
        fast = ["--set", "time.frame_rate=200", "--export", "npy", "--out", folder]
        subprocess.run(command + fast, check=True, capture_output=True)
        fronts = list(sorb_fronts(pathlib.Path(folder), across))
    return {"particles": result["particles"], "steps": result["steps"], "wall_s": result["wall_s"], "fronts": fronts}


def sorb_fronts(folder, across):
    import numpy

    with open(folder / "measures.csv", encoding="utf-8") as file:
        times = {int(row["frame"]): float(row["time_s"]) for row in csv.DictReader(file)}
    for path in sorted((folder / "export").glob("particle_positions_*.npy")):
        frame = int("".join(letter for letter in path.stem if letter.isdigit()))
        along = numpy.sort(numpy.load(path)[:, 0])
        yield times[frame], float(along[-across]) + 0.5 * BASE / across


def program(command):
    def run(across, step, tolerance):
        words = [str(word) for word in [*command, across, step, tolerance]]
        return json.loads(subprocess.run(words, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout)

    return run


CODES = {
    "sorb": sorb,
    "salva": program([ROOT / "target" / "salva" / "release" / "salva-dam"]),
    "pySPlisHSPlasH": program([sys.executable, PEERS / "splishsplash.py"]),
}


def interpolated(fronts, time):
    for (t0, x0), (t1, x1) in zip(fronts, fronts[1:]):
        if t0 <= time <= t1:
            return x0 + (x1 - x0) * (time - t0) / (t1 - t0)
    return fronts[0][1] if time < fronts[0][0] else fronts[-1][1]


def front_error(fronts):
    """Root mean square over the times of the table, in lengths of the base, with the best delay of the gate up to 0.5."""
    scaled = [(time * math.sqrt(2 * 9.81 / BASE), front / BASE) for time, front in fronts]

    def error(delay):
        return math.sqrt(statistics.fmean((interpolated(scaled, time - delay) - front) ** 2 for time, front in FRONT))

    return min(error(0.01 * delay) for delay in range(51))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--across", type=int, default=16, choices=sorted(STEPS), help="particles across the base")
    parser.add_argument("--tolerance", type=float, default=5e-4, help="mean density error")
    parser.add_argument("--turns", type=int, default=3)
    options = parser.parse_args()
    results = {name: [] for name in CODES}
    for _ in range(options.turns):
        for name, run in list(CODES.items()):
            if results[name] is None:
                continue
            try:
                results[name].append(run(options.across, STEPS[options.across], options.tolerance))
            except (OSError, ValueError, ImportError, subprocess.CalledProcessError) as error:
                print(f"{name} is left out: {error}", file=sys.stderr)
                results[name] = None
    print(f"{os.cpu_count()} cores, {options.across} particles across, mean density error {options.tolerance:g}")
    print("| code | particles | steps | a step, ms | in all, s | front, RMS error over the base |")
    print("|---|---|---|---|---|---|")
    for name, runs in results.items():
        if not runs:
            continue
        wall = statistics.median(run["wall_s"] for run in runs)
        steps = runs[0]["steps"]
        error = front_error(runs[0]["fronts"])
        print(f"| {name} | {runs[0]['particles']} | {steps} | {1e3 * wall / steps:.2f} | {wall:.2f} | {error:.3f} |")


if __name__ == "__main__":
    main()
