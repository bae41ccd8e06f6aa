"""What is kept in the user's cache folder is made once, and again where it is damaged."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from propmdao.runtime.caches import FOLDER_VARIABLE, cache_folder, kept_arrays

Made = dict[str, npt.NDArray]


@pytest.fixture
def make(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[], Made]:
    """Make arrays that tell how often it was asked to; its attribute n is that number."""
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "caches"))

    def make() -> Made:
        make.n += 1  # type: ignore[attr-defined]
        return {"how often": np.array([make.n]), "b": np.arange(6.0).reshape(2, 3)}  # type: ignore[attr-defined]

    make.n = 0  # type: ignore[attr-defined]
    return make


def test_arrays_are_made_once_for_a_key(make: Callable[[], Made]) -> None:
    found = [int(kept_arrays("a", key, make)["how often"][0]) for key in (b"1", b"1", b"2", b"1")]
    assert found == [1, 1, 2, 1]
    np.testing.assert_array_equal(kept_arrays("a", b"1", make)["b"], [[0, 1, 2], [3, 4, 5]])
    assert int(kept_arrays("another", b"1", make)["how often"][0]) == 3


def test_a_damaged_file_is_made_again(make: Callable[[], Made]) -> None:
    kept_arrays("a", b"1", make)
    folder = cache_folder("a")
    assert folder is not None
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    damaged = [b"", b"no archive", whole[:100], whole[:-1], whole + b" "]
    for place in range(0, len(whole), 20):
        damaged.append(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
    for n, content in enumerate(damaged, start=2):
        file.write_bytes(content)
        assert [int(kept_arrays("a", b"1", make)["how often"][0]) for _ in range(2)] == [n, n]


def test_where_nothing_can_be_written_nothing_is_kept(
    make: Callable[[], Made], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "file"))
    assert cache_folder("a") is None
    assert [int(kept_arrays("a", b"1", make)["how often"][0]) for _ in range(2)] == [1, 2]
