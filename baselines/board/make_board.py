"""Fly the published boards, keep their results as Parquet, and write their tables.

python baselines/board/make_board.py demo --workers 2     # fly, keep, write
python baselines/board/make_board.py demo --tables        # write the tables of what is kept

A run can be stopped and goes on where it was. The tables follow from the Parquet file alone, and
auvgym verify recomputes results/board/SUITE/results.db from its action logs.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import auvgym
from auvgym import evaluation
from auvgym.cli.flying import fly_with_progress
from auvgym.evaluation.board import board
from auvgym.evaluation.export import export_parquet, read_parquet
from auvgym.report.text_tables import latex, markdown

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

HERE = Path(__file__).parent


def main() -> None:
    """Read the command line and do what it asks."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    known = definitions()
    parser.add_argument("boards", nargs="*", metavar="BOARD", help=f"of {', '.join(known)}")
    parser.add_argument("--workers", type=int, default=2, help="processes to fly in")
    parser.add_argument("--engine", default="processes", choices=["processes", "ray"])
    parser.add_argument("--tables", action="store_true", help="fly nothing, write the tables")
    arguments = parser.parse_args()
    for name in arguments.boards or known:
        if name not in known:
            parser.error(f"there is no board {name!r}, but {', '.join(known)}")
        if not arguments.tables:
            fly(name, known[name], arguments.workers, arguments.engine)
        if kept(name).is_file():
            write_tables(name, known[name], HERE)
            print(f"{name}: {kept(name)} and its tables")


def definitions() -> dict[str, dict[str, Any]]:
    """Board -> its definition."""
    return tomllib.loads((HERE / "board.toml").read_text(encoding="utf-8"))


def kept(name: str) -> Path:
    """Where a board's results are kept."""
    return HERE / f"{name}.parquet"


def fly(name: str, definition: dict[str, Any], workers: int, engine: Any) -> None:
    """Fly what is missing of a board, and keep its results."""
    suite = evaluation.load_suite(name)
    names = suite.policies if definition["policies"] == "suite" else auvgym.list_policies()
    specs = [evaluation.PolicySpec(policy) for policy in names]
    with evaluation.Store(Path("results") / "board" / name / "results.db") as store:
        rows = fly_with_progress(suite, specs, store, workers, engine, flies=evaluation.fitting)
    export_parquet(rows, kept(name))


def write_tables(name: str, definition: dict[str, Any], folder: Path) -> None:
    """Write NAME.md and NAME.tex of what is kept."""
    rows = read_parquet(kept(name))
    boards = board(rows, definition["reference"])
    first = rows[0]
    head = (
        f"# Board: {name}\n\n{len(rows):,} episodes of suite `{first.suite}`, hash "
        f"`{first.suite_hash}`, flown by auvgym {first.engine_version}; the reference is "
        f"`{definition['reference']}`. What the columns say: "
        "[docs/leaderboard.md](../../docs/leaderboard.md#what-the-columns-say).\n\n"
    )
    (folder / f"{name}.md").write_text(head + markdown(boards), encoding="utf-8")
    (folder / f"{name}.tex").write_text(latex(boards), encoding="utf-8")


if __name__ == "__main__":
    main()
