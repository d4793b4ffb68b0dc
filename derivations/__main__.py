"""`python -m derivations`: the ledger on the terminal, or as `docs/ledger.md`."""

from __future__ import annotations

import argparse
import re
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
    if options.markdown and (options.paper or options.equation or options.explain):
        sys.stderr.write("--markdown writes the whole ledger: leave out --paper, --equation and --explain\n")
        return 2
    claims = _selected(options.paper, options.equation)
    if not claims:
        sys.stderr.write(_nothing_found(options.paper, options.equation))
        return 2
    if options.markdown:
        return _write_page(claims)
    wrong = 0
    for claim in claims:
        evidence = claim.check()
        wrong += evidence.verdict is not claim.verdict
        sys.stdout.write(plain_text.line(claim, evidence))
        if options.explain:
            sys.stdout.write(plain_text.explanation(claim, evidence))
        sys.stdout.flush()
    return 1 if wrong else 0


def _write_page(claims: list[Claim]) -> int:
    from derivations.markdown import page

    wrong = [claim for claim in claims if claim.check().verdict is not claim.verdict]
    if wrong:
        names = ", ".join(f"{claim.paper} {claim.equation}" for claim in wrong)
        sys.stderr.write(f"nothing written: the checks contradict the ledger in {names}\n")
        return 1
    PAGE.write_text(page(), encoding="utf-8")
    sys.stdout.write(f"wrote docs/{PAGE.name}\n")
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m derivations", description=__doc__)
    parser.add_argument("--paper", choices=sorted(PAPERS))
    parser.add_argument("--equation", help='an equation, a span or a table: 3, 7-9, "Table 4"')
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
    """Whether a claim is about one equation or one of a span: "8", "(8)", "7-9", "Table 4", "A_1", "A1"."""
    names = {_plain(name) for name in (*covered(claim), claim.equation)}
    if claim.equation.startswith("A_1"):
        names |= {f"a{k}" for k in range(1, 8)} | {"a1-a7"}
    wanted = _plain(equation)
    span = re.fullmatch(r"(\d+)-(\d+)", wanted)
    every = {wanted} if span is None else {str(k) for k in range(int(span[1]), int(span[2]) + 1)}
    return bool(names & (every | {wanted}))


def _plain(name: str) -> str:
    return re.sub(r"[\s()_]", "", name.lower()).replace("…", "-").replace("..", "-")


def _nothing_found(paper: str | None, equation: str | None) -> str:
    known = []
    for name in [paper] if paper else list(PAPERS):
        last = max(int(number) for number in EQUATIONS[name] if number.isdigit())
        others = [claim.equation for claim in all_claims() if claim.paper == name]
        known.append(", ".join([f"{name}: 1 to {last}", *(e for e in others if not e[0].isdigit())]))
    return f"no equation {equation!r}; there are {'; '.join(known)}\n"


if __name__ == "__main__":
    sys.exit(main())
