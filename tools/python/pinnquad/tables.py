# SPDX-License-Identifier: MIT
"""Flights of arrays and data frames: what a notebook holds, imported as `pinnquad import` does a table (docs/import.md)."""
import json
import os
import tempfile
from pathlib import Path

import numpy as np

from ._core import Dataset, Error, Flight
from .arrays import by_name, is_frame

_FRAMES = {"world": ("ned", "enu"), "body": ("frd", "flu")}
_ORDERS = ("px4", "betaflight", "crazyflie")


def _chosen(what, value, choices):
    if value not in choices:
        raise ValueError(f"{what}: expected {' or '.join(map(repr, choices))}, found {value!r}")
    return value


def _numbers(name, values, width, rows=None):
    """An array of rows x width doubles, or of rows where the width is 1."""
    if isinstance(values, np.ma.MaskedArray):
        values = values.astype(float).filled(np.nan)
    array = np.asarray(values)
    if array.dtype.kind not in "fiub":
        raise ValueError(f"{name}: expected numbers, found {array.dtype}" +
                         (" (seconds are (t - t[0]) / numpy.timedelta64(1, 's'))" if array.dtype.kind in "mM" else ""))
    shape = f"an array of {'N' if rows is None else rows}" + (f" x {width}" if width > 1 else "") + " numbers"
    if array.ndim != (2 if width > 1 else 1) or (width > 1 and array.shape[1] != width) or (
            rows is not None and len(array) != rows):
        raise ValueError(f"{name}: expected {shape}, found shape {array.shape}")
    return array.astype(float).reshape(len(array), -1)


def _quoted(text):
    """Text in quotation marks, as TOML has it."""
    return json.dumps(str(text), ensure_ascii=False)


def _imported(columns, mapping, name, **settings):
    """The columns as a table, imported; messages name the table, not its file."""
    if Path(name).name != name:
        raise ValueError(f"name: expected a file's name without folders, found {name!r}")
    with tempfile.TemporaryDirectory() as folder:
        table, text = Path(folder, f"{name}.csv"), Path(folder, "mapping.toml")
        quoted = ['"' + key.replace('"', '""') + '"' for key in columns]
        cells = [map(repr, values.tolist()) if values.dtype.kind == "f" else ('"' + str(cell).replace('"', '""') + '"'
                                                                              for cell in values)
                 for values in columns.values()]
        with open(table, "w", encoding="utf-8") as file:
            file.write(",".join(quoted) + "\n")
            file.writelines(",".join(row) + "\n" for row in zip(*cells))
        if "\n" in mapping:
            text.write_text(mapping, encoding="utf-8")
            mapping = str(text)
        try:
            return Dataset.read([table], mapping=mapping, **settings)
        except (Error, ValueError) as error:
            told = str(error).replace(str(table), "the table").replace(str(text), "the mapping")
            raise type(error)(told) from None


def from_dataframe(frame, mapping=None, *, name="table", airframe=None, lag_s=None, keep_saturated=False):
    """The Dataset of a table in memory: a pandas or polars DataFrame, or a dict of arrays, by column name.

    mapping: what the columns mean, as of `pinnquad import`: a ready one's name, a TOML file, or the TOML text itself;
    None: the columns are Flight.column_names (and others, which are kept where they hold numbers), as of Flight.to_frame().
    Missing cells are NaN, None or masked, and refused where mapping is None. A frame that is a join of several (a row a message) is resampled column by
    column. The index is no column: reset_index() makes it one. Raises ValueError or pinnquad.Error, one line.
    """
    if mapping is None:
        return _own_columns(frame, name)
    names = list(frame.keys() if isinstance(frame, dict) else getattr(frame, "columns", ()))
    if not names:
        raise ValueError("expected a DataFrame or a dict of arrays with columns, found none")
    columns = {}
    for key in names:
        values = frame[key]
        values = values.astype(float).filled(np.nan) if isinstance(values, np.ma.MaskedArray) else np.asarray(values)
        if str(key) in columns or values.ndim != 1:
            raise ValueError(f"column {key!r}: expected one column of that name, found several")
        if values.dtype.kind in "mM":
            raise ValueError(f"column {key!r}: expected numbers, found {values.dtype} (seconds are "
                             "(t - t[0]) / numpy.timedelta64(1, 's'))")
        if values.dtype.kind in "iub":
            values = values.astype(float)
        elif values.dtype.kind == "O":  # None, or pandas' own missing value, among numbers
            try:
                values = np.array([np.nan if cell is None or cell != cell else float(cell) for cell in values])
            except (TypeError, ValueError):
                values = values.astype(str)
        columns[str(key)] = values
    lengths = {key: len(values) for key, values in columns.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"expected columns of one length, found {lengths}")
    return _imported(columns, os.fspath(mapping), name, airframe=airframe, lag_s=lag_s, keep_saturated=keep_saturated)


def _own_columns(frame, name):
    """The flight whose columns have the names of Flight.column_names."""
    rows = by_name("the table", frame, Flight.column_names)
    if rows is None:
        raise ValueError("expected a DataFrame or a dict of arrays with columns, found none")
    extra = []
    for key in (frame.columns if is_frame(frame) else frame):
        values = frame[key]
        if str(key) not in Flight.column_names and np.asarray(values).dtype.kind in "fiu":
            extra.append((str(key), "", np.ma.filled(np.ma.asarray(values, float), np.nan).tolist()))
    return Dataset(Flight(rows, name, columns=extra))


def from_arrays(time_s, *, world, body, body_rates_rad_s, commands, motor_order, euler_rad=None, quaternion=None,
                quaternion_order=None, specific_force_m_s2=None, velocity_m_s=None, velocity_axes=None, position_m=None,
                altitude_m=None, columns=(), name="flight", airframe=None, lag_s=None, keep_saturated=False):
    """The Flight of arrays of N rows, SI units, whose frames and orders are said.

    world: 'ned' or 'enu', of attitude, velocity and position; body: 'frd' or 'flu'. euler_rad: N x 3, roll, pitch, yaw;
    or quaternion: N x 4, body to world, with quaternion_order 'wxyz' or 'xyzw'. specific_force_m_s2: what an
    accelerometer measures (N x 3, body); velocity_m_s with velocity_axes 'body' or 'world'; position_m, altitude_m (up).
    commands: N x 4, 0 to 1, with motor_order 'px4', 'betaflight' or 'crazyflie'. columns: (name, unit, values). One of
    specific force, velocity and position is needed. Derivatives, lag and what is left out: docs/import.md. Raises
    ValueError or pinnquad.Error, one line.
    """
    _chosen("world", world, _FRAMES["world"])
    _chosen("body", body, _FRAMES["body"])
    _chosen("motor_order", motor_order, _ORDERS)
    if (euler_rad is None) == (quaternion is None):
        raise ValueError("expected euler_rad or quaternion, found " + ("neither" if quaternion is None else "both"))
    if specific_force_m_s2 is None and velocity_m_s is None and position_m is None:
        raise ValueError("expected specific_force_m_s2, velocity_m_s or position_m, found none of them")
    time = _numbers("time_s", time_s, 1)
    rows = len(time)
    steps = np.diff(time[:, 0])
    if not np.all(steps > 0):
        raise ValueError(f"time_s: expected times that increase, found {time[np.argmin(steps > 0) + 1, 0]} in row "
                         f"{np.argmin(steps > 0) + 1}")
    table = {"t": time[:, 0]}
    mapping = f'world = "{world}"\nbody = "{body}"\n[time]\ncolumn = "t"\n'

    def add(key, what, values, width, *lines, keyword="columns"):
        nonlocal mapping
        array = _numbers(what, values, width, rows)
        names = [f"{what}[{i}]" for i in range(width)]
        table.update(zip(names, array.T))
        told = ", ".join(map(_quoted, names))
        mapping += "\n".join([f"[{key}]", f"{keyword} = [{told}]" if width > 1 else f"{keyword} = {told}", *lines, ""])

    if quaternion is not None:
        order = _chosen("quaternion_order", quaternion_order, ("wxyz", "xyzw"))
        add("attitude", "quaternion", quaternion, 4, f'order = "{order}"', keyword="quaternion")
    else:
        add("attitude", "euler_rad", euler_rad, 3, keyword="euler")
    add("body_rates", "body_rates_rad_s", body_rates_rad_s, 3)
    if specific_force_m_s2 is not None:
        add("specific_force", "specific_force_m_s2", specific_force_m_s2, 3)
    if velocity_m_s is not None:
        axes = _chosen("velocity_axes", velocity_axes, ("body", "world"))
        add("velocity", "velocity_m_s", velocity_m_s, 3, f'axes = "{axes}"')
    if position_m is not None:
        add("position", "position_m", position_m, 3)
    if altitude_m is not None:
        add("altitude", "altitude_m", altitude_m, 1)
    add("motors", "commands", commands, 4, f'order = "{motor_order}"')
    for column, unit, values in columns:
        if f"columns: {column}[0]" in table:
            raise ValueError(f"columns: expected names that differ, found {column!r} twice")
        add("[extra]", f"columns: {column}", values, 1, f"name = {_quoted(column)}", f"unit = {_quoted(unit)}",
            keyword="column")
    dataset = _imported(table, mapping, name, airframe=airframe, lag_s=lag_s, keep_saturated=keep_saturated)
    if len(dataset) > 1:
        raise ValueError(f"time_s: expected one flight, found {len(dataset)}, parted by pauses of more than 5 s; "
                         "Dataset.from_dataframe() takes them")
    return dataset[0]


Flight.from_arrays = staticmethod(from_arrays)
Dataset.from_dataframe = staticmethod(from_dataframe)
