"""The WebAssembly module against the C library, NumPy and its own promises."""

from __future__ import annotations

import base64
import json
import subprocess

import numpy as np
import pytest
from compiled_helpers import STRICT, build_strictly, needs_cc
from page_scripts import ALL_ARMS, NODE, WITH_SWIVEL, ask, needs_node, needs_zig, postures, rows
from sample_arms import BARE
from spherical_arms import anywhere

import armik_sym as ak
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.compiled.compiler import find_zig
from armik_sym.report.wasm import page_kinematics
from armik_sym.report.wasm.module_source import module_source
from armik_sym.report.wasm.wasm_compiler import FLAGS
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.closed_form import pose_curve
from armik_sym.swivel.postures_at import postures_at
from armik_sym.swivel.spherical_arm import recognise
from armik_sym.symbolic import express

N = 1000


@needs_node
@needs_zig
@pytest.mark.parametrize("name", ALL_ARMS)
def test_hand_is_that_of_the_compiled_library(name):
    arm = ALL_ARMS[name]
    q = anywhere(N, 1, arm.dof)
    hands = rows(page_kinematics(arm, q, kind="wasm"), "hand", q)
    kin = ak.compile(arm)
    position, rotation = (np.array([hand[key] for hand in hands]) for key in ("position", "rotation"))
    np.testing.assert_allclose(position, kin.position(q), rtol=0, atol=1e-12)
    np.testing.assert_allclose(rotation, kin.rotation(q), rtol=0, atol=1e-12)


@needs_node
@needs_zig
@pytest.mark.parametrize("name", [*ALL_ARMS, "bare"])
def test_every_joint_is_drawn_on_its_axis(name):
    arm = (ALL_ARMS | {"bare": BARE})[name]
    q = anywhere(50, 2, arm.dof)
    points = np.array(rows(page_kinematics(arm, q, kind="wasm"), "joints", q))
    frames = joint_frames(arm.chain, q, arm.lengths)
    after = arm.chain.convention.value == "modified"
    moving = [i for i, link in enumerate(arm.chain.links) if link.moves]
    assert points.shape == (50, arm.dof + 1, 3)
    np.testing.assert_allclose(points[:, -1], frames[:, -1, :3, 3], rtol=0, atol=1e-12)
    for j, i in enumerate(moving):
        T = frames[:, i + after]
        away = np.cross(points[:, j] - T[:, :3, 3], T[:, :3, 2])
        assert np.abs(away).max() < 1e-12


@needs_node
@needs_zig
@pytest.mark.parametrize("name", WITH_SWIVEL)
def test_postures_are_those_of_the_compiled_closed_form(name):
    arm, spherical = WITH_SWIVEL[name], recognise(WITH_SWIVEL[name])
    rng = np.random.default_rng(3)
    q, psi = anywhere(N, 4), rng.uniform(-7, 7, N)
    page = page_kinematics(arm, q, kind="wasm")
    kin, where = ak.compile(arm), swivel_of_postures(spherical, q)
    curves = tuple(pose_curve(spherical, kin.position(q), kin.rotation(q), side) for side in (1, -1))
    branch = 4 * (where.elbow < 0) + 2 * (where.shoulder < 0) + (where.wrist < 0)
    wanted = postures_at((curves[0], curves[1]), np.arange(N), branch, psi, q)
    # Near a pole the outer two angles of shoulder and wrist lose the digits that their sine lacks.
    sine = np.minimum(wanted.shoulder_sine, wanted.wrist_sine)
    sine = np.minimum(sine, np.abs(where.sines).min(axis=1))
    assert (sine > 1e-3).mean() > 0.98
    found = postures(page, psi, q)
    assert (np.abs(found - wanted.q).max(axis=1) * np.minimum(1, 1e2 * sine)).max() < 1e-12
    np.testing.assert_allclose(rows(page, "swivel", q), where.psi, rtol=0, atol=1e-12)


@needs_node
@needs_zig
@pytest.mark.parametrize("name", ["ehmcs", "custom_standard", "bare"])
def test_module_is_small_imports_nothing_and_exports_what_the_script_calls(name):
    arm = (ALL_ARMS | {"bare": BARE})[name]
    page = page_kinematics(arm, np.zeros((1, arm.dof)), kind="wasm")
    assert len(base64.b64decode(page.data["module"])) < 200_000
    code = (
        'const m = new WebAssembly.Module(Buffer.from(require("fs").readFileSync(0, "utf8"), "base64"));'
        "console.log(JSON.stringify([WebAssembly.Module.imports(m), "
        "WebAssembly.Module.exports(m).map((x) => x.name)]));"
    )
    done = subprocess.run(
        [str(NODE), "-e", code], input=page.data["module"], capture_output=True, text=True, check=True
    )
    imports, exports = json.loads(done.stdout)
    assert imports == []
    expected = {"memory", "_initialize", "draw", "lengths_at", "points_at", "q_at", "drawn_at"}
    if not page.why_no_swivel:
        expected |= {"swivel", "turn_elbow", "geometry_at", "reference_at", "limits_at", "posture_at"}
    assert set(exports) == expected


@needs_zig
@pytest.mark.parametrize("name", ["human", "custom_modified"])
def test_compiles_for_webassembly_without_warnings(name, tmp_path):
    arm, zig = ALL_ARMS[name], find_zig()
    (tmp_path / "page.c").write_text(module_source(express(arm), name in WITH_SWIVEL), encoding="ascii")
    flags = [flag for flag in FLAGS if flag not in STRICT]
    command = [*zig.command, *STRICT, *flags, "-o", "page.wasm", "page.c"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=900)
    assert (done.returncode, done.stderr) == (0, "")


@needs_cc
@pytest.mark.parametrize("name", [*ALL_ARMS, "bare"])
def test_the_same_source_compiles_without_warnings_for_this_machine(name, tmp_path):
    arm = (ALL_ARMS | {"bare": BARE})[name]
    build_strictly(module_source(express(arm), name in WITH_SWIVEL), tmp_path)


@needs_node
@needs_zig
def test_arms_of_one_structure_share_the_module_but_not_the_numbers():
    arm = ALL_ARMS["ehmcs"]
    other = arm.with_lengths(**{key: 1.1 * value for key, value in arm.lengths.items()})
    q = anywhere(5, 6)
    one, two = (page_kinematics(a, q, kind="wasm") for a in (arm, other))
    assert one.data["module"] == two.data["module"]
    points = np.array(rows(two, "joints", q))
    np.testing.assert_allclose(points[:, -1], ak.compile(other).position(q), rtol=0, atol=1e-12)
    upper = np.linalg.norm(points[:, two.landmarks["elbow"]] - points[:, two.landmarks["shoulder"]], axis=1)
    np.testing.assert_allclose(upper, other.lengths["upper_arm"], rtol=0, atol=1e-12)


@needs_node
@needs_zig
def test_wrong_postures_are_refused_in_words():
    arm = ALL_ARMS["ehmcs_4dof"]
    page = page_kinematics(arm, np.zeros((1, arm.dof)), kind="wasm")
    short, swivel, able = ask(page, [("joints", [0.0]), ("swivel", [0.0] * arm.dof), ("canSwivel",)])
    assert f"{arm.dof} finite numbers" in short["error"]
    assert page.why_no_swivel
    assert swivel["error"] == f"The elbow cannot be turned: {page.why_no_swivel}"
    assert able is False
