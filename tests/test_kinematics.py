"""The compiled kinematics as users call them."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from compiled_helpers import forgotten, needs_cc
from hypothesis import given
from hypothesis import strategies as st
from sample_arms import ARMS, postures

from armik_sym.arm.catalog import ehmcs
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.compiled import compile as compile_arm
from armik_sym.compiled.emit_vectors import jacobian_by_differences
from armik_sym.errors import ArmikError, ShapeError

pytestmark = needs_cc

_QUANTITIES = ("position", "rotation", "jacobian")


def _equation_3(q):
    """Nguyen 2021, eq. 3, as printed, in millimetres."""
    cos, sin, pi = np.cos, np.sin, np.pi
    q1, q2, q3, q4 = q.T[:4]
    x = (
        (2869 * cos(q1) * sin(q2 - pi / 2)) / 10
        - 336 * sin(q4) * (sin(q1) * sin(q3) - cos(q1) * cos(q3) * cos(q2 - pi / 2))
        + 336 * cos(q1) * cos(q4) * sin(q2 - pi / 2)
    )
    y = (
        (2869 * sin(q1) * sin(q2 - pi / 2)) / 10
        + 336 * sin(q4) * (cos(q1) * sin(q3) + cos(q3) * cos(q2 - pi / 2) * sin(q1))
        + 336 * cos(q4) * sin(q1) * sin(q2 - pi / 2)
    )
    z = (
        (2869 * cos(q2 - pi / 2)) / 10
        + 336 * cos(q4) * cos(q2 - pi / 2)
        - 336 * cos(q3) * sin(q4) * sin(q2 - pi / 2)
        + 143
    )
    return np.stack([x, y, z], axis=-1)


@pytest.mark.parametrize("dof", [4, 5, 7])
@pytest.mark.parametrize("backend", ["c", "vm"])
def test_position_is_equation_3_of_nguyen(dof, backend):
    arm = ehmcs(dof)
    q = postures(arm, 10_000, seed=3, stretch=1.5)
    np.testing.assert_allclose(
        compile_arm(arm, backend).position(q), _equation_3(q) / 1000, rtol=0, atol=1e-12
    )


@pytest.mark.parametrize("backend", ["c", "vm"])
@pytest.mark.parametrize("arm", ARMS.values(), ids=list(ARMS))
def test_equals_the_product_of_transforms(arm, backend):
    q = postures(arm, 300, stretch=2.0)
    kin = compile_arm(arm, backend)
    p, R = hand_pose(arm.chain, q, arm.lengths)
    J = jacobian_by_differences(arm, q)
    np.testing.assert_allclose(kin.position(q), p, atol=1e-12)
    np.testing.assert_allclose(kin.rotation(q), R, atol=1e-12)
    np.testing.assert_allclose(kin.jacobian(q), J, atol=1e-12)
    for found, wanted in zip(kin.pose_and_jacobian(q), (p, R, J), strict=True):
        np.testing.assert_allclose(found, wanted, atol=1e-12)


@given(st.sampled_from(list(ARMS)), st.data())
def test_c_equals_vm_to_rounding(name, data):
    arm = ARMS[name]
    angle = st.floats(-1e3, 1e3) | st.sampled_from([0.0, np.pi / 2, -np.pi / 2, np.pi, 1e-300, 1e5, 1e6])
    q = np.array([data.draw(angle) for _ in range(arm.dof)])
    with_c, with_vm = compile_arm(arm, "c"), compile_arm(arm, "vm")
    for quantity in _QUANTITIES:
        wanted = getattr(with_vm, quantity)(q)
        found = getattr(with_c, quantity)(q)
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * max(1, np.abs(wanted).max()))


@pytest.mark.parametrize("backend", ["c", "vm"])
def test_shapes(backend):
    kin = compile_arm(ehmcs(5), backend)
    for n in ((), (0,), (1,), (7,)):
        q = np.zeros((*n, 5))
        assert kin.position(q).shape == (*n, 3)
        assert kin.rotation(q).shape == (*n, 3, 3)
        assert kin.jacobian(q).shape == (*n, 6, 5)
        assert [part.shape for part in kin.pose_and_jacobian(q)] == [(*n, 3), (*n, 3, 3), (*n, 6, 5)]


@pytest.mark.parametrize("q", [np.zeros(6), np.zeros((3, 8)), np.zeros((2, 2, 7)), 0.0, [], np.zeros((7, 1))])
@pytest.mark.parametrize("quantity", [*_QUANTITIES, "pose_and_jacobian"])
def test_wrong_shapes_are_refused(q, quantity):
    with pytest.raises(ShapeError, match=r"expected \(7,\) or \(n, 7\) for arm 'ehmcs'"):
        getattr(compile_arm(ehmcs()), quantity)(q)


@pytest.mark.parametrize("backend", ["c", "vm"])
def test_any_array_like_gives_the_same(backend):
    kin = compile_arm(ehmcs(), backend)
    q = postures(kin.arm, 40).astype(np.float32).astype(np.float64)
    wanted = kin.position(q)
    read_only = q.copy()
    read_only.flags.writeable = False
    wide = np.full((80, 14), np.nan)
    wide[::2, ::2] = q
    for other in (
        q.tolist(),
        q.astype(np.float32),
        np.asfortranarray(q),
        read_only,
        wide[::2, ::2],
        q[::-1][::-1],
    ):
        np.testing.assert_array_equal(kin.position(other), wanted)
    np.testing.assert_array_equal(kin.position(q[3].tolist()), wanted[3])
    np.testing.assert_array_equal(kin.position(wide[6, ::2]), wanted[3])
    np.testing.assert_array_equal(kin.position(tuple(q[3].astype(np.float32))), wanted[3])
    np.testing.assert_array_equal(kin.position(np.zeros((2, 7), dtype=int)), kin.position(np.zeros((2, 7))))


@pytest.mark.parametrize("backend", ["c", "vm"])
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_nan_and_infinity_stay_in_their_sample(backend, bad):
    kin = compile_arm(ehmcs(), backend)
    q = postures(kin.arm, 300)
    clean = {name: getattr(kin, name)(q) for name in _QUANTITIES}
    rows = [0, 5, 17, 299]
    q[rows, 1] = bad
    others = np.setdiff1d(np.arange(300), rows)
    for name, wanted in clean.items():
        found = getattr(kin, name)(q)
        np.testing.assert_array_equal(found[others], wanted[others])
        assert np.isnan(found[rows].reshape(4, -1)).any(axis=1).all()
    assert np.isnan(kin.position(q[5])).any()


def test_answers_are_new_arrays():
    kin = compile_arm(ehmcs())
    q = postures(kin.arm, 2)
    first = kin.position(q[0])
    kept = first.copy()
    kin.position(q[1])
    np.testing.assert_array_equal(first, kept)


@pytest.mark.parametrize("backend", ["c", "vm"])
def test_out_is_filled_and_returned(backend):
    kin = compile_arm(ehmcs(), backend)
    q = postures(kin.arm, 300)
    for name, shape in (("position", (3,)), ("rotation", (3, 3)), ("jacobian", (6, 7))):
        out = np.empty((300, *shape))
        assert getattr(kin, name)(q, out=out) is out
        np.testing.assert_array_equal(out, getattr(kin, name)(q))
        one = np.empty(shape)
        assert getattr(kin, name)(q[4], out=one) is one
        np.testing.assert_array_equal(one, out[4])
    assert kin.position(q[:0], out=np.empty((0, 3))).shape == (0, 3)
    flat = np.empty((300, 54))
    position, rotation, jacobian = kin.pose_and_jacobian(q, out=flat)
    np.testing.assert_array_equal(position, kin.position(q))
    assert all(np.shares_memory(part, flat) for part in (position, rotation, jacobian))


def test_out_may_overlap_the_postures():
    kin = compile_arm(ehmcs())
    memory = np.zeros((100, 7))
    q = memory[:30]
    q[:] = postures(kin.arm, 30)
    wanted = kin.position(q)
    out = memory.reshape(-1)[20:110].reshape(30, 3)
    np.testing.assert_array_equal(kin.position(q, out=out), wanted)


def test_out_that_does_not_fit_is_refused():
    kin = compile_arm(ehmcs())
    q = postures(kin.arm, 4)
    read_only = np.zeros((4, 3))
    read_only.flags.writeable = False
    bad = [
        np.zeros((3, 3)),
        np.zeros((4, 3), np.float32),
        np.zeros((4, 6))[:, ::2],
        read_only,
        [[0.0] * 3] * 4,
    ]
    for out in bad:
        with pytest.raises(ShapeError, match="out "):
            kin.position(q, out=out)


@pytest.mark.parametrize("backend", ["c", "vm"])
def test_threads_do_not_mix_their_postures(backend):
    kin = compile_arm(ehmcs(), backend)
    q = postures(kin.arm, 400)
    wanted = kin.position(q)
    wrong = []

    def work(offset):
        for k in range(400):
            i = (k * 7 + offset) % 400
            if not np.array_equal(kin.position(q[i]), wanted[i]):
                wrong.append(i)

    threads = [threading.Thread(target=work, args=(37 * t,)) for t in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_lengths_and_limits_share_compiled_code(tmp_path, monkeypatch):
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(tmp_path))
    with forgotten():
        first = compile_arm(ehmcs())
        assert first.compile_time > 0
        longer = ehmcs().with_lengths(forearm=0.4)
        narrower = ehmcs().with_rom(-np.ones(7), np.ones(7))
        kins = [compile_arm(arm) for arm in (longer, narrower)]
        assert len(list(tmp_path.iterdir())) == 1
        assert kins[0]._functions["position"]._library is first._functions["position"]._library
    q = postures(ehmcs(), 5)
    np.testing.assert_allclose(kins[0].position(q), hand_pose(longer.chain, q, longer.lengths)[0], atol=1e-14)
    np.testing.assert_array_equal(kins[1].position(q), first.position(q))
    assert not np.allclose(kins[0].position(q), first.position(q))


def test_cold_and_warm_times_are_apart(tmp_path, monkeypatch):
    monkeypatch.setenv("ARMIK_CACHE_DIR", str(tmp_path))
    with forgotten():
        assert compile_arm(ehmcs()).compile_time > 0
    with forgotten():
        warm = compile_arm(ehmcs())
    assert warm.compile_time == 0
    assert warm.build_time > 0


def test_repr_and_error_family():
    assert repr(compile_arm(ehmcs(), "vm")) == "Kinematics(arm='ehmcs', backend='vm')"
    assert issubclass(ShapeError, ArmikError)
    assert issubclass(ShapeError, ValueError)
