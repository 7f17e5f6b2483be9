"""The package as a whole: what importing it costs and promises."""

from __future__ import annotations

import ast
import importlib.metadata
import re
from collections.abc import Iterator
from pathlib import Path

import fresh_python
import gymnasium
import pytest

import auvgym

ENVIRONMENTS = [
    "AUVDynamic2D-v0",
    "AUVDynamic3D-v0",
    "AUVHarbor2D-v0",
    "AUVStatic3D-v0",
    "AUVThreat3D-v0",
]
ROOT = Path(__file__).parents[1]
HEAVY = [
    "torch",
    "polars",
    "onnxruntime",
    "xarray",
    "pygame",
    "plotly",
    "ray",
    "scipy",
    "pyproj",
    "netCDF4",
    "stable_baselines3",
    "pandas",
    "matplotlib",
]


def python(code: str) -> str:
    """What a fresh interpreter prints, with warnings as errors."""
    found = fresh_python.run(code)
    assert found.returncode == 0, found.stderr
    return found.stdout.strip()


def test_importing_pulls_in_nothing_heavy() -> None:
    code = "import sys, auvgym; print(*sorted(m.partition('.')[0] for m in sys.modules))"
    assert not set(HEAVY) & set(python(code).split())


def test_flying_and_planning_pull_in_nothing_heavy() -> None:
    code = """
import sys, gymnasium
env = gymnasium.make("auvgym:AUVDynamic3D-v0")
env.reset(seed=0)
env.step(env.action_space.sample())
import auvgym
auvgym.plan(env.unwrapped.world, "lfhh", generations=1)
auvgym.policies.make("straight").reset(env)
print(*sorted(m.partition('.')[0] for m in sys.modules))
"""
    assert not set(HEAVY) & set(python(code).split())


@pytest.mark.parametrize("env_id", ENVIRONMENTS)
def test_gymnasium_makes_environments_without_an_import(env_id: str) -> None:
    code = f"""
import gymnasium
print(gymnasium.make("auvgym:{env_id}").reset(seed=3)[0].tobytes())
"""
    assert python(code) == str(gymnasium.make(env_id).reset(seed=3)[0].tobytes())


def test_importing_twice_registers_once() -> None:
    code = """
import gymnasium, importlib, auvgym
importlib.reload(auvgym)
print(sorted(name for name in gymnasium.registry if name.startswith("AUV")))
"""
    assert python(code) == str(ENVIRONMENTS)


def test_the_version_is_that_of_the_distribution() -> None:
    assert auvgym.__version__ == importlib.metadata.version("auvgym")


def test_every_public_name_is_there() -> None:
    assert dir(auvgym) == sorted(auvgym.__all__)
    for name in auvgym.__all__:
        assert getattr(auvgym, name) is not None
    with pytest.raises(AttributeError, match="module 'auvgym' has no attribute 'wrold'"):
        auvgym.wrold  # noqa: B018
    for error in (auvgym.ScenarioError, auvgym.ActionError, auvgym.PlanningError):
        assert issubclass(error, ValueError)
        assert error.__module__ == "auvgym"
        assert error.__doc__


def test_the_package_is_typed_and_has_its_scenarios() -> None:
    folder = Path(auvgym.__file__).parent
    assert (folder / "py.typed").is_file()
    assert (folder / "_core.pyi").is_file()
    shipped = {path.stem for path in (folder / "scenarios").glob("*.toml")}
    assert shipped == set(auvgym.list_scenarios()) != set()


def files(*suffixes: str, under: tuple[str, ...]) -> Iterator[Path]:
    for folder in under:
        for path in sorted((ROOT / folder).rglob("*")):
            # Files of the checkout only: nothing hidden, nothing built.
            inside = path.relative_to(ROOT).parts
            built = {"__pycache__", "target", "results", "node_modules"}
            hidden = any(part.startswith(".") or part in built for part in inside)
            if path.is_file() and path.suffix in suffixes and not hidden:
                yield path


def imports(path: Path) -> Iterator[str]:
    """Every module that a Python file imports, with what it takes from it."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            yield f"{node.value.id}.{node.attr}"


def test_nobody_outside_the_package_uses_the_engine_directly() -> None:
    outside = list(files(".py", under=("tests", "examples", "benches", "baselines")))
    assert len(outside) > 10
    guilty = {
        str(path.relative_to(ROOT))
        for path in outside
        if any(name.startswith("auvgym._core") for name in imports(path))
    }
    assert guilty == set()


def test_no_file_knows_where_it_was_written() -> None:
    # Somebody's own folders: home directories.
    workplace = re.compile(r"(?<![\w.~/-])/(?:home|Users)/\w+/\w")
    kinds = (".py", ".pyi", ".rs", ".toml", ".md", ".txt", ".css", ".js", ".yml", ".yaml")
    folders = ("auvgym", "rust", "tests", "benches", "examples", "docs", "baselines")
    found = {}
    for path in [
        *files(*kinds, under=folders),
        *ROOT.glob("*.md"),
        *ROOT.glob("*.toml"),
        ROOT / "Makefile",
    ]:
        if path != Path(__file__):
            hit = workplace.search(path.read_text(encoding="utf-8"))
            if hit:
                found[str(path.relative_to(ROOT))] = hit.group()
    assert found == {}
    assert workplace.search("see /home/ann/main")
    assert not workplace.search("homework/main, ../home/ann/main, https://a.b/home/ann/x")
