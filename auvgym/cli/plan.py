"""``auvgym plan``: one path, through a scenario or through a real ocean."""

from __future__ import annotations

import itertools
import math
import time
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from auvgym.cli.console import output, parse_settings
from auvgym.cli.units import duration, length

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    import auvgym

_PIECES = 100
_SHOWN_APART = ("feasible", "path_length_m", "time_s", "energy_j")


def plan(
    scenario: Annotated[
        str | None,
        typer.Argument(help="A name of `auvgym list scenarios`, or a TOML file."),
    ] = None,
    planner: Annotated[str, typer.Option(help="A name of `auvgym list planners`.")] = "lfhh",
    seed: Annotated[int, typer.Option(help="Seed of the planner and of the world.")] = 0,
    mission: Annotated[int, typer.Option(help="Which start/target pair of the scenario.")] = 0,
    start: Annotated[
        str | None, typer.Option(help="X,Y or X,Y,Z in m; LON,LAT with --currents.")
    ] = None,
    goal: Annotated[
        str | None, typer.Option(help="X,Y or X,Y,Z in m; LON,LAT with --currents.")
    ] = None,
    cost: Annotated[
        str | None, typer.Option(help="What to minimise: lfhh, afhh, time or energy.")
    ] = None,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", help="A parameter of the planner, key=value; may be repeated."),
    ] = None,
    currents: Annotated[Path | None, typer.Option(help="NetCDF file with currents.")] = None,
    bathymetry: Annotated[Path | None, typer.Option(help="NetCDF file with water depth.")] = None,
    speed: Annotated[
        float | None, typer.Option(help="Speed through water, m/s (with --currents).")
    ] = None,
    depth: Annotated[
        float | None, typer.Option(help="Operating depth, m (with --currents).")
    ] = None,
    gap: Annotated[
        bool, typer.Option("--gap", help="Say what the plan costs above the exact optimum.")
    ] = False,
    plot: Annotated[
        Path | None, typer.Option(help="Write a view of the plan to this HTML file.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Write the waypoints to this .json or .csv file.")
    ] = None,
) -> None:
    """Plan one path and say what it costs.

    [dim]Examples:[/] auvgym plan lfhh-3d-1 --planner lfhh --seed 1 --plot plan.html

    auvgym plan harbor-a --planner rmpso --set smoothing=fillet --gap --plot harbor.html

    auvgym plan --currents hycom.nc --bathymetry etopo.nc --start -70,40 --goal -69,36 --out p.csv
    """
    import auvgym
    from auvgym.cli.plan_file import check_suffix, write_plan

    if out is not None:
        check_suffix(out)
    parameters = parse_settings(settings)
    if cost is not None:
        parameters["cost"] = cost
    if currents is not None:
        if scenario is not None:
            raise ValueError(f'give SCENARIO ("{scenario}") or --currents, not both')
        world = auvgym.World(_ocean(currents, bathymetry, start, goal, speed, depth), seed=seed)
        ends = {}
    else:
        if scenario is None:
            raise ValueError("give a SCENARIO (see: auvgym list scenarios) or --currents FILE")
        for option, value in (
            ("--bathymetry", bathymetry), ("--speed", speed), ("--depth", depth),
        ):  # fmt: skip
            if value is not None:
                raise ValueError(f"{option} goes with --currents; a scenario has its own")
        world = auvgym.World(scenario, seed=seed, mission=mission)
        ends = {
            name: _point(world, name, text)
            for name, text in (("start", start), ("goal", goal))
            if text is not None
        }
    begin = time.perf_counter()
    found = auvgym.plan(world, planner, seed=seed, **ends, **parameters)
    seconds = time.perf_counter() - begin
    _show(world, found, seconds)
    if gap:
        _show_gap(world, found, parameters)
    if out is not None:
        write_plan(out, world, found, seed)
        output().print(f"Waypoints: {out}", soft_wrap=True)
    if plot is not None:
        from auvgym.cli.page import write_plan_page

        chart = _chart(world, found, ends, parameters)
        output().print(f"Plot: {write_plan_page(world, found, plot, chart)}", soft_wrap=True)


def _chart(
    world: auvgym.World,
    found: auvgym.Plan,
    ends: dict[str, Any],
    parameters: dict[str, Any],
) -> auvgym.Maklink | None:
    """What a planner of harbours planned on; None for others."""
    import auvgym

    if found.harbor is None:
        return None
    return auvgym.maklink(world, **ends, **parameters.get("zones", {}))


def _ocean(
    currents: Path,
    bathymetry: Path | None,
    start: str | None,
    goal: str | None,
    speed: float | None,
    depth: float | None,
) -> auvgym.Scenario:
    from auvgym import ocean

    if start is None or goal is None:
        raise ValueError("--currents needs --start LON,LAT and --goal LON,LAT")
    optional: dict[str, Any] = {}
    if speed is not None:
        optional["vehicle_speed_mps"] = speed
    if depth is not None:
        optional["depth_m"] = depth
    with warnings.catch_warnings():
        # What it warns of is among the scenario's notes, which are printed.
        warnings.simplefilter("ignore", ocean.OceanDataWarning)
        return ocean.load(
            currents=currents,
            bathymetry=bathymetry,
            start=_numbers("--start", start, (2,)),
            goal=_numbers("--goal", goal, (2,)),
            **optional,
        )


def _point(world: auvgym.World, name: str, text: str) -> list[float]:
    """``X,Y[,Z]``; without Z the depth that the mission has there."""
    numbers = list(_numbers(f"--{name}", text, (2, 3)))
    return [*numbers, float(getattr(world, name)[2])] if len(numbers) == 2 else numbers


def _numbers(option: str, text: str, lengths: tuple[int, ...]) -> tuple[float, ...]:
    try:
        numbers = tuple(float(part) for part in text.split(","))
    except ValueError:
        numbers = ()
    if len(numbers) not in lengths:
        wanted = " or ".join(str(length) for length in lengths)
        raise ValueError(f'{option} is "{text}"; {wanted} numbers separated by commas are needed')
    return numbers


def _show(world: auvgym.World, found: auvgym.Plan, seconds: float) -> None:
    import numpy as np
    from rich.table import Table

    waypoints = np.asarray(found.waypoints)
    straight = np.vstack([waypoints[0], waypoints[-1]])
    length_m = float(np.linalg.norm(np.diff(waypoints, axis=0), axis=1).sum())
    straight_m = float(np.linalg.norm(straight[1] - straight[0]))
    speed_mps = float(world.scenario.to_dict()["vehicle"]["speed_mps"])
    console = output()
    for note in world.scenario.notes:
        console.print(f"note: {note}", style="dim", markup=False, soft_wrap=True)
    table = Table(box=None, show_header=False, padding=(0, 2, 0, 0))
    table.add_row("scenario", world.scenario.name)
    table.add_row("planner", found.planner)
    table.add_row("feasible", "yes" if found.feasible else "[red]no[/]")
    terms = (key for key in found.cost if key not in _SHOWN_APART)
    table.add_row("cost", "  ".join(f"{key} {found.cost[key]:.4g}" for key in terms))
    table.add_row("length", f"{length(length_m)}  (straight {length(straight_m)})")
    table.add_row(
        "travel time",
        f"{_travel_time(world, waypoints)}  (straight {_travel_time(world, straight)}, "
        f"in still water {duration(straight_m / speed_mps)})",
    )
    if found.harbor is not None:
        _show_harbor(table, found.harbor)
    table.add_row("evaluations", f"{found.evaluations}")
    table.add_row("planning", f"{seconds:.3f} s")
    console.print(table)


def _show_harbor(table: Any, report: auvgym.HarborReport) -> None:
    depth = report.depth_m
    table.add_row(
        "danger zones", f"[red]entered, {depth:.2f} m deep[/]" if depth > 1e-6 else "kept out of"
    )
    if report.barriers:
        table.add_row("no way", f"[red]zones of polygons {report.barriers} part the goal[/]")
    if report.gap_m is not None:
        table.add_row("above the shortest", f"{report.gap_m:+.3f} m")


def _show_gap(world: auvgym.World, found: auvgym.Plan, parameters: dict[str, Any]) -> None:
    import auvgym
    from auvgym.planning import is_harbor

    if "cost" not in parameters and is_harbor(world):
        gap = auvgym.gap(world, found, "length", **parameters.get("zones", {}))
        output().print(f"gap: {gap:+.3f} m above the shortest path round the danger zones")
        return
    cost, options = parameters.get("cost", "lfhh"), parameters.get("cost_options", {})
    gap = auvgym.gap(world, found, cost, **options)
    output().print(f"gap: {gap:+.4f} above the section optimum in cost {cost}")


def _travel_time(world: auvgym.World, path: NDArray[np.float64]) -> str:
    """The time with the current, or what stands in the way."""
    import numpy as np

    import auvgym

    # Short pieces: a piece is charged the current at a few of its points. Turns are no matter here.
    fine = [np.linspace(a, b, _PIECES, endpoint=False) for a, b in itertools.pairwise(path)]
    pieces = np.vstack([*fine, path[-1:]])
    cost = auvgym.path_cost(world, pieces, cost="time", turn_limit_rad=math.pi)
    if cost["block"] > 0.0:
        return f"{duration(cost['time_s'])}, through obstacles"
    return duration(cost["time_s"]) if cost["feasible"] else "swept off by the current"
