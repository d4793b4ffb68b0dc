"""`python -m derivations`: the ledger on the terminal, or as `docs/ledger.md`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from derivations import plain_text
from derivations.claim import Claim
from derivations.ledger import EQUATIONS, PAPERS, all_claims, covered

PAGE = Path(__file__).resolve().parent.parent / "docs" / "ledger.md"


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the ledger; exit code 1 if a check contradicts it.

    Args:
        arguments: Command line, or None for that of the process.

    Returns:
        Exit code.

    Source:
        None (command line).
    """
    options = _parser().parse_args(arguments)
    if options.markdown:
        from derivations.markdown import page

        PAGE.write_text(page(), encoding="utf-8")
        sys.stdout.write(f"wrote docs/{PAGE.name}\n")
        return 0
    claims = _selected(options.paper, options.equation)
    if not claims:
        sys.stderr.write(_nothing_found(options.paper, options.equation))
        return 2
    wrong = 0
    for claim in claims:
        evidence = claim.check()
        wrong += evidence.verdict is not claim.verdict
        sys.stdout.write(plain_text.line(claim, evidence))
        if options.explain:
            sys.stdout.write(plain_text.explanation(claim, evidence))
        sys.stdout.flush()
    return 1 if wrong else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m derivations", description=__doc__)
    parser.add_argument("--paper", choices=sorted(PAPERS))
    parser.add_argument("--equation", help='one equation or table, for example 3 or "Table 4"')
    parser.add_argument(
        "--explain", action="store_true", help="printed form, derivation, correction, proof, counterexample"
    )
    parser.add_argument("--markdown", action="store_true", help="write docs/ledger.md instead")
    return parser


def _selected(paper: str | None, equation: str | None) -> list[Claim]:
    return [
        claim
        for claim in all_claims()
        if paper in (None, claim.paper) and (equation is None or _is_about(claim, equation))
    ]


def _is_about(claim: Claim, equation: str) -> bool:
    return equation.lower() in {name.lower() for name in (*covered(claim), claim.equation)}


def _nothing_found(paper: str | None, equation: str | None) -> str:
    known = []
    for name in [paper] if paper else list(PAPERS):
        last = max(int(number) for number in EQUATIONS[name] if number.isdigit())
        others = [claim.equation for claim in all_claims() if claim.paper == name]
        known.append(", ".join([f"{name}: 1 to {last}", *(e for e in others if not e[0].isdigit())]))
    return f"no equation {equation!r}; there are {'; '.join(known)}\n"


if __name__ == "__main__":
    sys.exit(main())
