"""Progress reports, Ctrl-C and threads during a solve."""

from __future__ import annotations

import os
import signal
import threading
import time

import numpy as np
import pytest
from exact_solves import EHMCS, check, free_solve, reference_solve
from smooth_motions import smooth_path

import armik_sym as ak


@pytest.fixture(scope="module")
def reference():
    return reference_solve()


@pytest.fixture(scope="module")
def free():
    return free_solve()


def test_progress_tells_stages_and_iterations(free):
    path, unlimited = free
    seen: list[ak.Progress] = []
    limit = 0.9 * unlimited.max_speed.max()
    solution = ak.solve(EHMCS, path, max_speed=limit, progress=seen.append)
    stages = list(dict.fromkeys(report.stage for report in seen))
    assert stages == ["first guess", "exact tracking", "speed and acceleration limits"]
    counted = [report.iteration for report in seen if report.stage == "exact tracking"]
    assert counted == list(range(len(counted)))
    limited = [report.violation for report in seen if report.stage == stages[-1]]
    assert limited[0] > 1e-3
    assert limited[-1] < 1e-6
    assert solution.iterations == len(seen) - 3


class StopError(Exception):
    pass


@pytest.mark.parametrize("kind", [StopError, KeyboardInterrupt])
@pytest.mark.parametrize("stage", ["first guess", "exact tracking"])
def test_an_exception_in_the_callback_comes_out_and_the_handler_is_restored(reference, kind, stage):
    path = reference[0]
    handler = signal.getsignal(signal.SIGINT)
    calls = []

    def stop(report):
        calls.append(report)
        if report.stage == stage and (report.iteration == 2 or stage == "first guess"):
            raise kind("enough")

    with pytest.raises(kind, match="enough"):
        ak.solve(EHMCS, path, progress=stop)
    assert calls[-1].stage == stage
    assert signal.getsignal(signal.SIGINT) is handler
    check(ak.solve(EHMCS, path))


@pytest.mark.skipif(os.name == "nt", reason="os.kill sends no SIGINT to a thread of this process")
@pytest.mark.parametrize("stage", ["first guess", "exact tracking"])
def test_ctrl_c_ends_a_long_solve_soon(stage):
    path, _ = smooth_path(EHMCS, 1200, seed=1)
    handler = signal.getsignal(signal.SIGINT)
    reached, interrupted_at = threading.Event(), []

    def press():
        assert reached.wait(60)
        interrupted_at.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    def note(report):
        if report.stage == stage:
            reached.set()

    thread = threading.Thread(target=press)
    thread.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            ak.solve(EHMCS, path, progress=note)
    finally:
        reached.set()
        thread.join()
    assert time.monotonic() - interrupted_at[0] < 5
    assert signal.getsignal(signal.SIGINT) is handler


def test_solving_in_other_threads(reference):
    path, _, expected = reference
    found = [None, None]

    def work(i):
        found[i] = ak.solve(EHMCS, path)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for solution in found:
        assert np.array_equal(check(solution).q, expected.q)
