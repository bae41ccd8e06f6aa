"""Importing what computes sets JAX up, leaves the user's choices alone and prints nothing."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from propmdao.runtime.caches import FOLDER_VARIABLE

CODE = """
import propmdao.{room}, jax, jax.numpy as jnp
print(jnp.ones(1).dtype, jax.config.values["jax_compilation_cache_dir"])
jax.jit(lambda x: jnp.linalg.solve(x, x))(jnp.eye(3) + 1.0).block_until_ready()
"""


def import_room(room: str, **environment: str | Path) -> str:
    """Cache folder after the import, in a process of its own that compiles once.

    Each test begins with another room: whichever is imported first sets JAX up.
    """
    surroundings = {
        key: value
        for key, value in os.environ.items()
        if not key.startswith("JAX_") and key not in ("XDG_CACHE_HOME", FOLDER_VARIABLE)
    }
    result = subprocess.run(
        [sys.executable, "-c", CODE.format(room=room)],
        env=surroundings | {key: str(value) for key, value in environment.items()},
        capture_output=True,
        text=True,
        check=True,
    )
    assert result.stderr == ""
    dtype, _, folder = result.stdout.strip().partition(" ")
    assert dtype == "float64"
    return folder


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Home of a cache that a process has filled, and the folder that it said."""
    home = tmp_path_factory.mktemp("cache")
    return home, Path(import_room("aerodynamics", XDG_CACHE_HOME=home))


@pytest.mark.skipif(sys.platform != "linux", reason="the cache's place is that of Linux")
def test_compiled_code_is_kept_and_read_back_without_a_word(kept: tuple[Path, Path]) -> None:
    home, folder = kept
    assert folder == home / "propmdao" / "jax"
    entries = sorted(folder.iterdir())
    assert entries
    import_room("aerodynamics", XDG_CACHE_HOME=home)
    assert sorted(folder.iterdir()) == entries


def test_an_unusable_home_keeps_nothing_and_says_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    unusable = tmp_path / "file" / "home"
    assert import_room("records.pytrees", HOME=unusable, XDG_CACHE_HOME=unusable) == "None"


def test_the_users_own_cache_stays(tmp_path: Path) -> None:
    folder = import_room("acoustics", JAX_COMPILATION_CACHE_DIR=tmp_path / "mine")
    assert Path(folder) == tmp_path / "mine"


def test_a_cache_entry_cut_short_costs_no_more_than_compiling(
    kept: tuple[Path, Path], tmp_path: Path
) -> None:
    home, folder = kept
    copied = tmp_path / "home"
    shutil.copytree(home, copied)
    entries = list((copied / folder.relative_to(home)).iterdir())
    assert entries
    for entry in entries:
        entry.write_bytes(entry.read_bytes()[:20])
    import_room("geometry", XDG_CACHE_HOME=copied)


def test_only_the_blas_that_jax_factorises_with_loses_its_threads() -> None:
    code = """
import os, numpy, scipy.linalg, threadpoolctl
def threads():
    return {
        os.path.basename(os.path.dirname(library["filepath"])): library["num_threads"]
        for library in threadpoolctl.threadpool_info()
    }
before = threads()
import propmdao.runtime.jax_setup
if {"scipy.libs", "numpy.libs"} <= set(before):
    assert threads() == before | {"scipy.libs": 1}, (before, threads())
else:
    print("no BLAS of their own")
"""
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    if result.stdout:
        pytest.skip("SciPy and NumPy do not bring a BLAS of their own here")
