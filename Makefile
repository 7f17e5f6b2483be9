# Everything is built into .venv and target/; nothing outside the checkout is touched.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
WORKERS ?= 2

.DEFAULT_GOAL := help
.PHONY: help setup demo leaderboard test check format bench clean

help: ## list the verbs
	@awk -F':.*## ' '/^[a-z-]+:.*## / {printf "  make %-11s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

$(BIN)/uv:
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check uv

RUST := $(shell find rust -name '*.rs' -o -name Cargo.toml) Cargo.toml Cargo.lock

$(VENV)/.demo: $(BIN)/uv pyproject.toml $(RUST)
	$(BIN)/uv pip install --quiet --python $(BIN)/python -e '.[report,render]'
	@touch $@

$(VENV)/.dev: $(BIN)/uv pyproject.toml $(RUST)
	$(BIN)/uv pip install --quiet --python $(BIN)/python -e '.[dev]'
	@touch $@ $(VENV)/.demo

setup: $(VENV)/.dev ## build the engine and install everything that development needs into .venv

demo: $(VENV)/.demo ## run the small leaderboard: a ranked table and results/demo/leaderboard.html
	$(BIN)/auvgym leaderboard --suite demo --fresh --workers $(WORKERS) --out results/demo

BOARDS ?=

leaderboard: $(VENV)/.dev ## fly the published boards (BOARDS=demo: that one) and write baselines/board
	$(BIN)/python baselines/board/make_board.py $(BOARDS) --workers $(WORKERS)

test: $(VENV)/.dev ## Rust and Python tests
	cargo test --workspace --quiet
	$(BIN)/python -m pytest

check: $(VENV)/.dev ## linters and type checkers, as in CI
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --quiet -- -D warnings
	cargo clippy --workspace --lib --quiet -- -D warnings -D clippy::expect_used
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest auvgym._core --allowlist tests/stubtest-allowlist.txt

format: $(VENV)/.dev ## format Rust and Python
	cargo fmt --all
	$(BIN)/ruff check --fix-only --quiet .
	$(BIN)/ruff format .

bench: $(VENV)/.dev ## benchmarks of engine, planners and environment steps
	cargo bench --workspace
	$(BIN)/python -m pytest benches --benchmark-only --benchmark-columns=min,median,mean,rounds

clean: ## remove what was built
	rm -rf $(VENV) target results
