"""The time axis of a series: decoding it, and choosing where the scenario's clock starts."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Any

import numpy as np
from numpy.typing import NDArray

from auvgym._extras import require
from auvgym.ocean.files import reading
from auvgym.ocean.request import TimeWish

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Slices:
    """Which slices of a file are read, and the times (s) made of them.

    ``order`` (m,) are places in the file in the order of time, ``at_s`` (m,) their times and
    ``time_s`` (n,) the wanted ones, both counted from the first wanted one. ``note`` says it.
    """

    order: NDArray[np.intp]
    at_s: FloatArray
    time_s: FloatArray
    note: str

    def interpolate(self, values: NDArray[np.float32]) -> NDArray[np.float32]:
        """Read slices (m, ...) to wanted ones (n, ...), linear in between."""
        if np.array_equal(self.at_s, self.time_s):
            return values
        after = np.clip(np.searchsorted(self.at_s, self.time_s), 1, self.at_s.size - 1)
        before = after - 1
        way = (self.time_s - self.at_s[before]) / (self.at_s[after] - self.at_s[before])
        share = way.astype(np.float32).reshape(-1, *[1] * (values.ndim - 1))
        mixed = values[before] * (1 - share) + values[after] * share
        # A slice used as it is must not inherit the gaps of its neighbour.
        mixed = np.where(share == 0, values[before], mixed)
        return np.asarray(np.where(share == 1, values[after], mixed), dtype=np.float32)


def choose_slices(coordinate: Any | None, wanted: TimeWish, file: str) -> Slices:
    """The slices of a file (``coordinate``: its time variable or None) for a wish.

    ``wanted``: None = all of them; an ISO time = from then on; a pair of ISO times = from the
    first to the second, a pair of equal ones = the steady field of that moment. UTC.
    Raises ValueError, naming the file, on times it does not hold or that cannot be decoded.
    """
    if coordinate is None or coordinate.size == 1:
        return _only_slice(coordinate, wanted, file)
    times = _decode(coordinate, file)
    order = np.argsort(times, kind="stable")
    times = times[order]
    if (np.diff(times) <= np.timedelta64(0)).any():
        raise ValueError(f"{file}: time {coordinate.name} has one time twice; times must differ")
    start, end = _span(wanted, times, file)
    first = int(np.searchsorted(times, start, side="right")) - 1
    last = int(np.searchsorted(times, end, side="left"))
    inside = times[(times > start) & (times < end)]
    used = np.unique(np.concatenate([[start], inside, [end]]))
    time_s = _seconds(used, start)
    if used.size == 1:
        note = f"The current of {file} at {_show(start)} is used as a steady one."
    else:
        hours = float(time_s[-1]) / 3600.0
        note = (
            f"The current of {file} changes with time: {used.size} slices from {_show(start)} "
            f"over {hours:.4g} h; time 0 is the first, after the last it stays as it is."
        )
    return Slices(order[first : last + 1], _seconds(times[first : last + 1], start), time_s, note)


def _only_slice(coordinate: Any | None, wanted: TimeWish, file: str) -> Slices:
    """A file with one slice, or without time."""
    zero = np.zeros(1)
    if coordinate is None:
        if wanted is not None:
            raise ValueError(f"time={wanted!r}: {file} has no time axis, only time=None is allowed")
        note = f"{file} has no time axis: the current is steady."
        return Slices(np.zeros(1, dtype=np.intp), zero, zero, note)
    note = f"{file} has one time slice: the current is steady."
    if wanted is not None or " since " in str(coordinate.attrs.get("units", "")):
        times = _decode(coordinate, file)
        _span(wanted, times, file)
        note = f"{file} has one time slice, {_show(times[0])}: the current is steady."
    return Slices(np.zeros(1, dtype=np.intp), zero, zero, note)


def _span(
    wanted: TimeWish, times: NDArray[np.datetime64], file: str
) -> tuple[np.datetime64, np.datetime64]:
    """First and last moment used."""
    if wanted is None:
        return times[0], times[-1]
    if isinstance(wanted, (str, datetime)):
        start, end = _parse(wanted), times[-1]
    elif len(wanted) == 2:
        start, end = _parse(wanted[0]), _parse(wanted[1])
    else:
        raise ValueError(f"time={wanted!r}: must be None, an ISO time or a pair of them")
    held = f"{file} holds {_show(times[0])} .. {_show(times[-1])}"
    for moment in (start, end):
        if not times[0] <= moment <= times[-1]:
            raise ValueError(f"time={_show(moment)}: {held}")
    if end < start:
        raise ValueError(f"time={wanted!r}: the second time is before the first; {held}")
    return start, end


def _parse(wanted: str | datetime) -> np.datetime64:
    try:
        moment = (
            wanted
            if isinstance(wanted, datetime)
            else datetime.fromisoformat(wanted.strip().replace("Z", "+00:00"))
        )
    except ValueError as error:
        raise ValueError(
            f'time={wanted!r}: must be an ISO time such as "2020-11-01T06:00" (UTC)'
        ) from error
    if moment.tzinfo is not None:
        moment = moment.astimezone(timezone.utc).replace(tzinfo=None)
    return np.datetime64(moment, "ns")


def _decode(coordinate: Any, file: str) -> NDArray[np.datetime64]:
    """Moments (datetime64[ns], UTC) of a CF time axis."""
    xarray = require("xarray", "ocean")
    what = f"{file}: time {coordinate.name}"
    with reading(file):
        values = coordinate.values
    if not np.isfinite(np.asarray(values, dtype=np.float64)).all():
        raise ValueError(f"{what} has missing values")
    dataset = xarray.Dataset({"moment": (("moment",), values.ravel(), dict(coordinate.attrs))})
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", xarray.SerializationWarning)
            decoded = xarray.decode_cf(dataset, mask_and_scale=False)["moment"].values
    except ValueError as error:
        raise ValueError(
            f"{what}: its units {coordinate.attrs.get('units')!r} are not CF"
        ) from error
    if decoded.dtype.kind != "M":
        units, calendar = (coordinate.attrs.get(key) for key in ("units", "calendar"))
        raise ValueError(
            f"{what} (units {units!r}, calendar {calendar!r}) is not a time of the standard "
            'calendar in CF form, such as "hours since 2000-01-01"'
        )
    return np.asarray(decoded, dtype="datetime64[ns]")


def _seconds(times: NDArray[np.datetime64], zero: np.datetime64) -> FloatArray:
    """Seconds since ``zero``, to the millisecond."""
    milliseconds = (times - zero) / np.timedelta64(1, "ms")
    return np.asarray(np.round(milliseconds) / 1000.0, dtype=np.float64)


def _show(moment: np.datetime64) -> str:
    return str(moment.astype("datetime64[s]")).removesuffix(":00")
