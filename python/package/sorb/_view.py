"""Columns of a world without a copy, which refuse to outlive the state that they show."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import StateError

if TYPE_CHECKING:
    from . import _sorb


class View:
    """A column of a world in its present state.

    A view is valid until the world changes: after a step, `resume` or `rollback` every use of it raises `StateError`. It costs nothing to
    ask the world for a new one.

    `np.asarray(view)` and `view.numpy()` give a read-only array on the memory of the world itself. That memory moves when the world
    steps, so that the world refuses to (`BufferError`) while such an array, or a slice of one, is alive. `view.copy()` and `view[..]` give
    arrays of your own, which live as long as you like. Functions of NumPy take a view as it is: `np.mean(view, axis=0)`.
    """

    __slots__ = ("_generation", "_name", "_world")

    def __init__(self, world: _sorb.World, name: str) -> None:
        self._world = world
        self._name = name
        self._generation = world.generation

    def numpy(self) -> npt.NDArray[Any]:
        """A read-only array without a copy. While it is alive the world takes no steps.

        Raises:
            StateError: the world has changed since this view was asked for.
        """
        if not self.is_valid:
            raise StateError(f"this view of {self._name} is of an earlier state: ask the world for a new one", [self._name])
        return np.asarray(self._world.lend(self._name))

    def copy(self) -> npt.NDArray[Any]:
        """An array of your own."""
        return np.array(self.numpy(), order="C")

    @property
    def is_valid(self) -> bool:
        """Whether the world is still in the state that this view shows."""
        return self._generation == self._world.generation

    @property
    def shape(self) -> tuple[int, ...]:
        """Rows, and elements of a row if these are vectors."""
        return self.numpy().shape

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of the elements."""
        return self.numpy().dtype

    def __array__(self, dtype: npt.DTypeLike | None = None, copy: bool | None = None) -> npt.NDArray[Any]:
        array = self.numpy()
        if dtype is not None and array.dtype != np.dtype(dtype):
            if copy is False:
                raise ValueError(f"{self._name} as {np.dtype(dtype)} needs a copy")
            return array.astype(dtype)
        return self.copy() if copy else array

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, index: Any) -> Any:
        part = self.numpy()[index]
        return part.copy() if isinstance(part, np.ndarray) else part

    def __repr__(self) -> str:
        if not self.is_valid:
            return f"<view of {self._name}, of an earlier state>"
        return f"<view of {self._name}, {self.dtype}, shape {self.shape}>"
