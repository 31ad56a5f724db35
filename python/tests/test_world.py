"""Scenes, steps, commands, questions, states."""

import copy
import json
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest

import sorb


def test_a_scene_is_a_name_a_file_or_a_dictionary(world, tmp_path):
    scene = sorb.scene("ball_drop", resolution=0.3)
    path = tmp_path / "own.json"
    path.write_text(json.dumps(scene))
    for source in (scene, path, str(path)):
        assert sorb.World(source).digest == world.digest
    assert scene == world.scene
    assert "ball_drop" in sorb.presets()
    with pytest.raises(TypeError, match="not int"):
        sorb.World(1)


def test_overrides_are_texts_numbers_and_arrays():
    values = {"bodies.ball.position": np.array([0.0, 0.2, 0.0]), "gravity": (0, -1.5, 0)}
    world = sorb.World("ball_drop", values, resolution=0.3, fluid__viscosity=0.002, domain={"kind": "open"})
    scene = world.scene
    assert scene["gravity"] == [0.0, -1.5, 0.0]
    assert scene["domain"] == {"kind": "open"}
    assert scene["fluid"]["viscosity"] == pytest.approx(0.002)
    assert world.bodies["ball"].position == pytest.approx((0.0, 0.2, 0.0))
    assert sorb.World("ball_drop", quality="fast", resolution=0.3).scene != sorb.scene("ball_drop", resolution=0.3)


@pytest.mark.parametrize(
    ("arguments", "keys", "text"),
    [
        ({"scene": "bal_drop"}, (), "did you mean `ball_drop`"),
        ({"scene": "no.toml"}, (), "cannot read"),
        ({"scene": "dry", "sponges__sponge__edge": -1}, ("sponges[0].edge",), "out of range"),
        ({"scene": "dry", "gravity": float("nan")}, ("gravity",), "not a finite number"),
        ({"scene": "dry", "overrides": {"sponges.spong.edge": 1}}, (), "did you mean `sponge`"),
        ({"scene": {"version": 1, "fluids": {}}}, ("fluids",), "did you mean `fluid`"),
        ({"scene": {"version": 1, "fluid": {"spacing": [1, float("inf")]}}}, ("fluid.spacing[1]",), "inf"),
        ({"scene": "dry", "quality": "best"}, ("quality",), "quality"),
        ({"scene": "dry", "simd": "mmx"}, ("simd",), "mmx"),
        ({"scene": "dry", "backend": "cloud"}, ("backend",), "cloud"),
        ({"scene": "dry", "threads": 5000}, (), "5000"),
        ({"scene": "dry", "resolution": 100}, (), "resolution"),
        ({"scene": "dry", "overrides": {"title": object}}, ("title",), "type"),
    ],
)
def test_wrong_scenes_are_exceptions_that_name_the_key(arguments, keys, text):
    with pytest.raises(sorb.SceneError, match=text) as caught:
        sorb.World(**arguments)
    assert caught.value.keys == keys
    assert isinstance(caught.value, ValueError)


def test_exceptions_can_be_pickled():
    with pytest.raises(sorb.SceneError) as caught:
        sorb.World("dry", sponges__sponge__edge=-1)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (str(again), again.keys) == (str(caught.value), caught.value.keys)


def test_frames_and_steps(world):
    report = world.advance_frame()
    assert report.time == pytest.approx(1 / 60) and report.steps > 0
    assert world.step().step > 0
    seen = []
    world.run(frames=3, each=lambda own, report: seen.append(report.time))
    assert len(seen) == 3 and world.clock.frames == 4
    world.run(seconds=0.05, each=lambda own, report: False)
    assert world.clock.frames == 5
    assert world.run(seconds=0.0499).clock.frames == 8
    with pytest.raises(ValueError, match="not both"):
        world.run(frames=1, seconds=1)


def test_threads_and_simd_have_no_effect(world):
    other = sorb.World("ball_drop", resolution=0.3, threads=1, simd="fallback")
    assert world.run(frames=2).digest == other.run(frames=2).digest


def test_commands_move_what_they_say(world):
    world.push("gravity", gravity=[0, 0, 0])
    world.push("velocity", body="ball", linear_velocity=np.array([0.0, 1.0, 0.0]), angular_velocity=(0, 0, 0))
    before = world.bodies["ball"].position[1]
    world.advance_frame()
    assert world.bodies["ball"].position[1] - before == pytest.approx(1 / 60, abs=1e-4)
    world.pour([-0.08, 0.1, -0.08], [-0.06, 0.12, -0.06])
    world.advance_frame()
    assert world.ledger()["poured"] > 0 and world.ledger()["lost"] == 0
    number = world.drain({"minimum": [-0.085, 0, -0.085], "maximum": [0.085, 0.25, 0.085], "rate": 10})
    world.advance_frame()
    world.push("end_flow", number=number)
    assert world.ledger()["drained"] > 0


def test_bodies_and_sponges_come_and_go(world):
    nodes = len(world.node_positions)
    ball = {"name": "other", "shape": {"kind": "sphere", "radius": 0.01}, "position": [0.06, 0.2, 0.06]}
    assert world.add_body(ball) == 1
    world.advance_frame()
    assert list(world.bodies) == list(world.body_loads()) == ["ball", "other"]
    world.push("remove_body", body="other")
    world.advance_frame()
    assert list(world.bodies) == list(world.body_loads()) == ["ball"]
    # The number is taken again, by another body: the first handle is stale.
    second = world.add_body(ball)
    assert second == {"index": 1, "generation": 1}
    world.advance_frame()
    with pytest.raises(sorb.CommandError, match="remove_body.body"):
        world.push("remove_body", body=1)
    world.push("body_kind", body="other", kind="kinematic")
    world.move(second, [0.06, 0.15, 0.06])
    world.advance_frame()
    assert world.bodies["other"].position == pytest.approx((0.06, 0.15, 0.06), abs=1e-5)
    sponge = world.add_sponge({"name": "cube", "edge": 0.015, "cells": [2, 2, 2], "position": [-0.08, 0.1, -0.08]})
    world.advance_frame()
    assert sponge == 1 and len(world.node_positions) == nodes + 27
    world.push("remove_sponge", sponge=sponge)
    world.advance_frame()
    assert len(world.node_positions) == nodes
    with pytest.raises(sorb.CommandError, match="edge"):
        world.add_sponge({"edge": -1})


@pytest.mark.parametrize(
    ("command", "keys", "text"),
    [
        ({"impulse": {"body": 0, "impulse": [0, float("nan"), 0], "angular_impulse": [0, 0, 0]}}, ("impulse.impulse[1]",), "nan"),
        ({"gravity": {"gravity": [0, 200, 0]}}, ("gravity.gravity",), "out of range -100 to 100"),
        ({"force": {"body": "bal", "force": [0, 0, 0], "torque": [0, 0, 0]}}, ("force.body",), "bodies: ball"),
        ({"pose": {"body": "ball", "position": [0, 0, 0], "rotation": [0, 0, 0, 1], "duration": 1}}, ("pose.body",), "kinematic"),
        ({"jump": {}}, (), "unknown variant `jump`"),
        ({"gravity": {}}, (), "missing field `gravity`"),
    ],
)
def test_wrong_commands_change_nothing(world, command, keys, text):
    before = world.digest
    with pytest.raises(sorb.CommandError, match=text) as caught:
        world.push(command)
    assert caught.value.keys == keys
    assert world.digest == before


def test_questions(world):
    hit = world.cast_rays([[0, 0.24, 0], [0.08, 0.24, 0.08]], [0, -1, 0], targets=["bodies"])
    assert hit.surface.tolist() == [1, 0] and np.isnan(hit.distance[1])
    assert hit.normal[0] == pytest.approx([0, 1, 0], abs=1e-3)
    probe = world.probe([[0, 0.02, 0], [0, 0.2, 0]])
    assert probe.sponge.tolist() == [0, -1] and probe.saturation[0] > 0.5 and probe.filled[1] == 0
    levels = world.water_levels([[0, 0], [0.08, 0.08]])
    assert levels[0] > 0.02 and np.isnan(levels[1])
    assert len(world.water_levels([])) == 0
    for ask in (
        lambda: world.probe([0, float("nan"), 0]),
        lambda: world.probe([0, 0]),
        lambda: world.cast_rays([0, 0, 0], [0, 0, 0]),
        lambda: world.cast_rays([0, 0, 0], [0, 1, 0], targets=["air"]),
    ):
        with pytest.raises(sorb.QueryError):
            ask()
    assert world.body_loads() == {}
    world.advance_frame()
    assert set(world.body_loads()) == {"ball"}
    assert world.measures()["absorbed_mass"] > 0 and len(world.measures()["linear_momentum"]) == 3


def test_states_come_back(world):
    world.advance_frame()
    digest, save, snapshot = world.digest, world.save(), world.snapshot()
    compressed = world.save(compressed=True)
    assert len(compressed) < len(save)
    copies = [world.copy(), copy.deepcopy(world), pickle.loads(pickle.dumps(world))]
    copies += [sorb.World.restore(save), sorb.World.restore(compressed, threads=1)]
    assert {own.digest for own in copies} == {digest}
    later = {own.run(frames=2).digest for own in [world, *copies]}
    assert len(later) == 1 and later != {digest}
    world.rollback(snapshot)
    assert world.digest == digest and snapshot.time() == pytest.approx(1 / 60)
    world.advance_frame()
    world.resume(save)
    assert world.digest == digest
    for damaged in (b"", save[:-1], save[:100] + b"x" + save[101:]):
        with pytest.raises(sorb.StateError):
            world.resume(damaged)
    with pytest.raises(sorb.StateError):
        world.rollback(sorb.Snapshot())
    with pytest.raises(sorb.StateError):
        sorb.World("dry", resolution=0.3).resume(save)
    assert world.digest == digest


def test_recordings_are_played(world):
    with pytest.raises(sorb.StateError, match="not being recorded"):
        world.end_recording()
    world.record(every=2)
    with pytest.raises(sorb.StateError, match="already"):
        world.record()
    world.push("impulse", body="ball", impulse=[0, 0.5, 0], angular_impulse=[0, 0, 0])
    world.run(frames=2)
    world.step()
    with pytest.raises(sorb.StateError, match="end the recording"):
        world.rollback(sorb.Snapshot())
    recording = world.end_recording()
    assert sorb.verify(recording, threads=1) == 3
    with pytest.raises((sorb.StateError, sorb.ReplayError)):
        sorb.verify(recording[:-8])


def test_pictures_are_arrays(world, tmp_path):
    picture = world.picture(64, 48, view="fast")
    assert picture.shape == (48, 64, 3) and picture.dtype == np.uint8 and picture.std() > 1
    other = world.picture(64, 48, view="fast", eye=[0.0, 0.5, 0.01], target=[0.0, 0.0, 0.0])
    assert (picture != other).any()
    path = tmp_path / "picture.png"
    sorb.write_png(path, picture)
    assert path.read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(sorb.QueryError, match="width = 0"):
        world.picture(0, 48)
    with pytest.raises(sorb.QueryError, match="view"):
        world.picture(64, 48, view="pretty")
    with pytest.raises(sorb.SceneError, match="camera"):
        world.picture(64, 48, field_of_view_degrees=500)
    with pytest.raises(sorb.Error, match="shape"):
        sorb.write_png(path, picture[:, :, 0])


def test_other_threads_run_while_a_world_steps():
    world = sorb.World("ball_drop", resolution=0.7, threads=1)
    counted, is_over = [0], threading.Event()

    def count():
        while not is_over.is_set():
            counted[0] += 1
            time.sleep(0.0005)

    thread = threading.Thread(target=count)
    thread.start()
    seen = []
    for _ in range(3):
        before = counted[0]
        world.advance_frame()
        seen.append(counted[0] - before)
    is_over.set()
    thread.join()
    # With the lock held, no other thread would come in before the end of a frame.
    assert max(seen) >= 3, seen


def test_a_run_can_be_interrupted(world):
    # A shell that starts the tests in the background has this signal ignored.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        world.run(frames=1_000_000)
    assert world.clock.frames > 0
    world.advance_frame()
