"""The dialogue of `armik calibrate`: posture after posture, none of them lost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from armik_sym.cli.calibrate_input import TypedDialogue, setups_typed
from armik_sym.cli.console import say
from armik_sym.errors import ArmikError

if TYPE_CHECKING:
    from armik_sym.device.calibration import Calibration
    from armik_sym.device.calibration.posture_log import PostureLog
    from armik_sym.device.calibration.steps import Step
    from armik_sym.device.channels import DeviceInfo


@dataclass(frozen=True)
class Guided:
    """A guided calibration.

    Attributes:
        port: Port of the device.
        baud: Bits per second; None: the usual.
        out: The calibration to write; postures are kept beside it.
        arm: Name or file of the arm.
        channels: Channel of each joint; None: in their order.
        datasheet: Directions, if the scales are those of datasheets: the zero pose alone is taken then.
        thorough: Whether joints are also held half-way.
        seconds: How long each posture is recorded, in [s].

    Source:
        None (command line).
    """

    port: str
    baud: int | None
    out: Path
    arm: str
    channels: list[int] | None
    datasheet: str | None
    thorough: bool
    seconds: float

    def calibration(self, angle_error: float) -> Calibration:
        """Take the postures and fit them.

        Args:
            angle_error: How well their angles are known, in [rad].

        Returns:
            The calibration.

        Raises:
            CalibrationError: If the postures do not determine it, or cannot be taken.
            DeviceError: If the device cannot be read.
            KeyboardInterrupt: After Ctrl-C, or if the input ends.

        Source:
            None (command line).
        """
        from armik_sym.arm import load_arm
        from armik_sym.device.calibration import arm_setup, fit_calibration
        from armik_sym.device.calibration.guide import take_postures
        from armik_sym.device.calibration.posture_log import ENDING, PostureLog
        from armik_sym.device.calibration.steps import guided_steps
        from armik_sym.device.calibration.tap import open_tap

        with open_tap(self.port, _baud(self.baud)) as tap:
            info = tap.info()
            setups = arm_setup(load_arm(self.arm), info, self.channels)
            steps = guided_steps(setups, self.thorough)
            if self.datasheet is not None:
                setups, steps = setups_typed(setups, info, self.datasheet), steps[:1]
            _greet(info)
            log = PostureLog(self.out.with_suffix(ENDING), info, setups) if len(steps) > 1 else None
            if log is not None:
                _take_up(log, steps)
            try:
                postures = take_postures(tap, info, setups, steps, TypedDialogue(), self.seconds, log)
                return fit_calibration(info, postures, setups, angle_error=angle_error)
            except (typer.Abort, KeyboardInterrupt):
                _say_kept(log)
                raise KeyboardInterrupt from None
            except ArmikError:
                _say_kept(log)
                raise


def new_zeros(old: Path, port: str, seconds: float, baud: int | None) -> Calibration:
    """A calibration whose encoders have new zeros, from the zero pose alone.

    Args:
        old: The calibration.
        port: Port of the device.
        seconds: How long the pose is recorded, in [s].
        baud: Bits per second; None: the usual.

    Returns:
        The new calibration.

    Raises:
        CalibrationError: If the old one is another device's, or the pose cannot be taken.
        DeviceError: If the device cannot be read.

    Source:
        None (command line).
    """
    from armik_sym.device.calibration import JointSetup, load_calibration
    from armik_sym.device.calibration.guide import take_postures
    from armik_sym.device.calibration.steps import guided_steps
    from armik_sym.device.calibration.tap import open_tap

    calibration = load_calibration(old)
    with open_tap(port, _baud(baud)) as tap:
        info = tap.info()
        calibration.check_device(info)
        setups = [JointSetup(joint.joint, joint.channel) for joint in calibration.joints]
        (pose,) = take_postures(tap, info, setups, guided_steps(setups)[:1], TypedDialogue(), seconds)
    return calibration.rezeroed(pose.table)


def _baud(typed: int | None) -> int:
    from armik_sym.device.recording.port import DEFAULT_BAUD

    return DEFAULT_BAUD if typed is None else typed


def _greet(info: DeviceInfo) -> None:
    say(
        f"Device {info.device_id} ({info.firmware}), {len(info.channels)} sensors, {info.rate:g} samples "
        "per second. Keep it switched on until the end. Each posture is recorded when you press Enter; "
        "type another angle if you measured one (goniometer)."
    )


def _take_up(log: PostureLog, steps: Sequence[Step]) -> None:
    """Go on from postures that an earlier attempt left, if the device was on all the time since."""
    if not log.path.exists():
        return
    log.read()
    missing = [step.name for step in steps if step.name not in log.postures]
    if missing:
        say(f"\n{log.path} has postures taken before: {', '.join(log.postures)}.")
        go_on = typer.confirm(
            "Go on from there? Only if the device was switched on all the time since (n: they are replaced)",
            default=None,
        )
    else:
        say(f"\n{log.path} has all postures, taken before; --from fits them.")
        go_on = False
        typer.confirm("Take new ones and replace them?", default=None, abort=True)
    if not go_on:
        log.postures.clear()


def _say_kept(log: PostureLog | None) -> None:
    if log is not None and log.postures:
        say(
            f"\nThe postures taken are kept in {log.path}. The same command goes on from there while the "
            "device stays switched on; take a posture out of the file to hold it again, or correct an angle "
            "in it and fit it with --from."
        )
