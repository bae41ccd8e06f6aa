"""Programs that are kept whole: found again by name, and only where the name says all."""

import os
import subprocess
import sys

import jax
import numpy as np
import pytest
from jax.experimental.compilation_cache import compilation_cache

import propmdao
from propmdao.acoustics.levels.decibels import level_db
from propmdao.records.fidelity import Fidelity
from propmdao.runtime import caches, kept_programs
from propmdao.runtime.compilation import compiled


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Folder in which this process keeps its programs."""
    monkeypatch.setenv(caches.FOLDER_VARIABLE, str(tmp_path))
    monkeypatch.setitem(caches._of_process, "programs", True)
    monkeypatch.setattr(kept_programs, "_programs", {})
    before = jax.config.jax_compilation_cache_dir
    compilation_cache.set_cache_dir(str(tmp_path / "jax"))
    compilation_cache.reset_cache()
    jax.clear_caches()  # of what other tests have compiled
    yield tmp_path / "programs"
    compilation_cache.set_cache_dir(before)
    compilation_cache.reset_cache()


def files_in(folder):
    return [file for file in folder.rglob("*") if file.is_file()]


@pytest.fixture
def traced():
    """Names of the functions that JAX traces."""
    names = []

    def listen(event, duration, fun_name="", **_):
        if event.endswith("jaxpr_trace_duration"):
            names.append(fun_name)

    jax.monitoring.register_event_duration_secs_listener(listen)
    yield names
    jax.monitoring.unregister_event_duration_listener(listen)


def test_loaded_without_a_trace(folder, monkeypatch, traced):
    power = np.linspace(1.0, 2.0, 31)
    level = level_db(power)
    assert len(files_in(folder)) == 1 and "level_db" in traced
    monkeypatch.setattr(kept_programs, "_programs", {})
    jax.clear_caches()
    traced.clear()
    assert np.array_equal(level_db(power), level)
    assert "level_db" not in traced


def test_what_jax_has_read_from_its_cache_is_not_kept(folder, monkeypatch):
    level = level_db(np.ones(31))
    (file,) = files_in(folder)
    file.unlink()
    monkeypatch.setattr(kept_programs, "_programs", {})
    jax.clear_caches()
    assert np.array_equal(level_db(np.ones(31)), level)
    assert not files_in(folder)


def test_what_jax_has_in_memory_from_its_cache_is_not_kept(folder, monkeypatch):
    # Read by another part of the process, without this one's knowledge.
    level = level_db(np.ones(31))
    (file,) = files_in(folder)
    file.unlink()
    jax.clear_caches()
    monkeypatch.setitem(caches._of_process, "programs", False)
    level_db(np.ones(31))
    monkeypatch.setitem(caches._of_process, "programs", True)
    monkeypatch.setattr(kept_programs, "_programs", {})
    assert np.array_equal(level_db(np.ones(31)), level)
    assert not files_in(folder)


def test_a_program_that_does_not_run_is_taken_away(folder, monkeypatch):
    level = level_db(np.ones(31))
    (key,) = kept_programs._programs

    def broken(*_, **__):
        raise jax.errors.JaxRuntimeError("NOT_FOUND: Function fusion not found")

    monkeypatch.setattr(kept_programs, "_programs", {key: broken})
    assert np.array_equal(level_db(np.ones(31)), level)
    assert not files_in(folder)
    assert np.array_equal(level_db(np.ones(31)), level)


def test_each_kind_of_argument_has_its_program(folder):
    for power in (np.ones(31), np.ones((31, 1)), np.ones(31, np.float32), 1, True):
        level_db(power)
    assert len(files_in(folder)) == 5


def test_a_damaged_file_is_passed_over(folder, monkeypatch):
    level = level_db(np.ones(31))
    (file,) = files_in(folder)
    content = file.read_bytes()
    file.write_bytes(content[:-1])
    monkeypatch.setattr(kept_programs, "_programs", {})
    assert kept_programs._loaded(file, jax.tree.structure(((1.0,), {}))) is None
    assert np.array_equal(level_db(np.ones(31)), level)


def test_what_has_no_name_is_compiled_and_not_kept(folder):
    @compiled
    def doubled(x):
        return 2.0 * x

    assert doubled(np.float64(2.0)) == 4.0
    on_a_device = jax.device_put(np.ones(31), jax.devices()[0])
    assert level_db(on_a_device).shape == (31,)
    assert not files_in(folder)


def test_names_say_all_that_is_compiled_in():
    name = kept_programs._name
    assert name(Fidelity()) != name(Fidelity(n_spanwise=25))
    assert name((1, "1", None)) != name((1, 1, None))
    assert name(kept_programs).endswith("kept_programs:")
    assert name(level_db) == "propmdao.acoustics.levels.decibels:level_db"
    for nameless in (lambda: 0, test_loaded_without_a_trace, np.ones(3), object(), np.sum):
        with pytest.raises(kept_programs._NamelessError):
            name(nameless)


def test_other_source_other_programs(tmp_path, monkeypatch):
    monkeypatch.setattr(propmdao, "__file__", str(tmp_path / "__init__.py"))
    (tmp_path / "inner").mkdir()
    source = tmp_path / "inner" / "physics.py"
    made_on = kept_programs._made_on.__wrapped__
    source.write_text("PI = 3\n")
    first = made_on()
    assert made_on() == first
    source.write_text("PI = 4\n")
    assert made_on() != first


def test_programs_of_few_sources_stay(folder, monkeypatch):
    for number in range(9):
        monkeypatch.setattr(kept_programs, "_made_on", lambda number=number: f"source {number}")
        monkeypatch.setattr(kept_programs, "_programs", {})
        level_db(np.ones(31 + number))
        file = files_in(folder / f"source {number}")[0]
        os.utime(file.parent, (number, number))
    kept = {path.name for path in folder.iterdir()}
    assert kept == {f"source {number}" for number in range(5, 9)}


SOLVES = """
import numpy as np
from propmdao.runtime import caches, compilation, linear_algebra
caches.keep_programs()
linear_algebra.solve = compilation.compiled(linear_algebra.solve)
print(linear_algebra.solve(np.array([[0.0, 2.0], [4.0, 0.0]]), np.ones(2)).tolist())
"""


def test_another_process_solves_with_a_program_that_it_did_not_trace(tmp_path):
    # It calls LAPACK, which JAX makes ready when it traces.
    environment = {**os.environ, caches.FOLDER_VARIABLE: str(tmp_path)}
    written = []
    for _ in range(2):
        run = subprocess.run(
            [sys.executable, "-c", SOLVES], env=environment, capture_output=True, text=True
        )
        assert run.stdout == "[0.25, 0.5]\n", run.stderr
        (file,) = files_in(tmp_path / "programs")
        written.append(file.stat().st_mtime_ns)
    assert written[0] == written[1]
