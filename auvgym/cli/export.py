"""``auvgym export``: results for other programs."""

from __future__ import annotations

import enum
from pathlib import Path
from typing import Annotated

import typer

from auvgym.cli.console import output


class Format(enum.Enum):
    """What can be written."""

    csv = "csv"
    parquet = "parquet"
    plannerarena = "plannerarena"


_ENDINGS = {".csv": Format.csv, ".parquet": Format.parquet, ".db": Format.plannerarena}


def export(
    results: Annotated[Path, typer.Argument(help="A results.db.")],
    out: Annotated[Path, typer.Option(help="The file to write: .csv, .parquet or .db.")],
    form: Annotated[
        Format | None,
        typer.Option("--format", help="By default what the file's ending says."),
    ] = None,
) -> None:
    """Write the episodes as a table, or for OMPL's Planner Arena (plannerarena.org).

    [dim]Example:[/] auvgym export results/demo/results.db --out episodes.csv
    """
    from auvgym.evaluation import Store
    from auvgym.evaluation.export import FORMATS

    chosen = form or _ENDINGS.get(out.suffix)
    if chosen is None:
        known = ", ".join(_ENDINGS)
        raise ValueError(f"--out {out}: the ending says no format; use {known}, or --format")
    if out.resolve() == results.resolve():
        raise ValueError(f"--out {out}: is the results file itself; choose another name")
    with Store(results, read_only=True) as store:
        rows = store.results()
    out.parent.mkdir(parents=True, exist_ok=True)
    FORMATS[chosen.value](rows, out)
    output().print(f"{len(rows)} episodes: {out}", markup=False, soft_wrap=True)
