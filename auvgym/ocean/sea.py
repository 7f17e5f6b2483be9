"""The sea of a mission: its current and floor read, reconciled and completed."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from auvgym.ocean import water
from auvgym.ocean.axes import Axis
from auvgym.ocean.fields import Field
from auvgym.ocean.grids import CurrentGrid, DepthGrid, Mask, read_current, read_depth, read_known
from auvgym.ocean.request import Missing, Request
from auvgym.ocean.sources import Sources
from auvgym.ocean.times import Slices, choose_slices


@dataclass
class Sea:
    """What a mission's area holds. ``known``: where the file has a current, before filling.

    ``notes`` say what was decided, ``warnings`` those of them that the user should see at once.
    """

    current: CurrentGrid | None
    seabed: DepthGrid | None
    known: Mask | None
    notes: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    def known_at(self, depth_m: float) -> Mask | None:
        """``known`` (latitude, longitude) of the level at or above a depth."""
        if self.current is None or self.known is None:
            return None
        level = int(np.searchsorted(self.current.depth, depth_m, side="right")) - 1
        return np.asarray(self.known[max(level, 0)])

    def warn(self, text: str) -> None:
        """Note something that needs attention."""
        self.notes.append(text)
        self.warnings.append(text)


def read_sea(sources: Sources, request: Request, depth_m: float | None) -> Sea:
    """Read cropped sources. ``depth_m``: the one depth of a 2-D mission, None in 3-D.

    Raises ValueError naming the file or argument.
    """
    sea = Sea(None, None, None, list(sources.notes))
    if sources.bathymetry is not None:
        sea.seabed = read_depth(sources.bathymetry)
        sea.notes += sea.seabed.notes
    if sources.current is None:
        if request.time is not None:
            raise ValueError(
                f"time={request.time!r}: there are no currents, only time=None is allowed"
            )
        sea.notes.append("No currents were given: the water is still.")
        return sea
    source = sources.current
    slices = choose_slices(source.time, request.time, source.file)
    sea.notes += [*source.notes, slices.note]
    levels = _levels(source.depth, _deepest_needed(request, sea.seabed, depth_m))
    current = sea.current = read_current(source, slices, levels)
    sea.notes += current.notes
    extended = water.extend_down(current)
    if depth_m is not None:
        extended = extended[-1:]
        _note_depth(sea, source, depth_m)
        water.take_depth(current, depth_m)
    elif source.depth is None or source.depth.values.size == 1:
        at = "" if source.depth is None else f" at {source.depth.low:g} m"
        sea.warn(f"The only current of {source.file}{at} is used at all depths.")
    sea.known = current.known
    if sea.seabed is None:
        sea.seabed = _seabed_of_currents(sea, source, current, slices, depth_m)
    else:
        _complete(sea, current, sea.seabed, extended, request.missing)
    return sea


def _deepest_needed(
    request: Request, seabed: DepthGrid | None, depth_m: float | None
) -> float | None:
    """The depth down to which currents are needed; None = as far as there are any."""
    if depth_m is not None:
        return depth_m
    floor_m = None if seabed is None else float(seabed.depth.max())
    bounds = [bound for bound in (floor_m, request.max_depth_m) if bound is not None]
    return min(bounds) if bounds else None


def _levels(depth: Axis | None, deepest_m: float | None) -> Axis | None:
    """The levels down to the first at or below ``deepest_m``; all without it."""
    if depth is None or deepest_m is None:
        return depth
    last = int(np.searchsorted(depth.values, deepest_m))
    return depth.part(0, min(last, depth.values.size - 1))


def _note_depth(sea: Sea, source: Field, depth_m: float) -> None:
    """Say which levels a 2-D current was made of."""
    if source.depth is None:
        if depth_m > 0.0:
            sea.warn(
                f"{source.file} does not say at which depth its current runs: it is used at "
                f"{depth_m:g} m."
            )
        return
    levels = source.depth.values
    after = min(int(np.searchsorted(levels, depth_m)), levels.size - 1)
    if levels[0] < depth_m < levels[-1] and levels[after] != depth_m:
        sea.notes.append(
            f"The current at {depth_m:g} m is interpolated between the levels at "
            f"{levels[after - 1]:g} m and {levels[after]:g} m."
        )
        return
    nearest = levels[0] if depth_m <= levels[0] else levels[after]
    text = f"The current at {depth_m:g} m is that of the level at {nearest:g} m."
    if depth_m > levels[-1]:
        sea.warn(f"{text[:-1]}, the deepest of {source.file}.")
    else:
        sea.notes.append(text)


def _seabed_of_currents(
    sea: Sea, source: Field, current: CurrentGrid, slices: Slices, depth_m: float | None
) -> DepthGrid | None:
    """The sea floor that the currents' own gaps tell of."""
    file = source.file
    if source.depth is None or source.depth.values.size == 1:
        if depth_m is None:
            raise ValueError(
                f"dimensions=3: {file} has one level and tells nothing of the sea floor; "
                "give bathymetry=..., or dimensions=2"
            )
        known, levels = current.known, np.zeros(1)
        open_floor_m = depth_m + water.UNKNOWN_DEPTH_M
    else:
        known, levels = read_known(source, int(slices.order[0])), source.depth.values
        known = known & known[:1] & current.known[:1]
        open_floor_m = float(levels[-1])
        if depth_m is not None:
            open_floor_m = max(open_floor_m, depth_m + water.UNKNOWN_DEPTH_M)
    top = known[0]
    if top.all() and levels.size == 1:
        still = (current.u[0, 0] == 0.0) & (current.v[0, 0] == 0.0)
        sea.notes.append(f"No bathymetry was given and {file} has no gaps: there is no land.")
        if still.mean() > 0.01:
            sea.warn(
                f"{int(still.sum())} of {still.size} nodes of {file} have exactly no current: if "
                "that is its way to mark land, give bathymetry=... so that land is known."
            )
        return None
    depth_known = (
        "the sea floor lies halfway below the deepest level with a current"
        if levels.size > 1
        else f"the depth of the water is not known and set to {open_floor_m:g} m"
    )
    sea.notes.append(
        f"No bathymetry was given: land is where {file} has no current "
        f"({int((~top).sum())} of {top.size} nodes), {depth_known}."
    )
    return water.seabed_from_mask(known, levels, current, open_floor_m)


def _complete(
    sea: Sea, current: CurrentGrid, seabed: DepthGrid, extended: Mask, missing: Missing
) -> None:
    """A current for all of the water, as ``missing`` says."""
    floor = water.floor_at_nodes(current, seabed)
    below = int((extended & (floor > current.depth[:, np.newaxis, np.newaxis])).sum())
    if below:
        sea.notes.append(
            f"{below} water nodes lie below the deepest level with a current of {current.title} "
            "and take that level's."
        )
    gaps, nodes = water.count_gaps(current, seabed)
    lacking = (
        f"{gaps} of {nodes} nodes are water by {seabed.title} but have no current in "
        f"{current.title}"
    )
    if missing == "land":
        dry = water.make_land(current, seabed)
        if gaps:
            sea.warn(f"{lacking}: {dry} nodes of the sea floor nearest to them are made land.")
        return
    if gaps and missing == "error":
        raise ValueError(
            f'missing="error": {lacking}; "fill" takes the nearest current, "land" makes them land'
        )
    longest_m = water.fill_gaps(current, seabed)
    if gaps:
        sea.warn(
            f"{lacking}: they take the nearest known current, at most {longest_m / 1000.0:.3g} km "
            "away."
        )
