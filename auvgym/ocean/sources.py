"""The files of a mission: opened, their fields found, and turned to the mission's longitudes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from auvgym.ocean.axes import recentre
from auvgym.ocean.fields import Field, bathymetry_name, find_bathymetry, find_current
from auvgym.ocean.files import open_file
from auvgym.ocean.mission import Extent
from auvgym.ocean.request import Request

_CREDITS = ("title", "institution", "license", "licence", "distribution_statement")


@dataclass(frozen=True)
class Sources:
    """The fields that were found; at least one is there."""

    current: Field | None
    bathymetry: Field | None
    notes: list[str] = field(default_factory=list)

    @property
    def fields(self) -> list[Field]:
        """Those that are there."""
        return [source for source in (self.current, self.bathymetry) if source is not None]

    def extent(self) -> Extent:
        """The degrees that all of them cover. Raises ValueError when there are none."""
        common = Extent(
            max(source.longitude.low for source in self.fields),
            min(source.longitude.high for source in self.fields),
            max(source.latitude.low for source in self.fields),
            min(source.latitude.high for source in self.fields),
        )
        if common.west >= common.east or common.south >= common.north:
            each = "; ".join(f"{source.file}: {field_extent(source)}" for source in self.fields)
            raise ValueError(f"currents and bathymetry do not overlap ({each})")
        return common

    def crop(self, window: Extent) -> Sources:
        """The nodes that hold a window between them, as far as there are any."""

        def cropped(source: Field | None) -> Field | None:
            if source is None:
                return None
            return replace(
                source,
                longitude=source.longitude.crop(window.west, window.east),
                latitude=source.latitude.crop(window.south, window.north),
            )

        return Sources(cropped(self.current), cropped(self.bathymetry), self.notes)


@contextmanager
def open_sources(request: Request, longitude_deg: float) -> Iterator[Sources]:
    """Open the files and find their fields, with longitudes near ``longitude_deg``.

    Without bathymetry a sea floor in the currents' own file is taken. Raises ValueError or
    FileNotFoundError naming the argument or the file.
    """
    with ExitStack() as stack:
        notes: list[str] = []
        current = floor = None
        if request.currents is not None:
            dataset, file = (
                stack.enter_context(open_file(request.currents)),
                Path(request.currents).name,
            )
            current = find_current(dataset, file, request.current_names)
            notes += _credit(dataset, file)
            own = request.bathymetry_name or bathymetry_name(dataset, certain=True)
            if request.bathymetry is None and own is not None:
                floor = find_bathymetry(dataset, file, own, request.bathymetry_positive)
                notes.append(f"The sea floor is {own} of {file}.")
        if request.bathymetry is not None:
            dataset, file = (
                stack.enter_context(open_file(request.bathymetry)),
                Path(request.bathymetry).name,
            )
            floor = find_bathymetry(
                dataset, file, request.bathymetry_name, request.bathymetry_positive
            )
            notes += _credit(dataset, file)

        def turned(source: Field | None) -> Field | None:
            if source is None:
                return None
            return replace(source, longitude=recentre(source.longitude, longitude_deg))

        yield Sources(turned(current), turned(floor), notes)


def field_extent(source: Field) -> Extent:
    """The degrees that a field covers."""
    return Extent(
        source.longitude.low, source.longitude.high, source.latitude.low, source.latitude.high
    )


def _credit(dataset: Any, file: str) -> list[str]:
    """Whose data it is, as far as the file says: the scenario carries the data on."""
    said = [
        " ".join(str(value).split())[:300]
        for key, value in dataset.attrs.items()
        if key in _CREDITS or key.startswith("credit")
    ]
    return [f"Data of {file}: {'; '.join(dict.fromkeys(said))}."] if said else []
