"""Views without a copy, which refuse to outlive a step."""

import gc

import numpy as np
import pytest

import sorb

VECTORS = ["particle_positions", "particle_velocities", "node_positions", "node_velocities"]
NUMBERS = ["particle_ids", "node_saturations", "node_sponges"]


@pytest.mark.parametrize("name", [*VECTORS, *NUMBERS, "triangles"])
def test_every_column(world, name):
    view = getattr(world, name)
    assert view.shape[1:] == (() if name in NUMBERS else (3,))
    assert len(view) == view.shape[0] > 0
    assert view.dtype == (np.uint32 if name in ("particle_ids", "node_sponges", "triangles") else np.float32)
    assert np.array_equal(view.copy(), np.asarray(view)) and np.isfinite(view).all()
    assert name in repr(view)


def test_computed_columns(world):
    world.advance_frame()
    count = len(world.particle_ids)
    assert world.particle_pressures().shape == world.particle_densities().shape == (count,)
    assert (world.node_masses() > 0).all()


def test_an_array_has_the_memory_of_the_world_and_cannot_be_written(world):
    first, second = world.particle_positions.numpy(), np.asarray(world.particle_positions)
    assert np.shares_memory(first, second)
    assert not np.shares_memory(first, world.particle_positions.copy())
    assert first.strides == (16, 4)
    with pytest.raises(ValueError, match="read-only"):
        first[0, 0] = 1.0
    with pytest.raises(ValueError, match="WRITEABLE"):
        first.flags.writeable = True
    world.particle_positions.copy()[0, 0] = 1.0


def test_a_view_refuses_to_outlive_a_step(world):
    view = world.particle_positions
    snapshot = world.snapshot()
    kept = view.copy()
    world.step()
    assert not view.is_valid and "earlier state" in repr(view)
    for use in (view.numpy, view.copy, lambda: view[0], lambda: np.asarray(view), lambda: len(view), lambda: view.shape):
        with pytest.raises(sorb.StateError, match="earlier state"):
            use()
    # A roll back is a change as well.
    view = world.particle_positions
    world.rollback(snapshot)
    with pytest.raises(sorb.StateError):
        view.copy()
    assert np.array_equal(kept, world.particle_positions)


def test_a_world_does_not_change_below_an_array(world):
    snapshot, save = world.snapshot(), world.save()
    array = world.particle_positions.numpy()
    part = array[3:, 1]
    before, digest = array.copy(), world.digest
    for change in (world.step, world.advance_frame, lambda: world.rollback(snapshot), lambda: world.resume(save)):
        with pytest.raises(BufferError, match="still in use"):
            change()
    assert world.digest == digest and np.array_equal(array, before)
    # A slice keeps the memory as well.
    del array
    with pytest.raises(BufferError):
        world.step()
    # A command waits for the next step, and changes nothing before it.
    world.push("gravity", gravity=[0, 0, 0])
    del part
    world.step()


def test_an_array_keeps_its_world():
    array = sorb.World("ball_drop", resolution=0.3).particle_positions.numpy()
    gc.collect()
    assert array.shape[1] == 3 and np.isfinite(array).all() and array[:, 1].max() > 0.01


def test_functions_of_numpy_take_a_view(world):
    view = world.particle_positions
    assert np.mean(view, axis=0) == pytest.approx(view.copy().mean(axis=0), abs=1e-6)
    assert view[0, 1] == view.copy()[0, 1]
    assert view[:2].flags.owndata
    assert np.asarray(view, dtype=np.float64).dtype == np.float64
    world.step()
