# SPDX-License-Identifier: MIT
"""Arrays and tables as the compiled module takes them: columns by name, no mask dropped in silence."""
import operator

import numpy as np

COMMANDS = ("u1", "u2", "u3", "u4")  #: names of the last columns of a flight


def is_frame(given):
    """True for a DataFrame, of pandas or polars."""
    return hasattr(given, "columns") and hasattr(given, "shape")


def unmasked(what, given):
    """The same numbers as a plain array. Raises ValueError where a mask hides some."""
    if isinstance(given, np.ma.MaskedArray):
        hidden = int(np.ma.count_masked(given))
        if hidden:
            raise ValueError(f"{what}: expected numbers without a mask, found {hidden} masked; leave their rows out, or "
                             "fill them with .filled(value)")
        return given.data
    try:
        return np.asarray(given)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{what}: expected an array of numbers, found {error}") from None


def by_name(what, given, names):
    """The columns `names` of a DataFrame, a structured array or a dict of arrays, as an array of rows x names; None for
    what has no names. Other columns are left out; a pandas column with missing values is refused."""
    fields = getattr(getattr(given, "dtype", None), "names", None)
    if fields is None and not is_frame(given) and not isinstance(given, dict):
        return None
    known = list(given) if isinstance(given, dict) else list(fields or given.columns)
    lacking = [name for name in names if name not in known]
    if lacking:
        raise ValueError(f"{what}: expected a column {lacking[0]!r}, found {', '.join(map(str, known))}"[:300])
    columns = []
    for name in names:
        column = unmasked(f"{what}, column {name!r}", given[name])
        if column.ndim > 1:
            raise ValueError(f"{what}: expected one column {name!r}, found several")
        try:
            columns.append(np.asarray(column, float))
        except (TypeError, ValueError):
            raise ValueError(f"{what}, column {name!r}: expected numbers, found {column.dtype}") from None
    return np.stack(columns, axis=-1)


def plain(what, given, names=()):
    """A C-contiguous array of float32 or float64: by name where there are names, else by place."""
    named = by_name(what, given, names) if names else None
    array = unmasked(what, given) if named is None else named
    if array.dtype.kind not in "fiu" or array.dtype.itemsize > 8:
        raise TypeError(f"{what}: expected numbers (float32, float64 or integers), found {array.dtype}")
    return np.ascontiguousarray(array, np.float32 if array.dtype == np.float32 else np.float64).reshape(array.shape)


def commands_like(given, commands):
    """Commands as a DataFrame of the kind, and with the index, of `given`; else as they are."""
    if not is_frame(given):
        return commands
    named = dict(zip(COMMANDS, np.asarray(commands).T))
    return type(given)(named, index=given.index) if hasattr(given, "index") else type(given)(named)


def whole(what, value):
    """An int. Raises TypeError for anything else, 100.0 too."""
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{what}: expected a whole number, found {value!r}") from None
