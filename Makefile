# Each target installs what it needs. Required: Python >= 3.11 with venv and pip, and make.
PYTHON ?= python3

BIN := .venv/bin
# Compiled when it is first imported, and kept: most of what is installed never is, and tests start Python many times.
PIP := $(BIN)/python -m pip --disable-pip-version-check install --quiet --no-compile --constraint constraints.txt
unexport PYTHONDONTWRITEBYTECODE

.PHONY: run play test lint format lists pictures gallery bench wheel clean

run: .venv/ready
	@mkdir -p out
	$(BIN)/sandbox run golf --poster out/golf.png
	@echo "next, change a number: $(BIN)/sandbox run golf --set launch.speed='150 mph' --poster out/golf.png"

play: .venv/ready
	$(BIN)/sandbox play

test: .venv/ready-dev
	$(BIN)/python -m pytest --numprocesses=auto --dist=worksteal $(PYTEST_OPTIONS)

lint: .venv/ready-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy --num-workers=auto

format: .venv/ready-dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

# What follows from the code: the schemas by which editors complete and check scene files, and lists in pages.
lists: .venv/ready
	$(BIN)/python -m docs.lists

pictures: .venv/ready-dev
	$(BIN)/python docs/pictures/make.py
	$(BIN)/python -m docs.pictures.make_browser

# Every scene and preset as poster and page: two minutes.
gallery: .venv/ready
	$(BIN)/python -m sandbox.page.gallery out/gallery

# Comparisons with other libraries, into benchmarks/results.md: twenty minutes on an idle machine.
bench: .venv/ready-dev .venv/pooltool/ready
	$(BIN)/python benchmarks/page.py

wheel: .venv/ready-dev
	$(BIN)/python -m pip --disable-pip-version-check wheel --quiet --no-deps --no-build-isolation --wheel-dir dist .
	@ls dist/*.whl

clean:
	rm -rf .venv out build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis

# Stamps: packages are installed again only when the dependencies change.
.venv/ready: EXTRAS := lab,test
.venv/ready-dev: EXTRAS := dev
.venv/ready .venv/ready-dev: pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit("Python >= 3.11 is needed, this is %d.%d: make PYTHON=python3.12 ..." % sys.version_info[:2] if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv .venv
	$(PIP) --editable '.[$(EXTRAS)]'
	@touch .venv/ready $@

# pooltool's pinned versions conflict with ours: it gets its own environment, without its pins.
.venv/pooltool/ready: | .venv/ready-dev
	$(BIN)/python -m venv .venv/pooltool
	.venv/pooltool/bin/python -m pip --disable-pip-version-check install --quiet panda3d==1.10.15 "numba<0.62" \
		panda3d-gltf panda3d-simplepbr scipy attrs cattrs msgpack msgpack-numpy pyyaml click pillow h5py h11 "rich<15" \
		numpy-quaternion
	.venv/pooltool/bin/python -m pip --disable-pip-version-check install --quiet --no-deps pooltool-billiards==0.6.0
	@touch $@
