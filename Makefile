# `make reproduce` writes the report into report/; `make test` runs the tests. Each makes .venv where there is none.
# `make check` runs formatter, linter and types; `make docs` writes the documentation into site/.
# `make test-lowest` runs the tests of what computes with the lowest versions that pyproject.toml declares, in .venv-lowest.
PYTHON ?= python3
VENV := .venv

.PHONY: reproduce test check docs test-lowest
reproduce: $(VENV)/.installed
	$(VENV)/bin/lagrotor reproduce

test: $(VENV)/.installed-test
	$(VENV)/bin/python -m pytest

check: $(VENV)/.installed-test
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/mypy

docs: $(VENV)/.installed-docs
	$(VENV)/bin/mkdocs build --quiet

LOWEST_ROOMS := algebra mechanics numerics pair theory models
test-lowest: .venv-lowest/.installed
	.venv-lowest/bin/python -m pytest $(LOWEST_ROOMS:%=tests/%)

# sympy>=1.13.0 becomes sympy==1.13.0: the lowest of each, written beside the environment as pip's constraints.
.venv-lowest/.installed: pyproject.toml
	$(PYTHON) -m venv .venv-lowest
	sed -n 's/^dependencies = \[\(.*\)\]/\1/p' pyproject.toml | tr -d '" ' | tr ',' '\n' \
		| sed 's/>=/==/' > .venv-lowest/constraints.txt
	.venv-lowest/bin/python -m pip install --quiet --disable-pip-version-check \
		--constraint .venv-lowest/constraints.txt --editable '.[test]'
	@touch $@

$(VENV)/bin/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml | $(VENV)/bin/python
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[report]'
	@touch $@

$(VENV)/.installed-test: pyproject.toml | $(VENV)/bin/python
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[test]'
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-docs: pyproject.toml | $(VENV)/bin/python
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[docs]'
	@touch $@
