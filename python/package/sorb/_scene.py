"""Scenes out of names, files and dictionaries; values as texts that the library reads."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Mapping
from typing import Any, Union

from . import _sorb
from ._errors import Error, SceneError

Scene = Union[str, "os.PathLike[str]", Mapping[str, Any]]


def presets() -> dict[str, str]:
    """The scenes that come with the library: names and titles."""
    return dict(_sorb.presets())


def scene(
    source: Scene,
    overrides: Mapping[str, Any] | None = None,
    *,
    quality: str | None = None,
    resolution: float = 1.0,
    **keys: Any,
) -> dict[str, Any]:
    """Reads a scene and changes it, as `World` does; the whole scene as a dictionary, which `World` takes.

    Raises:
        SceneError: the scene, a key or a value is wrong.
    """
    kind, text = source_of(source)
    changes = texts_of(overrides, keys)
    own: dict[str, Any] = json.loads(_sorb.read_scene(kind, text, quality, changes, resolution))
    return own


def source_of(source: Scene) -> tuple[str, str]:
    """What `_sorb` reads: a kind and a text."""
    if isinstance(source, Mapping):
        return "json", json.dumps(plain(source, "", SceneError))
    if isinstance(source, (str, os.PathLike)):
        return "name", os.fspath(source)
    raise TypeError(f"a scene is a name, a path or a dictionary, not {type(source).__name__}")


def texts_of(overrides: Mapping[str, Any] | None, keys: Mapping[str, Any]) -> list[str]:
    """Overrides as `key=value` texts; `__` in the name of an argument stands for a dot."""
    changes = dict(overrides or {})
    changes.update({name.replace("__", "."): value for name, value in keys.items()})
    return [f"{key}={toml_of(plain(value, key, SceneError))}" for key, value in changes.items()]


def plain(value: Any, key: str, error: type[Error]) -> Any:
    """A value of dictionaries, lists, texts and finite numbers; arrays and numbers of NumPy become such."""
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, float):
        if not math.isfinite(value):
            raise error(f"`{key}` = {value} is not a finite number", [key])
        return value
    if isinstance(value, Mapping):
        join = f"{key}." if key else ""
        return {str(name): plain(own, f"{join}{name}", error) for name, own in value.items()}
    if hasattr(value, "tolist"):
        return plain(value.tolist(), key, error)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Iterable):
        return [plain(own, f"{key}[{index}]", error) for index, own in enumerate(value)]
    raise error(f"`{key}` is a {type(value).__name__}; expected a number, a text, a list or a dictionary", [key])


def toml_of(value: Any) -> str:
    """A value as TOML, which has no null: that is refused by its reader."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(name)} = {toml_of(own)}" for name, own in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_of, value)) + "]"
    return json.dumps(value, ensure_ascii=False)
