"""What `armik solve` writes beside a solution whose arm was fitted to markers."""

from __future__ import annotations

from pathlib import Path

from armik_sym.cli.solve_input import Job
from armik_sym.errors import OptionError


def check_arm_file(job: Job, arm: str | None, folder: Path, stem: str) -> None:
    """Refuse to overwrite the arm that was read by the one that was fitted.

    Args:
        job: What is to be solved.
        arm: What was typed as arm.
        folder: The folder of the results.
        stem: First part of their names.

    Raises:
        OptionError: If both are the same file.

    Source:
        None (command line).
    """
    target = _arm_file(folder, stem)
    if job.fits and arm is not None and target.exists() and Path(arm).exists() and target.samefile(arm):
        raise OptionError(f"{target}: would be overwritten by the fitted arm: choose another --out")


def write_fit(job: Job, folder: Path, stem: str, notes: list[str]) -> list[Path]:
    """Write the fitted arm, and the report of the fit.

    Args:
        job: What was solved.
        folder: Where to; it exists.
        stem: First part of all file names.
        notes: What a reader has to know.

    Returns:
        The files: `<stem>_fit.txt`, and `<stem>_arm.toml` if the lengths were fitted; none without markers.

    Raises:
        ArmFileError: If the arm cannot be written.
        MotionFileError: If the report cannot be written.

    Source:
        None (command line).
    """
    from armik_sym.arm.save_arm import save_arm
    from armik_sym.motion.text_file import write_lines

    if job.recorded is None or job.recorded.fitted is None:
        return []
    report = folder / f"{stem}_fit.txt"
    write_lines(
        report, [job.recorded.name, "", job.recorded.report, "", *(f"note: {note}" for note in notes)]
    )
    return [save_arm(job.arm, _arm_file(folder, stem)), report] if job.fits else [report]


def _arm_file(folder: Path, stem: str) -> Path:
    return folder / f"{stem}_arm.toml"
