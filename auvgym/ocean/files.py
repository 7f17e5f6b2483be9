"""Opening a NetCDF file: what it is by its first bytes, whatever its name says."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from auvgym._extras import require

# scipy checks that a classic file is as long as its header says; the netCDF C library reads
# zeros, a current of nothing, where such a file was cut off.
_ENGINES = {
    b"\x89HDF\r\n\x1a\n": "netcdf4",
    b"CDF\x01": "scipy",
    b"CDF\x02": "scipy",
    b"CDF\x05": "netcdf4",
}
_STRANGERS = {
    b"\x1f\x8b": "gzip-compressed: unpack it first",
    b"PK\x03\x04": "a zip archive: unpack it first",
    b"GRIB": "a GRIB file: convert it to NetCDF first",
    b"II*\x00": "a TIFF picture: convert it to NetCDF first",
    b"MM\x00*": "a TIFF picture: convert it to NetCDF first",
    b"<": "a web page or XML, perhaps the error page of a failed download",
}


class OceanDataWarning(UserWarning):
    """Something in ocean data was completed or assumed; the scenario's notes say it too."""


@contextmanager
def open_file(path: str | os.PathLike[str]) -> Iterator[Any]:
    """Open a NetCDF-3, -4 or -5 file as an ``xarray.Dataset``, numbers unpacked, times as stored.

    ``valid_min`` and ``valid_max`` are not applied: files give them in packed or in unpacked units.
    Raises FileNotFoundError, or ValueError naming the file when it is not NetCDF or is damaged,
    also when that shows only while its values are read inside the ``with`` block.
    """
    file = Path(path)
    if not file.is_file():
        raise FileNotFoundError(f"{file}: there is no such file")
    engine = _engine(file)
    require("netCDF4" if engine == "netcdf4" else "scipy", "ocean")
    xarray = require("xarray", "ocean")
    # Without mmap a classic file is read whole, but closes cleanly whatever happens.
    settings = {"mmap": False} if engine == "scipy" else {}
    with reading(file), warnings.catch_warnings():
        # _FillValue and missing_value may differ: both are masked, which is right.
        warnings.simplefilter("ignore", xarray.SerializationWarning)
        dataset = xarray.open_dataset(
            file,
            engine=engine,
            decode_times=False,
            decode_coords=False,
            decode_timedelta=False,
            **settings,
        )
    with dataset:
        yield dataset


@contextmanager
def reading(file: str | os.PathLike[str]) -> Iterator[None]:
    """Turn what the libraries raise on damaged files into a ValueError that names the file."""
    try:
        yield
    except Exception as error:  # HDF5, netCDF and scipy each have their own kinds
        raise ValueError(
            f"{Path(file).name}: cannot be read, it is damaged or cut off ({error}); "
            "fetch or copy it again"
        ) from error


def _engine(file: Path) -> str:
    """Which xarray engine reads the file."""
    with file.open("rb") as stream:
        head = stream.read(8)
    for magic, engine in _ENGINES.items():
        if head.startswith(magic):
            return engine
    found = next((text for magic, text in _STRANGERS.items() if head.startswith(magic)), None)
    found = found or ("empty" if not head else f"something else (it begins with {head!r})")
    raise ValueError(f"{file.name}: is not a NetCDF file but {found}; NetCDF-3, -4 and -5 are read")
