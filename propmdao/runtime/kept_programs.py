"""Compiled programs kept whole: a later process loads them and traces nothing.

JAX's own cache (`propmdao.runtime.jax_setup.keep_compiled_code`) is asked for what a function
traces to, and tracing is most of the wait once everything has been compiled. A program kept here is
found by the name of its function, the kinds of its arguments, all source of propmdao, the versions
of what it was made with and the processor. What somebody has changed in a running process is not
seen, so none is kept but where `propmdao.runtime.caches.keep_programs` has been called: by the
command line.
"""

from __future__ import annotations

import dataclasses
import hashlib
import inspect
import os
import pickle
import platform
import shutil
import sys
import threading
import types
import zlib
from collections.abc import Callable, Hashable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import jax
import numpy as np
from jax.experimental.serialize_executable import deserialize_and_load, serialize
from jax.stages import Compiled, Lowered

import propmdao
from propmdao.runtime import linear_algebra
from propmdao.runtime.caches import cache_folder, programs_are_kept
from propmdao.runtime.output_files import OutputError, replacing

_N_SOURCES = 4  # versions of the source whose programs stay on the disk
_DIGEST = hashlib.sha256().digest_size
# Variables of the environment that change what is compiled, and lines of /proc/cpuinfo that tell
# what instructions a processor has.
_SETTINGS = ("JAX_", "XLA_", "PJRT_")
_PROCESSOR = ("model name", "flags", "Features", "CPU implementer", "CPU part")

_programs: dict[Hashable, Compiled | None] = {}
_written = threading.local()


class _NamelessError(Exception):
    """Something has no name that is the same in every process."""


def are_kept() -> bool:
    """Whether this process keeps its programs: where it has been asked to, on processors.

    Returns
    -------
    bool
        Whether `kept_program` is to be asked for programs.
    """
    return programs_are_kept() and jax.default_backend() == "cpu"


def kept_program(
    function: Callable[..., Any],
    fixed: tuple[Hashable, ...],
    arguments: tuple[tuple[Any, ...], dict[str, Any]],
    lower: Callable[[], Lowered],
) -> Compiled | None:
    """Program of a function for arguments of these kinds: in memory, on the disk, or compiled.

    Parameters
    ----------
    function : callable
        Function of a module of propmdao.
    fixed : tuple
        Arguments that are compiled in.
    arguments : (tuple, dict)
        The other ones, by place and by name: numbers and arrays, or their shapes and types.
    lower : callable
        Makes the function ready to be compiled for them.

    Returns
    -------
    jax.stages.Compiled or None
        To be called with `arguments`; None where the program cannot be told from others by names,
        and none is kept.
    """
    key = _key(function, fixed, arguments)
    try:
        return _programs[key]
    except KeyError:
        pass
    try:
        file = _file_of(key)
    except _NamelessError:
        return _programs.setdefault(key, None)
    program = file and _loaded(file, key.tree)
    if not program:
        lowered = lower()
        n_written = _n_written_by_jax()
        program = lowered.compile()
        # What JAX has read from its cache, now or for another function of this process, it cannot
        # write down again: functions would be missing. What it compiles anew it writes there.
        if file and n_written < _n_written_by_jax():
            _keep(file, program)
    return _programs.setdefault(key, program)


def drop_program(
    function: Callable[..., Any],
    fixed: tuple[Hashable, ...],
    arguments: tuple[tuple[Any, ...], dict[str, Any]],
) -> None:
    """Take away a program that does not run, from memory and disk; none is kept in its place.

    Parameters
    ----------
    function, fixed, arguments
        Those that `kept_program` has found it by.
    """
    key = _key(function, fixed, arguments)
    _programs[key] = None
    if file := _file_of(key):
        file.unlink(missing_ok=True)


class _Key(NamedTuple):
    """What a program is found by in this process."""

    function: Callable[..., Any]
    fixed: tuple[Hashable, ...]
    tree: Any
    kinds: tuple[Hashable, ...]


def _key(
    function: Callable[..., Any],
    fixed: tuple[Hashable, ...],
    arguments: tuple[tuple[Any, ...], dict[str, Any]],
) -> _Key:
    leaves, tree = jax.tree.flatten(arguments)
    return _Key(function, fixed, tree, tuple(map(kind_of, leaves)))


def _file_of(key: _Key) -> Path | None:
    """File of a program; None where nothing can be kept, an error where it has no name."""
    named = [_name(key.function), *map(_name, key.fixed), str(key.tree)]
    if " at 0x" in named[-1] or None in key.kinds:
        raise _NamelessError
    return _file(repr((named, key.kinds)).encode())


def kind_of(leaf: Any) -> Hashable:
    """Tell what a program is compiled for of an argument.

    Parameters
    ----------
    leaf : object
        Number, array, or shape and type of one.

    Returns
    -------
    hashable or None
        Shape and type; None for what was put on a device, or is neither.
    """
    if isinstance(leaf, np.ndarray | np.generic | jax.Array | jax.ShapeDtypeStruct):
        return None if getattr(leaf, "committed", False) else (leaf.shape, leaf.dtype)
    return type(leaf).__name__ if isinstance(leaf, bool | int | float | complex) else None


def _name(value: Any) -> str:
    """Name of something that is compiled in: all that makes it what it is."""
    if value is None or isinstance(value, bool | int | float | str):
        return repr(value)
    if isinstance(value, tuple):
        return f"({','.join(map(_name, value))})"
    if isinstance(value, types.ModuleType):
        module, name, is_known = value.__name__, "", True
    elif inspect.isfunction(value) or isinstance(value, type):
        module, name = value.__module__, value.__qualname__
        is_known = getattr(sys.modules.get(module), name, None) is value
    else:
        module, name, is_known = type(value).__module__, type(value).__qualname__, False
        if dataclasses.is_dataclass(value):
            fields = [(f.name, _name(getattr(value, f.name))) for f in dataclasses.fields(value)]
            name, is_known = f"{name}{fields}", True
    if not is_known or module.split(".")[0] != propmdao.__name__:
        raise _NamelessError
    return f"{module}:{name}"


def _file(key: bytes) -> Path | None:
    """File of a program; None where nothing can be kept."""
    folder = cache_folder("programs")
    made_on = _made_on()
    if folder is None or made_on is None:
        return None
    folder = folder / made_on
    with suppress(OSError):
        if not folder.exists():
            folder.mkdir(exist_ok=True)
            others = sorted(folder.parent.iterdir(), key=lambda path: path.stat().st_mtime)
            for old in others[:-_N_SOURCES]:
                shutil.rmtree(old, ignore_errors=True)
    return folder / hashlib.sha256(key).hexdigest()


@cache
def _made_on() -> str | None:
    """Source, versions, settings and processor in one word; None where it is not known."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return None
    processor = sorted({line for line in lines if line.startswith(_PROCESSOR)})
    settings = sorted(item for item in os.environ.items() if item[0].startswith(_SETTINGS))
    versions = [jax.__version__, jax.lib.__version__, np.__version__, platform.python_version()]
    devices = [str(device) for device in jax.devices()]
    digest = hashlib.sha256(repr((processor, settings, versions, devices)).encode())
    for folder, subfolders, files in os.walk(Path(propmdao.__file__).parent, followlinks=True):
        subfolders.sort()
        for name in sorted(name for name in files if name.endswith(".py")):
            path = Path(folder, name)
            digest.update(f"{path.parent.name}/{name}\0".encode() + path.read_bytes())
    return digest.hexdigest()[:32]


def _loaded(file: Path, tree: Any) -> Compiled | None:
    """Program of a file; None where it is not there, or damaged."""
    try:
        content = file.read_bytes()
    except OSError:
        return None
    digest, packed = content[:_DIGEST], content[_DIGEST:]
    if hashlib.sha256(packed).digest() != digest:
        return None
    linear_algebra.load_lapack()
    executable, in_tree, out_tree = pickle.loads(zlib.decompress(packed))
    if in_tree != tree:
        return None
    return deserialize_and_load(executable, in_tree, out_tree)


def _keep(file: Path, program: Compiled) -> None:
    """Write a program to its file, where it can be written down."""
    try:
        packed = zlib.compress(pickle.dumps(serialize(program)), 1)
    except (pickle.PicklingError, AttributeError, TypeError, NotImplementedError):
        return  # what it returns holds functions
    with suppress(OutputError), replacing(file) as new:  # a full disk
        new.write_bytes(hashlib.sha256(packed).digest() + packed)


def _n_written_by_jax() -> int:
    """Number of programs that this thread has compiled and JAX has put into its cache."""
    _count_what_is_written()
    return getattr(_written, "number", 0)


@cache
def _count_what_is_written() -> None:
    def count(event: str, **_: Any) -> None:
        if event == "/jax/compilation_cache/cache_misses":
            _written.number = getattr(_written, "number", 0) + 1

    jax.monitoring.register_event_listener(count)
