"""JAX as propmdao needs it: 64-bit floats, compiled code kept, linear algebra without threads."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

import jax
import threadpoolctl

from propmdao.runtime.caches import cache_folder


def use_64_bit_floats() -> None:
    """Switch JAX to double precision.

    Circulation and phase sums lose the digits that gradients need in single precision.
    """
    jax.config.update("jax_enable_x64", True)


def keep_compiled_code() -> None:
    """Let JAX keep compiled functions in the user's cache folder.

    Compiling is most of the wait of a first analysis. The folder is ``jax`` in that of
    `propmdao.runtime.caches.cache_folder` (``~/.cache/propmdao`` on Linux). A cache that the user
    has chosen, by ``JAX_COMPILATION_CACHE_DIR`` or ``jax.config``, is left alone, and where no
    folder can be written nothing is kept. JAX's key of an entry holds its own version and the
    features of the processor, so a home folder shared between machines is safe.
    """
    if jax.config.values["jax_compilation_cache_dir"] or "JAX_COMPILATION_CACHE_DIR" in os.environ:
        return
    folder = cache_folder("jax")
    if folder is None:
        return
    jax.config.update("jax_compilation_cache_dir", str(folder))
    # JAX keeps only what took a second to compile; an analysis is many functions below that.
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    # XLA's own caches are for GPU autotuning; without them no further folder is made.
    jax.config.update("jax_persistent_cache_enable_xla_caches", "none")
    # A full disk or an entry cut short costs the time to compile again, nothing else.
    warnings.filterwarnings("ignore", message="Error (reading|writing) persistent compilation")


def factorise_on_one_thread() -> None:
    """Keep the library that factorises JAX's matrices from starting threads.

    JAX calls the LAPACK inside SciPy. For the few hundred unknowns of a lattice its threads gain
    nothing, and beside another busy process they wait for each other: 140 ms instead of 0.7 ms for
    192 unknowns. Only SciPy's own copy is told so, NumPy's keeps its threads; a number of threads
    that the user has set in the environment is left alone.
    """
    if os.environ.get("OPENBLAS_NUM_THREADS") or os.environ.get("OMP_NUM_THREADS"):
        return
    import scipy.linalg.cython_lapack  # noqa: F401 - what JAX loads it by

    libraries = threadpoolctl.ThreadpoolController()
    scipys_own = [
        path
        for path in (library["filepath"] for library in libraries.info())
        # In wheels: scipy.libs/ for Linux and Windows, scipy/.dylibs/ for macOS.
        if any(part.startswith("scipy") for part in Path(path).parts[-3:-1])
    ]
    libraries.select(filepath=scipys_own).limit(limits=1)


use_64_bit_floats()
keep_compiled_code()
factorise_on_one_thread()
