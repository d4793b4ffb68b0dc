"""`.c3d` files: round trips, other machines' numbers, and length fields that lie."""

from __future__ import annotations

import struct
import sys
import tempfile
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_recordings import recordings

from armik_sym.errors import ArmikError, MotionFileError, MotionFileWarning, OptionError, UnitError
from armik_sym.motion.c3d import read_c3d, write_c3d
from armik_sym.motion.c3d_header import read_c3d_header
from armik_sym.motion.marker_recording import MarkerRecording

ezc3d = pytest.importorskip("ezc3d", reason="ezc3d is not installed (extra c3d)")

TIME = np.arange(40, 50) / 59.94
POSITION = np.random.default_rng(0).uniform(-2, 2, (10, 3, 3))
POSITION[4:6, 1] = np.nan


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    file = tmp_path_factory.mktemp("c3d") / "good.c3d"
    write_c3d(file, MarkerRecording(TIME, ("me:ELB", "WRI", "X Y"), POSITION, declared_rate=59.94))
    return file.read_bytes()


def read(tmp_path: Path, raw: bytes) -> MarkerRecording:
    (tmp_path / "x.c3d").write_bytes(raw)
    return read_c3d(tmp_path / "x.c3d")


def at(raw: bytes, byte: int, form: str, value: float) -> bytes:
    changed = bytearray(raw)
    struct.pack_into(form, changed, byte, value)
    return bytes(changed)


def value_of(raw: bytes, tmp_path: Path, name: str) -> int:
    """Byte at which the values of a parameter start."""
    (tmp_path / "x.c3d").write_bytes(raw)
    return read_c3d_header(tmp_path / "x.c3d").parameters[name].at


def test_positions_gaps_rate_and_first_frame(tmp_path: Path, good: bytes) -> None:
    r = read(tmp_path, good)
    assert (r.names, r.rate) == (("me:ELB", "WRI", "X Y"), 59.94)
    np.testing.assert_array_equal(r.time, TIME)
    np.testing.assert_array_equal(np.isnan(r.position), np.isnan(POSITION))
    np.testing.assert_array_equal(r.position, np.float32(1000 * POSITION).astype(float) / 1000)


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(recordings(forbidden="\0", grid=True))
def test_round_trip_is_exact_to_32_bits(recording: MarkerRecording) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "x.c3d"
        write_c3d(file, recording, "m")
        back = read_c3d(file)
    assert back.names == recording.names
    assert back.rate == pytest.approx(recording.rate, rel=1e-7)
    np.testing.assert_allclose(back.time, recording.time, rtol=1e-7)
    np.testing.assert_array_equal(back.position, np.float32(recording.position))


@pytest.mark.parametrize(("first", "n"), [(40000, 3), (70000, 3), (1, 65534), (1, 65540)])
def test_frame_numbers_beyond_16_bits(tmp_path: Path, first: int, n: int) -> None:
    position = np.random.default_rng(1).uniform(-1, 1, (n, 1, 3)).astype(np.float32)
    recording = MarkerRecording((first - 1 + np.arange(n)) / 100.0, ("a",), position, declared_rate=100.0)
    write_c3d(tmp_path / "x.c3d", recording, "m")
    back = read_c3d(tmp_path / "x.c3d")
    np.testing.assert_array_equal(back.time, recording.time)
    np.testing.assert_array_equal(back.position, position)


def test_names_in_another_encoding_are_read(tmp_path: Path, good: bytes) -> None:
    assert read(tmp_path, good.replace(b"me:ELB", b"me:\xc9LB")).names[0] == "me:ÉLB"


def test_points_without_label_are_numbered_and_told(tmp_path: Path, good: bytes) -> None:
    with pytest.warns(MotionFileWarning, match="1 points have no label"):
        assert read(tmp_path, good.replace(b"WRI", b"   ")).names == ("me:ELB", "*2", "X Y")


def test_names_that_occur_twice_are_refused(tmp_path: Path, good: bytes) -> None:
    with pytest.raises(MotionFileError, match=r"x\.c3d: point 'X Y' occurs twice"):
        read(tmp_path, good.replace(b"WRI", b"X Y"))


def test_unknown_units_are_refused_with_their_byte(tmp_path: Path, good: bytes) -> None:
    where = value_of(good, tmp_path, "POINT:UNITS")
    with pytest.raises(UnitError, match=f"byte {where}: POINT:UNITS is 'ft', allowed: m, cm, mm"):
        read(tmp_path, good[:where] + b"ft" + good[where + 2 :])


@pytest.mark.parametrize(
    ("byte", "form", "value", "message"),
    [
        (0, "B", 0, "byte 0 puts the parameters at block 0"),
        (0, "B", 200, "byte 0 puts the parameters at block 200, byte 101888"),
        (1, "B", 0, "byte 1 is 0x00, expected 0x50"),
        (2, "<H", 65535, "byte 2: the header has points 65535, POINT:USED"),
        (4, "<H", 65535, "byte 4: the header has 65535 analog values in a frame"),
        (6, "<H", 65535, "byte 6"),
        (8, "<H", 65535, "byte 6: the header has frames 1 to 65535"),
        (16, "<H", 65535, "byte 16: the header has first block of data 65535"),
        (515, "B", 1, "byte 515: processor type is 1"),
    ],
)
def test_absurd_fields_of_the_header(
    tmp_path: Path, good: bytes, byte: int, form: str, value: int, message: str
) -> None:
    with pytest.raises(MotionFileError, match=message) as caught:
        read(tmp_path, at(good, byte, form, value))
    assert "x.c3d" in str(caught.value)


def test_a_file_of_more_frames_than_it_holds_is_refused_before_anything_is_sized_by_them(
    tmp_path: Path, good: bytes
) -> None:
    fields = {word: value_of(good, tmp_path, f"TRIAL:ACTUAL_{word}_FIELD") for word in ("START", "END")}
    raw = at(at(good, 8, "<H", 65535), 6, "<H", 1)
    raw = at(at(raw, fields["START"], "<I", 1), fields["END"], "<I", 2**31 - 1)
    (tmp_path / "x.c3d").write_bytes(raw)
    tracemalloc.start()
    with pytest.raises(MotionFileError, match=r"promises 2147483647 frames of 48 bytes .* cut off"):
        read_c3d(tmp_path / "x.c3d")
    assert tracemalloc.get_traced_memory()[1] < 5e6
    tracemalloc.stop()


def test_absurd_fields_of_parameters(tmp_path: Path, good: bytes) -> None:
    labels = value_of(good, tmp_path, "POINT:LABELS")
    for value, message in ((255, "takes .* bytes, the section ends"), (9, "has 9 dimensions")):
        where = labels - 2 if value == 255 else labels - 3
        with pytest.raises(
            MotionFileError, match=rf"x\.c3d: byte \d+: .*({message}|start before it|description)"
        ):
            read(tmp_path, at(at(good, where, "B", value), labels - 1, "B", 255))
    with pytest.raises(MotionFileError, match=r"byte \d+: the type of 'LABELS' is 77"):
        read(tmp_path, at(good, labels - 4, "b", 77))
    with pytest.raises(MotionFileError, match=r"byte \d+: the one after 'LABELS' is said to start at"):
        read(tmp_path, at(good, labels - 6, "<H", 65000))
    with pytest.raises(MotionFileError, match=r"'LABELS' ends at byte \d+, the next one is said"):
        read(tmp_path, at(good, labels - 6, "<H", 3))
    rate = value_of(good, tmp_path, "POINT:RATE")
    for value in (0.0, -1.0, float("nan")):
        with pytest.raises(MotionFileError, match=r"POINT:RATE is .* positive"):
            read(tmp_path, at(good, rate, "<f", value))


def test_every_cut_is_refused(tmp_path: Path, good: bytes) -> None:
    data = (struct.unpack_from("<H", good, 16)[0] - 1) * 512
    for end in [0, 1, 2, 100, 511, 512, 600, 1023, data - 1, data, data + 1, data + 10 * 48 - 1]:
        with pytest.raises(MotionFileError, match=r"x\.c3d"):
            read(tmp_path, good[:end])


@settings(max_examples=80, deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 1535), st.sampled_from([0, 1, 127, 128, 255])), min_size=1, max_size=3)
)
@pytest.mark.filterwarnings("ignore::armik_sym.errors.MotionFileWarning")
def test_damaged_headers_are_read_or_refused_but_never_crash(
    tmp_path_factory: pytest.TempPathFactory, good: bytes, changes: list[tuple[int, int]]
) -> None:
    raw = bytearray(good)
    for byte, value in changes:
        raw[byte] = value
    file = tmp_path_factory.getbasetemp() / "damaged.c3d"
    file.write_bytes(raw)
    try:
        recording = read_c3d(file)
    except ArmikError as error:
        assert "damaged.c3d" in str(error)  # noqa: PT017
    else:
        # What passes is confirmed by the length of the file.
        assert recording.position.size * 4 <= len(raw) * 2
        assert recording.rate > 0


def test_names_and_times_that_do_not_fit_are_not_written(tmp_path: Path, good: bytes) -> None:
    r = read(tmp_path, good)
    with pytest.raises(MotionFileError, match="too long"):
        write_c3d(tmp_path / "y.c3d", r.renamed({"WRI": "W" * 128}))
    skipped = np.delete(np.arange(300), 150) / 100.0
    with pytest.raises(MotionFileError, match="have steps"):
        write_c3d(
            tmp_path / "y.c3d", MarkerRecording(skipped, ("a",), np.zeros((299, 1, 3)), declared_rate=100.0)
        )
    with pytest.raises(MotionFileError, match="no folder"):
        write_c3d(tmp_path / "none" / "y.c3d", r)


def test_without_ezc3d_files_can_be_read_and_the_extra_for_writing_is_named(
    tmp_path: Path, good: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ezc3d", None)
    r = read(tmp_path, good)
    with pytest.raises(OptionError, match=r"pip install 'armik_sym\[c3d\]'"):
        write_c3d(tmp_path / "y.c3d", r)


def converted(good: bytes, form: str, processor: int) -> bytes:
    """The same file as another machine writes it: whole numbers, or those of DEC."""
    raw, data = bytearray(good), (struct.unpack_from("<H", good, 16)[0] - 1) * 512
    values = np.frombuffer(good, "<f4", count=10 * 12, offset=data)
    if form == "whole":
        scaled = np.where(np.arange(120) % 4 == 3, values, values / 0.1)
        body = np.round(np.nan_to_num(scaled)).astype("<i2").tobytes()
        struct.pack_into("<f", raw, 12, 0.1)
        struct.pack_into("<f", raw, good.index(b"SCALE") + 5 + 4, 0.1)
        return bytes(raw[:data]) + body
    if form == "dec":
        halves = np.frombuffer((values * 4).astype("<f4").tobytes(), "<u2").reshape(-1, 2)[:, ::-1]
        raw[515] = processor
        for name in (b"SCALE", b"RATE"):
            where = good.index(name) + len(name) + 4
            (number,) = struct.unpack_from("<f", good, where)
            raw[where : where + 4] = np.frombuffer(struct.pack("<f", number * 4), "<u2")[::-1].tobytes()
        return bytes(raw[:data]) + halves.tobytes()
    raise AssertionError(form)


@pytest.mark.parametrize(("form", "processor", "tolerance"), [("whole", 84, 6e-5), ("dec", 85, 0.0)])
def test_other_ways_to_keep_numbers(
    tmp_path: Path, good: bytes, form: str, processor: int, tolerance: float
) -> None:
    expected, r = read(tmp_path, good), read(tmp_path, converted(good, form, processor))
    np.testing.assert_allclose(r.position, expected.position, rtol=0, atol=tolerance)
    assert (r.names, r.rate) == (expected.names, expected.rate)
    # An independent reader agrees.
    points = ezc3d.c3d(str(tmp_path / "x.c3d"))["data"]["points"][:3].transpose(2, 1, 0)
    np.testing.assert_allclose(r.position, points / 1000, rtol=1e-6)
