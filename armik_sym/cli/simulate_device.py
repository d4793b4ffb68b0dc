"""`armik simulate-device`: a measuring device without hardware, on a pseudo-terminal or a socket."""

from __future__ import annotations

import sys
import threading
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from armik_sym.cli.console import say
from armik_sym.cli.live_line import LiveLine
from armik_sym.cli.simulate_options import jumps, silences, socket_address, stuck_channels, times
from armik_sym.cli.stop_signals import stopping
from armik_sym.errors import OptionError, UnknownNameError

if TYPE_CHECKING:
    from armik_sym.arm.model import Arm
    from armik_sym.device.simulator import ServedDevice, SimulatedDevice
    from armik_sym.motion.joint_motion import JointMotion

_LOOK = 0.2


def simulate_device(
    motion: Annotated[
        str,
        typer.Argument(metavar="MOTION", help="Joint angles (.csv, .mot, .sto), or a bundled task."),
    ] = "brushing",
    arm: Annotated[str, typer.Option(help="Arm: a name (ehmcs, human, alfaiz) or a TOML file.")] = "ehmcs",
    joints: Annotated[
        int | None, typer.Option(help="How many joints are measured, from the base on; default: all.")
    ] = None,
    rate: Annotated[int, typer.Option(help="Samples per second.")] = 500,
    socket: Annotated[
        str | None,
        typer.Option(
            metavar="HOST:PORT", help="A TCP socket instead of a pseudo-terminal; port 0: any free."
        ),
    ] = None,
    link: Annotated[
        Path | None, typer.Option(help="Path of the pseudo-terminal; default: in a temporary folder.")
    ] = None,
    seconds: Annotated[
        float | None, typer.Option(help="Device time after which it ends; default: Ctrl-C ends it.")
    ] = None,
    speed: Annotated[
        float, typer.Option(help="Device seconds per second; 0: as fast as the reader takes them.")
    ] = 1.0,
    hold: Annotated[
        bool, typer.Option("--hold", help="Keep the last posture at the end; default: play back and forth.")
    ] = False,
    noise: Annotated[float, typer.Option(help="Noise of potentiometers, standard deviation, counts.")] = 0.5,
    linearity: Annotated[
        float, typer.Option(help="Non-linearity of potentiometers, fraction of full scale.")
    ] = 0.0,
    lost_counts: Annotated[float, typer.Option(help="Share of edges that encoders miss.")] = 0.0,
    damage: Annotated[float, typer.Option(help="Share of bytes that are damaged, for example 0.01.")] = 0.0,
    lose: Annotated[float, typer.Option(help="Share of bytes that are lost.")] = 0.0,
    insert: Annotated[float, typer.Option(help="Share of bytes behind which garbage is inserted.")] = 0.0,
    close_at: Annotated[
        str | None, typer.Option(metavar="T,T,...", help="Close the port at these seconds.")
    ] = None,
    closed_for: Annotated[float, typer.Option(help="Open it again after so many seconds.")] = 1.0,
    restart_at: Annotated[
        str | None, typer.Option(metavar="T,T,...", help="The device restarts, port open, at these seconds.")
    ] = None,
    silent: Annotated[
        list[str] | None,
        typer.Option(metavar="FROM[:TO]", help="Send nothing, port open, in these seconds; repeatable."),
    ] = None,
    stuck: Annotated[
        list[str] | None,
        typer.Option(metavar="CHANNEL:FROM[:TO]", help="A sensor that stops; channels from 0; repeatable."),
    ] = None,
    jump: Annotated[
        list[str] | None,
        typer.Option(metavar="CHANNEL:AT:COUNTS", help="A sensor that jumps; repeatable."),
    ] = None,
    protocol_version: Annotated[
        int | None, typer.Option(help="Version number in every frame; default: the right one.")
    ] = None,
    device_id: Annotated[
        int, typer.Option(help="Number of the device, decides how sensors are mounted.")
    ] = 1,
    seed: Annotated[int, typer.Option(help="Seed of noise, damage, and what encoders hold at power-up.")] = 0,
    calibration: Annotated[
        Path | None, typer.Option(help="Write the true calibration to this TOML file.")
    ] = None,
) -> None:
    """Play a motion as the bytes of a measuring device, with sensors, noise and faults on demand.

    Prints the port to give to `armik record --port`. It starts when the port is opened, and ends after
    --seconds or with Ctrl-C.
    """
    import armik_sym as ak
    from armik_sym.device.calibration import save_calibration
    from armik_sym.device.simulator import AtEnd, Faults, SimulatedDevice, sensors_of, true_calibration

    if seconds is not None and not seconds > 0:
        raise OptionError(f"--seconds is {seconds:g}, expected a positive number")
    if socket is not None and link is not None:
        raise OptionError("--link names a pseudo-terminal, --socket serves none: give one of them")
    faults = Faults(
        damaged_bytes=damage,
        lost_bytes=lose,
        inserted_bytes=insert,
        close_at=times("--close-at", close_at),
        closed_for=closed_for,
        silent=silences(silent),
        stuck=stuck_channels(stuck),
        jumps=jumps(jump),
        restart_at=times("--restart-at", restart_at),
        version=protocol_version,
    )
    chosen = ak.load_arm(arm)
    sensors = sensors_of(chosen, joints, device_id, noise, linearity, lost_counts)
    device = SimulatedDevice(
        _motion(motion, chosen, len(sensors)),
        sensors,
        device_id=device_id,
        rate=rate,
        seed=seed,
        faults=faults,
        at_end=AtEnd.HOLD if hold else AtEnd.SWING,
    )
    if calibration is not None:
        save_calibration(true_calibration(device, chosen), calibration)
        say(f"{calibration}: true calibration of device {device_id} for this power-up (--seed {seed})")
    with _served(device, socket, link, None if speed == 0 else speed, seconds) as served:
        _watch(served)
    served.check()


def _motion(name: str, arm: Arm, measured: int) -> JointMotion:
    """The motion of the joints that are measured, in the order of the arm."""
    import armik_sym as ak

    wanted = arm.joint_names[:measured]
    try:
        if name in ak.task_names():
            return _chosen(ak.load_task(name).measured, wanted)
        if not Path(name).suffix and not Path(name).exists():
            raise OptionError(
                f"no motion {name!r}: give a file of joint angles (.csv, .mot, .sto) or a bundled task: "
                f"{', '.join(ak.task_names())}"
            )
        return ak.read_motion(name, wanted)
    except UnknownNameError as error:
        raise OptionError(f"{name}: {error}: choose another --arm, or fewer --joints") from error


def _chosen(motion: JointMotion, wanted: tuple[str, ...]) -> JointMotion:
    missing = [joint for joint in wanted if joint not in motion.joint_names]
    if missing:
        raise UnknownNameError("column", missing[0], motion.joint_names)
    columns = [motion.joint_names.index(joint) for joint in wanted]
    return type(motion)(motion.time, motion.q[:, columns], wanted)


def _served(
    device: SimulatedDevice, socket: str | None, link: Path | None, speed: float | None, seconds: float | None
) -> AbstractContextManager[ServedDevice]:
    from armik_sym.device.simulator import serve_pty, serve_socket

    if socket is None:
        return serve_pty(device, speed, seconds, link)
    return serve_socket(device, speed, seconds, *socket_address(socket))


def _watch(served: ServedDevice) -> None:
    """Say where the device is, and how it goes until it ends."""
    info = served.device.info
    kinds = [channel.kind.name.lower() for channel in info.channels]
    say(
        f"device {info.device_id}: {info.rate:g} samples/s of {len(kinds)} channels, "
        f"{kinds.count('potentiometer')} potentiometers and {kinds.count('encoder')} encoders"
    )
    say(f"port: {served.port}\nrecord it: armik record --port {served.port} --out FILE")
    sys.stdout.flush()
    asked = threading.Event()
    with stopping(asked.set), LiveLine() as line:
        while not served.wait(_LOOK) and not asked.is_set():
            line.show(_progress(served) if len(served.truth) else "waiting for somebody to open the port")
    say(f"{'stopped: ' if asked.is_set() else ''}{_progress(served)}")


def _progress(served: ServedDevice) -> str:
    from armik_sym.device.simulator import Fate

    truth = served.truth
    sent = truth.count(Fate.WHOLE, Fate.TOUCHED, Fate.UNKNOWN)
    words = f"{len(truth) / served.device.rate:.1f} s, {sent} samples sent"
    for fate, what in ((Fate.TOUCHED, "of them damaged"), (Fate.NOT_SENT, "not sent")):
        if count := truth.count(fate):
            words += f", {count} {what}"
    return words
