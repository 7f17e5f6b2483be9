"""Cards: which table or figure of a paper is run again, and what the paper says. Kept as TOML."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from importlib import resources
from typing import Any, Literal, get_args

from auvgym._names import unknown
from auvgym.reproduction.measures import MEASURES
from auvgym.reproduction.runs import Protocol, Run, parameters_text

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib  # type: ignore[import-not-found,unused-ignore]

#: What a card shows: costs or seconds case by case, curves over evaluations, costs over parameters,
#: or whatever was measured, case by case, or how what was measured is distributed.
View = Literal["costs", "seconds", "curves", "sweeps", "measures", "distributions"]
PictureKind = Literal["paths", "flights", "distances", "dots", "boxes", "progress"]
#: Colours that differ for colour-blind readers, too (Okabe and Ito 2008).
COLOURS = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#7a6a00", "#000000")
_FOLDER = resources.files("auvgym.reproduction") / "cards"


class CardError(ValueError):
    """A card that does not exist or is not as cards are."""


@dataclass(frozen=True)
class Column:
    """A planner as the paper ran it; a card's first column is what the others are compared with.

    Attributes:
        label: its name in the paper.
        planner: a planner's name.
        parameters: its own parameters.
        window: sections of the planning window, 0 for the whole rest of the path.
    """

    label: str
    planner: str
    parameters: dict[str, Any] = field(default_factory=dict)
    window: int = 20


@dataclass(frozen=True)
class Case:
    """A row: a scenario, a start/goal pair, and the paper's figures for each column if any.

    Attributes:
        label: in words.
        scenario: a shipped scenario.
        mission: its start/goal pair.
        mean, deviation, seconds, sign: the paper's costs, times and verdicts.
        parameters: what all columns of this row have in common.
        paper: for these views, measure -> the paper's figures; "" where it has none.
    """

    label: str
    scenario: str
    mission: int = 0
    mean: tuple[float, ...] = ()
    deviation: tuple[float, ...] = ()
    seconds: tuple[float, ...] = ()
    sign: tuple[str, ...] = ()
    parameters: dict[str, Any] = field(default_factory=dict)
    paper: dict[str, list[float | str]] = field(default_factory=dict)


@dataclass(frozen=True)
class Sweep:
    """A figure: the planner of the first column with every combination of some parameters."""

    title: str
    parameters: dict[str, list[float]]


@dataclass(frozen=True)
class Picture:
    """A picture of a card of the view "measures"; without any, that view draws bars.

    Attributes:
        kind: "paths" or "flights", in 3-D and from above; "distances" to threats against time;
            "dots", a panel for each measure; "boxes" of the first measure; "progress": the first
            measure over budgets, which cases labelled "GROUP, N lines" have.
        title: in words.
        name: of its file, after the card's.
        columns, cases: labels of those that are shown; all if empty.
        measures: for "dots", those that are shown; all if empty.
    """

    kind: PictureKind
    title: str
    name: str
    columns: tuple[str, ...] = ()
    cases: tuple[str, ...] = ()
    measures: tuple[str, ...] = ()

    def shown(self, card: Card) -> list[Column]:
        """Its columns, in the card's order."""
        return [one for one in card.columns if not self.columns or one.label in self.columns]

    def rows(self, card: Card) -> list[Case]:
        """Its cases, in the card's order."""
        return [one for one in card.cases if not self.cases or one.label in self.cases]

    @staticmethod
    def colour(index: int) -> str:
        """The colour of a line."""
        return COLOURS[index % len(COLOURS)]


@dataclass(frozen=True)
class Card:
    """A table or figure of a paper, to be run again.

    Attributes:
        name: of the command line.
        title: in words.
        source: paper and number of the table or figure.
        view: what it shows.
        protocol: how a run goes.
        parameters: what all columns have in common.
        columns: planners.
        cases: rows.
        sweeps: for the view "sweeps".
        measures: for the views "measures" and "distributions", those that are shown.
        pictures: for the view "measures", what is drawn instead of bars.
        seeds: of each cell, as the paper has them; 1 where nothing is random.
        why: where and why we and the paper differ, in words (Markdown).
    """

    name: str
    title: str
    source: str
    view: View
    protocol: Protocol
    columns: tuple[Column, ...]
    cases: tuple[Case, ...]
    parameters: dict[str, Any] = field(default_factory=dict)
    sweeps: tuple[Sweep, ...] = ()
    measures: tuple[str, ...] = ()
    pictures: tuple[Picture, ...] = ()
    seeds: int = 30
    why: str = ""

    @property
    def journal(self) -> str:
        """The experiment, whose runs all its cards share: the first part of the name."""
        return self.name.partition("-")[0]

    def run(self, case: Case, column: Column, seed: int) -> Run:
        """One run of a cell."""
        parameters = {**self.parameters, **case.parameters, **column.parameters}
        return Run(
            self.protocol,
            case.scenario,
            case.mission,
            column.planner,
            parameters_text(parameters),
            column.window if self.protocol == "phases" else 0,
            seed,
        )

    def runs(self, seeds: int) -> list[Run]:
        """Every run, seed by seed: what is stopped early has as many seeds everywhere."""
        columns = [
            *self.columns,
            *(column for sweep in self.sweeps for column in swept(self, sweep)),
        ]
        return [
            self.run(case, column, seed)
            for seed in range(seeds)
            for case in self.cases
            for column in columns
        ]


def swept(card: Card, sweep: Sweep) -> list[Column]:
    """A column for each combination of a sweep's parameters, the last one changing fastest."""
    base = card.columns[0]
    combinations: list[dict[str, Any]] = [{}]
    for name, values in sweep.parameters.items():
        combinations = [{**one, name: value} for one in combinations for value in values]
    return [
        Column(str(one), base.planner, {**base.parameters, **one}, base.window)
        for one in combinations
    ]


def _tuples(data: dict[str, Any]) -> dict[str, Any]:
    lists = {key: tuple(value) for key, value in data.items() if isinstance(value, list)}
    return {**data, **lists}


def list_cards() -> list[str]:
    """Names of the cards."""
    return sorted(
        entry.name.removesuffix(".toml")
        for entry in _FOLDER.iterdir()
        if entry.name.endswith(".toml")
    )


def load_card(name: str) -> Card:
    """Read a card.

    Raises:
        CardError: no such card.
    """
    if name not in list_cards():
        raise CardError(unknown("card", name, list_cards()))
    data = tomllib.loads((_FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
    columns = tuple(Column(**column) for column in data.pop("columns"))
    cases = tuple(Case(**_tuples(case)) for case in data.pop("cases"))
    sweeps = tuple(Sweep(**sweep) for sweep in data.pop("sweeps", []))
    measures = tuple(data.pop("measures", []))
    pictures = tuple(Picture(**_tuples(picture)) for picture in data.pop("pictures", []))
    card = Card(
        name=name,
        columns=columns,
        cases=cases,
        sweeps=sweeps,
        measures=measures,
        pictures=pictures,
        **data,
    )
    if card.view not in get_args(View):
        raise CardError(f"card {name}: {unknown('view', card.view, list(get_args(View)))}")
    for picture in card.pictures:
        check_picture(card, picture)
    for measure in card.measures:
        if measure not in MEASURES:
            raise CardError(f"card {name}: {unknown('measure', measure, list(MEASURES))}")
    return card


def check_picture(card: Card, picture: Picture) -> None:
    """Raises CardError for a kind, column or case that does not exist."""
    columns = [column.label for column in card.columns]
    cases = [case.label for case in card.cases]
    for what, names, known in (
        ("picture", (picture.kind,), list(get_args(PictureKind))),
        ("column", picture.columns, columns),
        ("case", picture.cases, cases),
        ("measure", picture.measures, list(card.measures)),
    ):
        for name in names:
            if name not in known:
                raise CardError(f"card {card.name}: {unknown(what, name, known)}")
