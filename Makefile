# `make reproduce` writes the report into report/; `make test` runs the tests. Each makes .venv where there is none.
# `make check` runs formatter, linter and types; `make docs` writes the documentation into site/.
# `make test-machines` runs the tests as they run elsewhere: other kernels of linear algebra, numpy without its vector features,
# other hash seeds, the lowest dependencies, the extras, other Pythons; `make test-machines RUNS="Prescott extras"` some of it.
# `make test-wheel` tries the wheel in dist/, made where there is none, in an empty environment of PYTHON.
# `make reader` builds the reader's edition, a folder that a browser opens from disk, into reader/ (npm, node);
# `make test-reader` opens it in Chromium without a network and asks it.
# `make test-pages` opens every page of the report and the documentation in Chromium, on a desk, on a phone and on paper.
# `make certify` writes a proof of every exact verdict into certificates/ and checks each with Coq (Debian: coq libcoq-interval).
PYTHON ?= python3
VENV := .venv

.PHONY: reproduce test check docs certify test-machines test-pages test-wheel reader test-reader
reproduce: $(VENV)/.installed
	$(VENV)/bin/lagrotor reproduce

test: $(VENV)/.installed-test
	$(VENV)/bin/python -m pytest

check: $(VENV)/.installed-test
	$(VENV)/bin/ruff check .
	$(VENV)/bin/ruff format --check .
	$(VENV)/bin/mypy

docs: $(VENV)/.installed-docs reproduce
	$(VENV)/bin/python -m sphinx -W --keep-going docs site

certify: $(VENV)/.installed
	$(VENV)/bin/python -m lagrotor audit --certify certificates > /dev/null
	$(VENV)/bin/python -m lagrotor certify certificates

# Needs a Chromium.
test-pages: docs
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[pages]'
	$(VENV)/bin/python -m tests.pages

reader: $(VENV)/.installed
	$(VENV)/bin/python docs/edition/build.py reader

test-reader: reader
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[pages]'
	$(VENV)/bin/python -m tests.reader reader

# From an empty folder, so that nothing of the sources is seen.
test-wheel:
	ls dist/*.whl > /dev/null 2>&1 || { $(PYTHON) -m venv .venv-build && .venv-build/bin/python -m pip install --quiet \
		--disable-pip-version-check build && .venv-build/bin/python -m build --wheel > /dev/null; }
	rm -rf .venv-wheel && $(PYTHON) -m venv .venv-wheel
	.venv-wheel/bin/python -m pip install --quiet --disable-pip-version-check "$$(ls dist/*.whl)[report]"
	cd .venv-wheel && bin/lagrotor --version && bin/lagrotor rate --spins 10 -10 && bin/lagrotor judge "sin(x)**2 + cos(x)**2 = 1" \
		&& bin/lagrotor audit 5.22 > /dev/null && bin/lagrotor init my-paper && bin/lagrotor audit --paper my-paper

test-machines:
	$(PYTHON) -m tests.machines $(RUNS)

# sympy>=1.13.0 becomes sympy==1.13.0: the lowest of each, written beside the environment as pip's constraints.
.venv-lowest/.installed: pyproject.toml
	$(PYTHON) -m venv .venv-lowest
	sed -n 's/^dependencies = \[\(.*\)\]/\1/p' pyproject.toml | tr -d '" ' | tr ',' '\n' \
		| sed 's/>=/==/' > .venv-lowest/constraints.txt
	.venv-lowest/bin/python -m pip install --quiet --disable-pip-version-check \
		--constraint .venv-lowest/constraints.txt --editable '.[test]'
	@touch $@

.venv-extras/.installed: pyproject.toml
	$(PYTHON) -m venv .venv-extras
	.venv-extras/bin/python -m pip install --quiet --disable-pip-version-check --editable '.[test,fast,notebook,proof,cluster]'
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
