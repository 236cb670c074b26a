# `make reproduce` writes the report into report/; `make test` runs the tests. Each makes .venv where there is none.
PYTHON ?= python3
VENV := .venv

.PHONY: reproduce test
reproduce: $(VENV)/.installed
	$(VENV)/bin/lagrotor reproduce

test: $(VENV)/.installed-test
	$(VENV)/bin/python -m pytest

$(VENV)/bin/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml | $(VENV)/bin/python
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[report]'
	@touch $@

$(VENV)/.installed-test: pyproject.toml | $(VENV)/bin/python
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[test]'
	@touch $@ $(VENV)/.installed
