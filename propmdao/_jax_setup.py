"""JAX as propmdao needs it: 64-bit floats, and compiled code kept between processes."""

from __future__ import annotations

import os
import tempfile
import warnings
from pathlib import Path

import jax
import platformdirs


def use_64_bit_floats() -> None:
    """Switch JAX to double precision.

    Circulation and phase sums lose the digits that gradients need in single precision.
    """
    jax.config.update("jax_enable_x64", True)


def keep_compiled_code() -> None:
    """Let JAX keep compiled functions in the user's cache folder.

    Compiling is most of the wait of a first analysis. The folder is the platform's own place for
    caches (``~/.cache/propmdao/jax`` on Linux). A cache that the user has chosen, by
    ``JAX_COMPILATION_CACHE_DIR`` or ``jax.config``, is left alone, and where no folder can be
    written nothing is kept. JAX's key of an entry holds its own version and the features of the
    processor, so a home folder shared between machines is safe.
    """
    if jax.config.values["jax_compilation_cache_dir"] or "JAX_COMPILATION_CACHE_DIR" in os.environ:
        return
    folder = Path(platformdirs.user_cache_dir("propmdao", appauthor=False)) / "jax"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):  # permission bits do not tell a read-only disk
            pass
    except OSError:
        return
    jax.config.update("jax_compilation_cache_dir", str(folder))
    # JAX keeps only what took a second to compile; an analysis is many functions below that.
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    # XLA's own caches are for GPU autotuning; without them no further folder is made.
    jax.config.update("jax_persistent_cache_enable_xla_caches", "none")
    # A full disk or an entry cut short costs the time to compile again, nothing else.
    warnings.filterwarnings("ignore", message="Error (reading|writing) persistent compilation")
