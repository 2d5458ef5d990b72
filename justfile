# Shortcuts; every recipe is one cargo line, so nothing is lost without `just`.

# Solve the embedded example: the paper's N = 64 surface.
example:
    cargo run --release -p rc-cli -- solve

# All tests.
test:
    cargo xtask test

# What continuous integration runs: format, lints, docs, tests.
ci:
    cargo xtask ci

# Arrows, paper map, snapshots, links.
tidy:
    cargo xtask tidy

# The Python package: built, installed below target/, tested.
python:
    cargo xtask python

# Every figure of the paper, at full size.
figures:
    cargo xtask figures

# Run time against error on ten scenes.
bench:
    cargo xtask bench

# The documentation of all crates.
doc:
    cargo doc --release --workspace --no-deps --all-features --open
