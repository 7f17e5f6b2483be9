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

from auvgym import evaluation
from auvgym.cli.flying import fly_with_progress
from auvgym.evaluation.board import BoardRow, board
from auvgym.evaluation.export import export_parquet, read_parquet
from auvgym.evaluation.statistics import OVERALL
from auvgym.evaluation.suite import Stratum
from auvgym.report.text_tables import latex, markdown

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

HERE = Path(__file__).parent
README = HERE.parents[1] / "README.md"
BEGIN, END = "<!-- board: written by make leaderboard -->", "<!-- end of board -->"
LEADING = 3


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
            if known[name].get("readme"):
                readme = README.read_text(encoding="utf-8")
                README.write_text(with_short_table(readme, name, known[name]), encoding="utf-8")
            print(f"{name}: {kept(name)} and its tables")


def definitions() -> dict[str, dict[str, Any]]:
    """Board -> its definition."""
    return tomllib.loads((HERE / "board.toml").read_text(encoding="utf-8"))


def kept(name: str) -> Path:
    """Where a board's results are kept."""
    return HERE / f"{name}.parquet"


def entries(
    suite: evaluation.Suite, definition: dict[str, Any]
) -> list[tuple[evaluation.PolicySpec, set[str]]]:
    """Who flies, and in which environments."""
    everywhere = {instance.environment for instance in suite.instances}
    return [
        (
            evaluation.PolicySpec(policy, parameters=entry.get("parameters", {})),
            set(entry.get("environments", everywhere)),
        )
        for entry in definition.get("entries", [{"policies": suite.policies}])
        for policy in entry["policies"]
    ]


def fly(name: str, definition: dict[str, Any], workers: int, engine: Any) -> None:
    """Fly what is missing of a board, and keep its results."""
    suite = evaluation.load_suite(name)
    entered = entries(suite, definition)
    allowed = {
        (spec.name, environment) for spec, environments in entered for environment in environments
    }

    def flies(spec: evaluation.PolicySpec, instance: evaluation.Instance) -> bool:
        entered = (spec.name, instance.environment) in allowed
        return entered and evaluation.fitting(spec, instance)

    with evaluation.Store(Path("results") / "board" / name / "results.db") as store:
        specs = [spec for spec, _ in entered]
        rows = fly_with_progress(suite, specs, store, workers, engine, flies=flies)
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


def with_short_table(readme: str, name: str, definition: dict[str, Any]) -> str:
    """README.md with the short table of a board between its markers."""
    before, rest = readme.split(BEGIN)
    _, after = rest.split(END)
    boards = board(read_parquet(kept(name)), definition["reference"])
    sentence = (
        f"The best {LEADING} of each environment and `{definition['reference']}` on "
        f"[board `{name}`](baselines/board/{name}.md): mean score (T_ref / T if they arrive, else "
        "0), and how many they solve."
    )
    table = short_table(boards, definition["reference"])
    return f"{before}{BEGIN}\n\n{sentence}\n\n{table}\n{END}{after}"


def short_table(boards: dict[Stratum, list[BoardRow]], reference: str) -> str:
    """The best three of each environment and the reference: mean score, and how many it solves."""
    strata = [stratum for stratum in boards if stratum != OVERALL]
    found = {
        stratum: {row.summary.policy: row.summary for row in boards[stratum]} for stratum in strata
    }
    leading = {row.summary.policy for stratum in strata for row in boards[stratum][:LEADING]}
    shown = leading | {reference}

    def mean(policy: str) -> float:
        return sum(found[one][policy].score for one in strata if policy in found[one]) / len(strata)

    def cell(stratum: Stratum, policy: str) -> str:
        one = found[stratum].get(policy)
        return "-" if one is None else f"{one.score:.2f} ({one.solved}/{one.episodes})"

    lines = [
        ["policy", *(f"`{environment}`" for environment, *_ in strata)],
        ["---", *("--:" for _ in strata)],
        *(
            [f"`{policy}`", *(cell(stratum, policy) for stratum in strata)]
            for policy in sorted(shown, key=lambda policy: (-mean(policy), policy))
        ),
    ]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


if __name__ == "__main__":
    main()
