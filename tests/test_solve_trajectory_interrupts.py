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


def test_progress_tells_the_stages_of_the_swivel_map(reference):
    seen: list[ak.Progress] = []
    ak.solve(EHMCS, reference[0], progress=seen.append)
    stages = list(dict.fromkeys(report.stage for report in seen))
    assert stages == ["swivel map", "global path", "one curve"]
    assert [report.iteration for report in seen[:3]] == [0, 0, 0]


class StopError(Exception):
    pass


STAGES = [
    ("swivel", "swivel map", 0),
    ("swivel", "global path", 0),
    ("swivel", "one curve", 0),
    ("swivel", "one curve", 1),
    ("full-space", "first guess", 0),
    ("full-space", "exact tracking", 2),
]


@pytest.mark.parametrize("kind", [StopError, KeyboardInterrupt])
@pytest.mark.parametrize(("search", "stage", "iteration"), STAGES)
def test_an_exception_in_the_callback_comes_out_and_the_handler_is_restored(
    reference, kind, search, stage, iteration
):
    path = reference[0]
    handler = signal.getsignal(signal.SIGINT)
    calls = []

    def stop(report):
        calls.append(report)
        if (report.stage, report.iteration) == (stage, iteration):
            raise kind("enough")

    with pytest.raises(kind, match="enough"):
        ak.solve(EHMCS, path, search=search, progress=stop)
    assert (calls[-1].stage, calls[-1].iteration) == (stage, iteration)
    assert signal.getsignal(signal.SIGINT) is handler
    check(ak.solve(EHMCS, path, search=search))


class Press:
    """Presses Ctrl-C in another thread: `after` seconds after a stage was told."""

    def __init__(self, stage, after=0.0):
        self.stage, self.after, self.at = stage, after, None
        self.reached = threading.Event()
        self.thread = threading.Thread(target=self._press)

    def _press(self):
        assert self.reached.wait(60)
        if self.stage is None:
            return
        time.sleep(self.after)
        self.at = time.monotonic()
        os.kill(os.getpid(), signal.SIGINT)

    def __call__(self, report):
        if report.stage == self.stage:
            self.reached.set()

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, kind, error, trace):
        if not self.reached.is_set():
            self.stage = None
            self.reached.set()
        self.thread.join()


needs_signals = pytest.mark.skipif(
    os.name == "nt", reason="os.kill sends no SIGINT to a thread of this process"
)


@needs_signals
@pytest.mark.parametrize(
    ("search", "stage", "n"),
    [
        ("swivel", "swivel map", 4000),
        ("swivel", "global path", 4000),
        ("swivel", "one curve", 4000),
        ("full-space", "first guess", 1200),
        ("full-space", "exact tracking", 1200),
    ],
)
def test_ctrl_c_ends_a_long_solve_soon(search, stage, n, capfd):
    path, _ = smooth_path(EHMCS, n, seed=1)
    handler = signal.getsignal(signal.SIGINT)
    with Press(stage) as press, pytest.raises(KeyboardInterrupt):
        ak.solve(EHMCS, path, search=search, progress=press)
    assert time.monotonic() - press.at < 5
    assert signal.getsignal(signal.SIGINT) is handler
    assert capfd.readouterr() == ("", "")


@needs_signals
@pytest.mark.parametrize("backend", ["auto", "vm"])
@pytest.mark.parametrize("after", [0.01, 0.05, 0.1, 0.2])
def test_ctrl_c_is_never_lost_nor_turned_into_another_error(after, backend):
    """CasADi calls Python while it converts arguments; what is raised there must still come out."""
    path, _ = smooth_path(EHMCS, 4000 if backend == "auto" else 300, seed=1)
    handler = signal.getsignal(signal.SIGINT)

    def again_and_again():  # a solve may be over before the time is
        for _ in range(100):
            ak.solve(EHMCS, path, backend=backend, progress=press)

    with Press("swivel map", after) as press, pytest.raises(KeyboardInterrupt):
        again_and_again()
    assert time.monotonic() - press.at < 5
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
