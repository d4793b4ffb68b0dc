"""The swivel map: round trips, bands against margins, what blocks, references, position-only paths."""

from __future__ import annotations

import numpy as np
import pytest
from anatomy import WRIST
from hypothesis import example, given, settings
from hypothesis import strategies as st
from smooth_motions import path_of, smooth_angles
from spherical_arms import ARMS, OF_THE_PAPERS, apart, pose_error, poses

import armik_sym as ak
from armik_sym.arm import Arm
from armik_sym.arm.catalog import ehmcs, human
from armik_sym.arm.product_of_transforms import joint_frames
from armik_sym.motion.hand_path import HandPath
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.swivel.branches import swivel_of_postures
from armik_sym.swivel.map import SwivelMap, swivel_map

BACKENDS = ("vm", "auto")


def wide(arm: Arm, n: int = 60, seed: int = 0) -> np.ndarray:
    return smooth_angles(arm, n, seed, width=0.95, most=1.5)


def narrowed(arm: Arm, seed: int, share: float = 0.5) -> Arm:
    rng = np.random.default_rng(seed)
    centre = arm.rom.lower + arm.rom.width * rng.uniform(0.3, 0.7, arm.dof)
    half = 0.5 * share * arm.rom.width
    return arm.with_rom(np.maximum(arm.rom.lower, centre - half), np.minimum(arm.rom.upper, centre + half))


def sines(map_: SwivelMap, q: np.ndarray) -> np.ndarray:
    at = swivel_of_postures(map_.spherical, q, map_.reference, position_only=map_.wrist is not None)
    return np.abs(at.sines).min(axis=1)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("name", ARMS)
def test_postures_follow_the_path_and_lie_where_they_were_asked_for(name: str, backend: str) -> None:
    arm = ARMS[name]
    q = wide(arm)
    path = path_of(arm, q)
    map_ = swivel_map(arm, path, backend=backend)
    psi = 2.5 * np.sin(np.linspace(0, 9, len(path)))
    for branch in range(8):
        made = map_.postures(psi, branch)
        assert pose_error(arm, made, path.position, path.rotation) < 1e-12
        clear = sines(map_, made) > 1e-6
        assert clear.mean() > 0.9
        back = map_.swivel_of(made)
        assert (back.branch[clear] == branch).all()
        assert apart(back.psi, psi)[clear].max() < 1e-9
        assert np.abs(np.diff(back.psi)).max() < np.pi


@pytest.mark.parametrize("name", ARMS)
def test_the_motion_that_made_the_path_is_found_again_inside_the_bands(name: str) -> None:
    arm = ARMS[name]
    q = wide(arm, seed=1)
    map_ = swivel_map(arm, path_of(arm, q))
    psi, branch = map_.swivel_of(q)
    clear = sines(map_, q) > 1e-6
    assert map_.contains(psi, branch)[clear].all()
    back = map_.postures(psi, branch, wish=q)
    assert np.abs(back - q)[clear].max() < 1e-9
    assert not len(map_.blocked)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("name", OF_THE_PAPERS)
def test_inside_the_bands_every_joint_is_inside_its_range_and_outside_not(name: str, backend: str) -> None:
    arm = narrowed(ARMS[name], seed=4)
    map_ = swivel_map(arm, path_of(arm, wide(arm, seed=2)), backend=backend)
    rng = np.random.default_rng(3)
    seen = np.zeros(2, dtype=int)
    for _ in range(30):
        psi, branch = rng.uniform(-7, 7, len(map_)), rng.integers(0, 8, len(map_))
        margin = arm.rom.margin(map_.postures(psi, branch)).min(axis=1)
        sure = np.abs(margin) > 1e-9
        inside = map_.contains(psi, branch)
        np.testing.assert_array_equal(inside[sure], (margin > 0)[sure])
        seen += [inside.sum(), (~inside).sum()]
    assert seen.min() > 20


@settings(max_examples=25)
@example(seed=2623, share=0.6593005894769988)  # an end 5e-7 beside the pole of the shoulder
@given(seed=st.integers(0, 10_000), share=st.floats(0.2, 0.9))
def test_bands_end_exactly_at_limits(seed: int, share: float) -> None:
    arm = narrowed(human(), seed, share)
    map_ = swivel_map(arm, path_of(arm, wide(arm, 12, seed)))
    intervals = map_.intervals
    for edge, outwards in ((intervals.start, -1e-8), (intervals.end, 1e-8)):
        for sample, branch, psi, whole in zip(
            intervals.sample, intervals.branch, edge, intervals.end - intervals.start > 6.28, strict=True
        ):
            inside = map_.clearance([psi], int(branch), [sample]).margin[0, 0]
            outside = map_.clearance([psi + outwards], int(branch), [sample]).margin[0, 0]
            # What is zero at an end is sin β times the sine of the angle missing, and it is so to rounding,
            # some 1e-15: beside a pole an angle turns by 1/sin β for each unit in the last place of ψ.
            beta = sines(map_, map_.postures(psi, int(branch)))[sample]
            assert inside * beta > -1e-14
            assert whole or outside < 0


def test_clearance_is_the_smallest_margin_and_names_its_joint() -> None:
    arm = ehmcs()
    map_ = swivel_map(arm, path_of(arm, wide(arm, 20)))
    psi = np.linspace(-3, 3, 7)
    found = map_.clearance(psi, 2, [3, 11])
    for i, sample in enumerate((3, 11)):
        for k, angle in enumerate(psi):
            margin = arm.rom.margin(map_.postures(angle, 2)[sample])
            assert found.margin[i, k] == pytest.approx(margin.min(), abs=1e-12)
            assert found.joint[i, k] == margin.argmin()
    assert map_.clearance(psi, 0).margin.shape == (20, 7)


def test_out_of_reach_has_no_clearance() -> None:
    arm = ehmcs()
    path = path_of(arm, wide(arm, 3))
    far = HandPath(path.time, path.position + np.outer([0, 5, 0], [1, 0, 0]), path.rotation)
    map_ = swivel_map(arm, far)
    assert 1 in map_.blocked
    margin = map_.clearance([0.0, 1.0], 2).margin
    assert (margin[1] == -np.inf).all()
    assert np.isfinite(margin[[0, 2]]).all()
    lines = [line for line in map_.explain_blocked() if line.startswith("sample 1 ")]
    miss = 1000 * map_.why_blocked([1]).shortfall[0]
    assert lines == [f"sample 1 ({path.time[1]:.3g} s): out of reach by {miss:.3g} mm"]
    reach = arm.lengths["upper_arm"] + arm.lengths["forearm"]
    wrist = far.position[1] - [0, 0, 0.143]
    assert miss == pytest.approx(1000 * (np.linalg.norm(wrist) - reach), rel=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_the_joint_at_an_end_is_the_one_that_blocks_there(seed: int) -> None:
    """With more room for that joint the band goes on; with more room for all others it does not."""
    arm = narrowed(ehmcs(), seed)
    path = path_of(arm, wide(arm, 8, seed))
    map_ = swivel_map(arm, path)
    ends = map_.interval_ends()
    checked = 0
    for row in range(len(map_.intervals.start)):
        sample, branch = int(map_.intervals.sample[row]), int(map_.intervals.branch[row])
        for side, edge, step in ((0, map_.intervals.start, -1e-4), (1, map_.intervals.end, 1e-4)):
            joint, upper = ends.joint[row, side], ends.upper[row, side]
            lower, most = arm.rom.lower.copy(), arm.rom.upper.copy()
            if upper:
                most[joint] += 0.01
            else:
                lower[joint] -= 0.01
            here = np.full(len(path), edge[row] + step)
            q = map_.postures(here, branch)[sample]
            gap = (q[joint] - arm.rom.upper[joint]) if upper else (arm.rom.lower[joint] - q[joint])
            others = np.delete(arm.rom.margin(q), joint)
            if others.min() < 0 or gap > 0.01:  # two limits at once, or a joint that flips at a pole
                continue
            assert gap > 0
            wider = swivel_map(arm.with_rom(lower, most), path)
            assert wider.contains(here, branch)[sample]
            assert not map_.contains(here, branch)[sample]
            checked += 1
    assert checked > 4


def test_a_whole_circle_has_no_ends() -> None:
    arm = ehmcs().with_rom(np.full(7, -np.pi), np.full(7, np.pi))
    map_ = swivel_map(arm, path_of(arm, wide(ehmcs(), 4)))
    assert (map_.interval_ends().joint == -1).all()
    assert map_.interval_ends([0]).joint.shape == (1, 2)
    np.testing.assert_allclose(map_.width, 2 * np.pi)
    np.testing.assert_array_equal(map_.single_branch, np.arange(8))


def blocked_map() -> SwivelMap:
    """A task that asks more of the elbow than a patient has."""
    arm = ehmcs()
    lower, upper = arm.rom.lower.copy(), arm.rom.upper.copy()
    upper[arm.joint_index("elbow_flexion")] = np.deg2rad(110)
    upper[arm.joint_index("shoulder_internal_rotation")] = np.deg2rad(20)
    return swivel_map(arm.with_rom(lower, upper), ak.load_task("drinking_lift").path)


def test_blocked_samples_are_those_where_a_scan_finds_nothing() -> None:
    map_ = blocked_map()
    found = np.zeros(len(map_), dtype=bool)
    for branch in range(8):
        found |= (map_.clearance(np.linspace(-np.pi, np.pi, 181), branch).margin >= 0).any(axis=1)
    assert 0 < len(map_.blocked) < len(map_)
    assert not found[map_.blocked].any()
    wide_enough = map_.width.max(axis=1) > np.deg2rad(2.1)
    assert found[wide_enough].all()


def test_what_is_missing_is_just_enough() -> None:
    map_ = blocked_map()
    sample = int(map_.blocked[-1])
    missing = float(map_.why_blocked([sample]).missing[0])
    path = map_.path
    here = slice(sample - 1, sample + 1)
    short = HandPath(path.time[here], path.position[here], path.rotation[here])
    for extra, blocked in ((missing - 1e-6, True), (missing + 1e-6, False)):
        arm = map_.arm.with_rom(map_.arm.rom.lower - extra, map_.arm.rom.upper + extra)
        assert (1 in swivel_map(arm, short).blocked) == blocked


def test_blocked_samples_are_explained_in_words() -> None:
    map_ = blocked_map()
    lines = map_.explain_blocked()
    first, last = map_.blocked[[0, -1]]
    assert len(lines) == 1
    assert lines[0].startswith(f"samples {first} to {last} ({map_.path.time[first]:.3g} to ")
    worst = np.rad2deg(map_.why_blocked().missing.max())
    assert f"elbow flexion limit (110°) missed by {worst:.3g}°" in lines[0]
    text = str(map_)
    assert f"{len(map_.blocked)} blocked" in text
    assert lines[0] in text
    assert not swivel_map(ehmcs(), map_.path).explain_blocked()


def test_every_blocked_sample_is_in_exactly_one_line() -> None:
    arm = narrowed(ehmcs(), seed=0, share=0.35)
    map_ = swivel_map(arm, path_of(ehmcs(), wide(ehmcs(), 400, seed=5)))
    told: list[int] = []
    for line in map_.explain_blocked():
        words = line.split()
        first = int(words[1])
        told += range(first, (int(words[3]) if words[0] == "samples" else first) + 1)
    assert len(map_.blocked) > 50
    np.testing.assert_array_equal(told, map_.blocked)


def test_branches_that_break_say_where_and_why() -> None:
    task = ak.load_task("playing_ball")
    map_ = swivel_map(ehmcs(), task.path)
    np.testing.assert_array_equal(map_.single_branch, [2])
    assert map_.swivel_of(task.measured).branch.tolist() == [2] * len(map_)
    breaks = {item.branch: item for item in map_.breaks}
    assert set(breaks) == set(range(8)) - {2}
    for branch, item in breaks.items():
        assert map_.intervals.empty[item.sample, branch]
        assert not map_.intervals.empty[: item.sample, branch].any()
        assert item.missing > 0
        scan = map_.clearance(np.linspace(-np.pi, np.pi, 721), branch, [item.sample]).margin
        assert -scan.max() >= item.missing - 1e-9
        assert -scan.max() < item.missing + 0.01
    text = str(map_)
    assert "every sample has a posture" in text
    assert "branch 2  shoulder flexion -90° to 90°" in text
    assert "none at sample 0 (shoulder internal rotation limit (70°) missed by" in text


@pytest.mark.parametrize("name", ARMS)
def test_branch_names_tell_the_angles_of_the_joints_they_name(name: str) -> None:
    arm = ARMS[name]
    map_ = swivel_map(arm, path_of(arm, wide(arm, 50, seed=7)))
    assert len(set(map_.branch_names)) == 8
    for branch, words in enumerate(map_.branch_names):
        q = np.rad2deg(map_.postures(1.0, branch))
        for part in words.split(", "):
            joint = next((j for j in arm.joint_names if part.startswith(j.replace("_", " "))), None)
            if joint is None:
                continue
            numbers = part.removesuffix(" (outside its range)")[len(joint) + 1 :].replace("°", "")
            angles = q[:, arm.joint_index(joint)]
            if numbers.startswith("beyond"):
                low = float(numbers.removeprefix("beyond ±"))
                high = 360 - low
            else:
                low, high = (float(number) for number in numbers.split(" to "))
            assert high - low == pytest.approx(180, abs=0.2)
            assert (np.mod(angles - low + 0.2, 360) <= high - low + 0.4).all()


def test_only_joints_that_leave_a_choice_are_named() -> None:
    map_ = swivel_map(ehmcs(), ak.load_task("brushing").path)
    assert map_.branch_names[0] == "shoulder flexion beyond ±90°"
    assert map_.branch_names[2] == "shoulder flexion -90° to 90°"
    assert "wrist extension" in map_.branch_names[3]
    assert "outside its range" in map_.branch_names[3]
    lower, upper = ehmcs().rom.lower.copy(), ehmcs().rom.upper.copy()
    lower[1], upper[1] = -1.0, 1.5
    names = swivel_map(ehmcs().with_rom(lower, upper), ak.load_task("brushing").path).branch_names
    assert names[2] == "the only branch the range of motion allows"
    assert sum("outside its range" in name for name in names) == 7


def through_the_line(arm: Arm) -> np.ndarray:
    """A motion that takes the wrist exactly through the line of the arm's reference direction."""
    q = np.zeros((81, 7))
    q[:, 3] = 0.6
    q[:, 0] = 0.3 * np.linspace(-1, 1, 81)
    q[:, 1] = np.linspace(-0.7, 0.7, 81)
    q[:, 1] -= 0.3  # the elbow bent by 0.6 puts the wrist near the line where q2 = -0.3
    return q


def test_the_swivel_angle_does_not_jump_where_the_wrist_passes_under_the_shoulder() -> None:
    arm = ehmcs()
    q = through_the_line(arm)
    map_ = swivel_map(arm, path_of(arm, q))
    steps = np.abs(np.diff(map_.swivel_of(q).psi)).max()
    fixed = np.unwrap(swivel_of_postures(map_.spherical, q).psi)
    assert steps < 0.1
    assert np.abs(np.diff(fixed)).max() > 10 * steps
    moves = np.abs(np.diff(map_.intervals.start[map_.intervals.branch == 2]))
    assert np.minimum(moves, 2 * np.pi - moves).max() < 0.2


def test_another_reference_turns_all_swivel_angles_by_the_same() -> None:
    arm = human()
    q = wide(arm, seed=6)
    path = path_of(arm, q)
    plain = swivel_map(arm, path)
    turned = swivel_map(arm, path, reference=[0.1, 2.0, -0.7])
    shift = turned.swivel_of(q).psi - plain.swivel_of(q).psi
    assert abs(shift[0]) > 0.1
    assert apart(shift, shift[0]).max() < 1e-9
    np.testing.assert_allclose(turned.width, plain.width, atol=1e-9)
    # At the first sample ψ counts from the half plane of the direction that was given.
    wrist = joint_frames(arm.chain, q[:1], arm.lengths)[0, WRIST, :3, 3]
    along = wrist / np.linalg.norm(wrist)
    across = np.array([0.1, 2.0, -0.7]) - along * (along @ [0.1, 2.0, -0.7])
    np.testing.assert_allclose(turned.reference[0], across / np.linalg.norm(across), atol=1e-12)


@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("arm", [ehmcs(), ehmcs(5), ehmcs(4), human()], ids=lambda arm: arm.name)
def test_paths_of_positions_have_a_map_for_each_posture_of_the_wrist(arm: Arm, backend: str) -> None:
    q = wide(arm, 40, seed=8)
    path = path_of(arm, q, turned=False)
    map_ = swivel_map(arm, path, wrist=q[:, 4:], backend=backend)
    assert len(map_.branches) == 4
    made = map_.postures(np.linspace(0, 5, 40), 1)
    assert np.abs(poses(arm, made)[0] - path.position).max() < 1e-12
    np.testing.assert_array_equal(made[:, 4:], q[:, 4:])
    psi, branch = map_.swivel_of(q)
    clear = sines(map_, q) > 1e-6
    assert map_.contains(psi, branch)[clear].all()
    assert np.abs(map_.postures(psi, branch, wish=q) - q)[clear].max() < 1e-9
    margin = arm.rom.margin(map_.postures(1.0, 0)).min(axis=1)
    np.testing.assert_array_equal(
        map_.contains(1.0, 0)[np.abs(margin) > 1e-9], (margin > 0)[np.abs(margin) > 1e-9]
    )
    str(map_)
    one = swivel_map(arm, path, wrist=q[0, 4:], backend=backend)
    assert one.wrist is not None
    np.testing.assert_array_equal(one.wrist, np.tile(q[0, 4:], (40, 1)))


def test_the_compiled_map_is_the_one_of_numpy() -> None:
    arm = narrowed(human(), seed=2)
    path = path_of(human(), wide(human(), 120, seed=9))
    one, other = (swivel_map(arm, path, backend=backend) for backend in BACKENDS)
    np.testing.assert_array_equal(one.blocked, other.blocked)
    np.testing.assert_allclose(one.intervals.start, other.intervals.start, atol=1e-11)
    np.testing.assert_allclose(one.width, other.width, atol=1e-11)
    assert one.explain_blocked() == other.explain_blocked()
    assert str(one) == str(other)


def test_motions_are_matched_by_name_and_solutions_accepted() -> None:
    task = ak.load_task("brushing")
    map_ = swivel_map(ehmcs(), task.path)
    psi, branch = map_.swivel_of(task.measured)
    mixed = JointMotion(task.measured.time, task.measured.q[:, ::-1], task.measured.joint_names[::-1])
    np.testing.assert_array_equal(map_.swivel_of(mixed).psi, psi)
    np.testing.assert_array_equal(map_.swivel_of(task.measured.q).branch, branch)
