"""`armik doctor`: is everything there, and if not, how to get it."""

from __future__ import annotations

import typer

from armik_sym.cli.console import say
from armik_sym.cli.failures import NOT_OK


def doctor() -> None:
    """Check that everything needed is there.

    Looks at Python packages, solver, C compiler, cache and bundled data.

    Exit code 0: everything essential is there; 1: something essential is missing.
    """
    from armik_sym.cli.doctor_checks import all_checks

    findings = []
    for check in all_checks():
        finding = check()
        findings.append(finding)
        say(f"{finding.state:8} {finding.what:18} {finding.detail}")
        if finding.remedy:
            say(f"{'':27} → {finding.remedy}")
    missing = [finding.what for finding in findings if finding.essential and finding.state != "found"]
    if missing:
        say(f"\nNot ready: {', '.join(missing)}.")
        raise typer.Exit(NOT_OK)
    say("\nReady.")
