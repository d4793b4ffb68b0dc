"""`python -m derivations`: the ledger on the terminal."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from derivations.claim import Claim, Evidence
from derivations.ledger import all_claims


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the ledger; exit code 1 if a check contradicts it.

    Args:
        arguments: Command line, or None for that of the process.

    Returns:
        Exit code.

    Source:
        None (command line).
    """
    parser = argparse.ArgumentParser(prog="python -m derivations", description=__doc__)
    parser.add_argument("--paper", choices=sorted({claim.paper for claim in all_claims()}))
    parser.add_argument("--equation", help='one equation, for example "3" or "Table 4"')
    parser.add_argument("--explain", action="store_true", help="proof, correction and counterexample, too")
    options = parser.parse_args(arguments)
    wrong = 0
    for claim in all_claims():
        if options.paper not in (None, claim.paper) or options.equation not in (None, claim.equation):
            continue
        evidence = claim.check()
        wrong += evidence.verdict is not claim.verdict
        sys.stdout.write(_lines(claim, evidence, explain=options.explain))
    return 1 if wrong else 0


def _lines(claim: Claim, evidence: Evidence, *, explain: bool) -> str:
    text = f"{claim.paper:11s} {claim.equation:10s} {evidence.verdict.value:24s} {claim.title}\n"
    if evidence.verdict is not claim.verdict:
        text += f"    THE LEDGER SAYS {claim.verdict.value!r}\n"
    if explain:
        parts = {
            "says": claim.summary,
            "correction": claim.correction,
            "extraction": claim.extraction,
            "proof": evidence.proof,
            "counterexample": evidence.counterexample,
        }
        text += "".join(f"    {name}: {part}\n" for name, part in parts.items() if part) + "\n"
    return text


if __name__ == "__main__":
    sys.exit(main())
