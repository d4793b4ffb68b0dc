"""What a recording asks of `armik solve`, and what a reader of the solution has to know."""

from __future__ import annotations

from collections.abc import Mapping

from armik_sym.cli.solve_input import RECORDED, Job
from armik_sym.errors import OptionError


def tracking_of(job: Job, method: str, options: Mapping[str, object]) -> str | None:
    """The tracking to choose where none was typed: soft for markers, as `armik compare` does.

    Args:
        job: What is to be solved.
        method: The method.
        options: Options of the method that were typed.

    Returns:
        "soft", or None to leave it to the method.

    Raises:
        OptionError: If another option needs exact tracking.

    Source:
        None (this package): markers are noisy, and no person's arm is rigid.
    """
    if not job.from_markers or method != "trajectory" or "tracking" in options:
        return None
    for name in ("search", "n_best", "certify"):
        if options.get(name) not in (None, "auto", "full-space", 1, False):
            raise OptionError(
                f"--{name.replace('_', '-')} needs exact tracking, but of markers it is soft unless you say "
                "--tracking exact"
            )
    return "soft"


def remarks(job: Job, start: str | None, tracking: str | None) -> list[str]:
    """What a reader has to know of a solution that comes from a recording.

    Args:
        job: What was solved.
        start: What was typed as first posture.
        tracking: The tracking chosen by `tracking_of`.

    Returns:
        One sentence each; none for a hand path.

    Source:
        None (command line).
    """
    from armik_sym.comparison.predicting import first_inside

    if job.recorded is None:
        return []
    notes = [
        *(_about_markers(job, tracking) if job.from_markers else _about_angles(job)),
        *job.recorded.notes,
    ]
    if start is None:
        return [*notes, "the recorded posture was not used; --start recorded begins there"]
    moved = first_inside(job.arm, job.recorded.measured.q[0])[1] if start.strip() == RECORDED else ""
    return [*notes, *([moved] if moved else [])]


def _about_markers(job: Job, tracking: str | None) -> list[str]:
    notes = []
    if job.recorded is not None and job.recorded.fitted is not None and job.recorded.fitted.mirrored:
        notes.append(
            "a right arm, mirrored to the left arm of the model: angles keep their anatomical meaning, "
            "positions are those of a left arm"
        )
    lengths = "those it came with" if job.own_lengths else "fitted to the person"
    notes.append(f"segment lengths of arm {job.arm.name}: {lengths}")
    if tracking is not None:
        why = "because markers are noisy and no arm is rigid"
        notes.append(f"tracking {tracking}, {why}; the other is --tracking exact")
    return notes


def _about_angles(job: Job) -> list[str]:
    what = "position" if job.path.rotation is None else "position and rotation"
    return [f"of the recorded angles the {what} of the hand of arm {job.arm.name} was taken and solved anew"]
