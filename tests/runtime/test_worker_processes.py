"""Workers: results in order, what has not begun is cancelled, one thread each, no orphans."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from propmdao.runtime.worker_processes import WorkerLostError, results_in_order, start_workers


def test_results_come_in_the_order_of_what_was_asked() -> None:
    second_done = threading.Event()

    def function(i: int) -> int:
        if i == 0:
            assert second_done.wait(timeout=60.0)
        else:
            second_done.set()
        return i

    with ThreadPoolExecutor(2) as executor:
        assert list(results_in_order(executor, function, range(5))) == list(range(5))


def test_who_stops_reading_cancels_what_has_not_begun() -> None:
    begun, go_on = [], threading.Event()

    def function(i: int) -> int:
        begun.append(i)
        if i == 1:
            assert go_on.wait(timeout=60.0)
        return i

    with ThreadPoolExecutor(1) as executor:
        results = results_in_order(executor, function, range(100))
        assert next(results) == 0
        results.close()
        go_on.set()
    assert len(begun) <= 2


def test_an_executor_without_a_result_is_a_lost_worker() -> None:
    with ThreadPoolExecutor(1) as executor:
        executor.shutdown()
        with pytest.raises(WorkerLostError, match="RuntimeError: cannot schedule new futures"):
            list(results_in_order(executor, abs, [1]))


def test_workers_compute_on_one_thread() -> None:
    # numpy, for a BLAS to be loaded
    n_threads = "[lib['num_threads'] for lib in __import__('threadpoolctl').threadpool_info()]"
    with start_workers(1, {"PROPMDAO_TEST": "set"}) as executor:
        assert set(executor.submit(eval, f"__import__('numpy') and {n_threads}").result()) == {1}
        assert executor.submit(os.getenv, "PJRT_NPROC").result() == "1"  # XLA's
        assert executor.submit(os.getenv, "PROPMDAO_TEST").result() == "set"


def test_workers_end_with_the_process_that_started_them_even_when_it_is_killed() -> None:
    script = (
        "import os, signal\n"
        "from propmdao.runtime.worker_processes import start_workers\n"
        "executor = start_workers(2)\n"
        "print(executor.submit(os.getpid).result(), flush=True)\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    # As -c, which workers need not import.
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    # The pipes close, and run returns, when the last worker has ended; it would wait for ever.
    result = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, timeout=60
    )
    assert result.returncode == -signal.SIGKILL and int(result.stdout) > 0
