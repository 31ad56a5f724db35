"""Sweeps: the same table on any number of processes, continued where they ended."""

import csv
import json
import os
import subprocess

import pytest

import sorb

GRID = {"sponges.sponge.permeability": [1e-10, 5e-9], "bodies.ball.density": [2000, 5000], "resolution": [0.2, 0.3]}
SMALL = {"frames": 2}


def without_times(rows):
    return [{name: value for name, value in row.items() if name != "wall_seconds"} for row in rows]


def highest(world):
    """Of a module, so that processes find it."""
    return {"highest": float(world.node_positions[:, 1].max())}


def failing(world):
    raise RuntimeError("planted")


def test_a_table_is_the_same_on_one_and_two_processes(tmp_path):
    one = sorb.sweep("ball_drop", GRID, ["absorbed_mass", "kinetic_energy"], out=tmp_path / "one.csv", **SMALL)
    two = sorb.sweep(
        "ball_drop", GRID, ["absorbed_mass", "kinetic_energy"], processes=2, out=tmp_path / "two.csv", **SMALL
    )
    assert len(one) == 8 and without_times(one) == without_times(two)
    assert [row["run"] for row in one] == list(range(8))
    assert len({row["digest"] for row in one}) == 8 and not any(row["error"] for row in one)
    world = sorb.World("ball_drop", {"sponges.sponge.permeability": 1e-10, "bodies.ball.density": 2000}, resolution=0.2)
    assert f"{world.run(frames=2).digest:016x}" == one[0]["digest"]
    assert world.measures()["absorbed_mass"] == one[0]["absorbed_mass"]
    with (tmp_path / "one.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    assert [float(row["absorbed_mass"]) for row in table] == [row["absorbed_mass"] for row in one]
    assert list(table[0])[:4] == ["run", "sponges.sponge.permeability", "bodies.ball.density", "resolution"]


def test_a_sweep_continues_where_it_ended(tmp_path):
    out = tmp_path / "table.csv"
    grid = {"bodies.ball.density": [2000, 3000, 4000]}
    whole = sorb.sweep("ball_drop", grid, resolution=0.2, out=out, **SMALL)
    journal = out.with_name("table.csv.jsonl")
    lines = journal.read_text().splitlines()
    # An end by force within the second run.
    marked = json.loads(lines[1])
    marked["absorbed_mass"] = -1.0
    journal.write_text("\n".join([lines[0], json.dumps(marked), lines[2][:40]]))
    again = sorb.sweep("ball_drop", grid, resolution=0.2, out=out, **SMALL)
    # The first run was not run again, the others were.
    assert again[0]["absorbed_mass"] == -1.0
    assert without_times(again[1:]) == without_times(whole[1:])
    with pytest.raises(sorb.Error, match="of another sweep"):
        sorb.sweep("ball_drop", grid, resolution=0.2, out=out, frames=3)


def test_shards_are_parts_of_the_table():
    grid = [{"bodies.ball.density": density} for density in (2000, 3000, 4000)]
    whole = sorb.sweep("ball_drop", grid, resolution=0.2, **SMALL)
    parts = [sorb.sweep("ball_drop", grid, resolution=0.2, shard=(part, 2), **SMALL) for part in range(2)]
    assert without_times(parts[0]) == without_times(whole[::2])
    assert without_times(parts[1]) == without_times(whole[1::2])


def test_measures_are_names_or_a_function():
    grid = {"bodies.ball.density": [2000]}
    assert sorb.sweep("ball_drop", grid, highest, resolution=0.2, **SMALL)[0]["highest"] > 0.01
    assert "elastic_energy" in sorb.sweep("ball_drop", grid, resolution=0.2, **SMALL)[0]
    assert "planted" in sorb.sweep("ball_drop", grid, failing, resolution=0.2, **SMALL)[0]["error"]
    assert "no measure" in sorb.sweep("ball_drop", grid, "mass", resolution=0.2, **SMALL)[0]["error"]


def test_wrong_settings_are_found_before_anything_runs(tmp_path):
    out = tmp_path / "table.csv"
    with pytest.raises(sorb.SceneError, match="density"):
        sorb.sweep("ball_drop", {"bodies.ball.density": [2000, -1]}, out=out, **SMALL)
    assert not out.exists()
    with pytest.raises(sorb.Error, match="shard"):
        sorb.sweep("ball_drop", {}, shard=(2, 2), **SMALL)


@pytest.mark.skipif("SORB" not in os.environ, reason="SORB is not the path of the command sorb")
def test_the_command_has_the_same_table(tmp_path):
    names = ["absorbed_mass", "sponge_centre"]
    sorb.sweep("ball_drop", GRID, names, out=tmp_path / "python.csv", frames=2)
    keys = "".join(f"{key} = {json.dumps(values)}\n" for key, values in GRID.items())
    plan = tmp_path / "plan.toml"
    plan.write_text(f'scene = "ball_drop"\nframes = 2\nmeasures = {json.dumps(names)}\n[grid]\n{keys}')
    command = [os.environ["SORB"], "sweep", plan, "--out", tmp_path / "parts"]
    for shard in ("1/2", "0/2"):
        subprocess.run([*command, "--shard", shard], check=True)
    tables = []
    for path in (tmp_path / "python.csv", tmp_path / "parts" / "table.csv"):
        with path.open(newline="") as file:
            tables.append(list(csv.DictReader(file)))
    assert len(tables[0]) == 8 and list(tables[0][0]) == list(tables[1][0])
    for row, other in zip(*tables):
        assert (row.pop("digest"), row.pop("error")) == (other.pop("digest"), other.pop("error"))
        for own in (row, other):
            own.pop("wall_seconds")
        assert {name: float(value) for name, value in row.items()} == {name: float(value) for name, value in other.items()}


def test_vectors_are_three_columns_and_lists_are_json(tmp_path):
    out = tmp_path / "table.csv"
    grid = {"gravity": [[0, -9.81, 0], [0, 0, 0]]}
    rows = sorb.sweep("ball_drop", grid, ["sponge_centre", "saturation"], resolution=0.2, out=out, **SMALL)
    assert list(rows[0])[2:6] == ["sponge_centre_x", "sponge_centre_y", "sponge_centre_z", "saturation"]
    with out.open(newline="") as file:
        assert [row["gravity"] for row in csv.DictReader(file)] == ["[0,-9.81,0]", "[0,0,0]"]


def test_the_table_is_there_as_parquet_too(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")
    out = tmp_path / "table.csv"
    grid = {"bodies.ball.density": [2000, 5000], "gravity": [[0, -9.81, 0]]}
    rows = sorb.sweep("ball_drop", grid, ["absorbed_mass", "sponge_centre"], resolution=0.2, out=out, **SMALL)
    read = parquet.read_table(tmp_path / "table.parquet").to_pylist()
    assert read == rows and list(read[0]) == list(rows[0])
