"""Exceptions. Their texts name the key, the value and the range."""

from __future__ import annotations

from collections.abc import Iterable


class Error(Exception):
    """Anything that sorb refuses. `keys` has the keys that are wrong, such as `fluid.spacing`; empty where there are none."""

    keys: tuple[str, ...]

    def __init__(self, message: str, keys: Iterable[str] = ()) -> None:
        super().__init__(message)
        self.keys = tuple(keys)


class SceneError(Error, ValueError):
    """A scene cannot be read or used, or the machine lacks what was asked for."""


class CommandError(Error, ValueError):
    """A command is out of range, or of something that does not exist. Nothing has changed."""


class QueryError(Error, ValueError):
    """A question is out of range."""


class StepError(Error, ArithmeticError):
    """A step failed. The world takes no further ones; `rollback` and `resume` lead back."""


class StateError(Error, ValueError):
    """A save is not usable, or cannot be made."""


class ReplayError(Error):
    """A recording was not played to the same digests. The text names the frame, and the first column, row and both values."""
