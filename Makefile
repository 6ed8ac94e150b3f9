# Two commands do everything: `make demo` and `make test`.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# Byte code is made on first import instead of for every file of every package: a minute less.
# So it has to be kept: without it each of the many processes of the tests compiles what it imports.
export PYTHONDONTWRITEBYTECODE =
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile

.PHONY: checked demo docs install test test-long tested

install: $(VENV)/.installed

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml | $(BIN)/python
	$(PIP) --editable .
	touch $@

$(VENV)/.installed-test: pyproject.toml | $(BIN)/python
	$(PIP) --editable ".[test]"
	touch $(VENV)/.installed $@

demo: $(VENV)/.installed
	$(BIN)/bulkcal demo

# The banner of the theme's authors says nothing about our pages. Without its words (--quiet) mkdocs
# does not see warnings, and --strict nothing to refuse.
docs: export NO_MKDOCS_2_WARNING = 1
docs: $(VENV)/.installed-test
	$(BIN)/mkdocs build

test: $(VENV)/.installed-test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	@$(MAKE) --no-print-directory --jobs=2 checked tested

# Side by side, since types take one core for a minute.
checked:
	$(BIN)/mypy
	$(BIN)/lint-imports

tested:
	$(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder -m "not long"

# What takes a core half a minute or more each: before a release, and after a change of what it looks at.
test-long: $(VENV)/.installed-test
	$(BIN)/python -m pytest -n 2 --dist load -m long
