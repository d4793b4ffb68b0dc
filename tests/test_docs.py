"""Documentation that cannot drift: docstrings, README, examples and layout are checked here."""

from __future__ import annotations

import ast
import inspect
import re
import runpy
import statistics
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import armik_sym as ak

REPOSITORY = Path(__file__).resolve().parent.parent
PACKAGE = REPOSITORY / "armik_sym"
SOURCES = sorted(PACKAGE.rglob("*.py"))
EXAMPLES = sorted(
    [*(REPOSITORY / "examples").glob("0[1-46-9]_*.py"), *(REPOSITORY / "examples").glob("[1-9][0-9]_*.py")]
)

Function = ast.FunctionDef | ast.AsyncFunctionDef


def public_functions(file: Path) -> Iterator[tuple[str, Function]]:
    """Public module-level functions, and public methods of public classes."""
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, Function) and not node.name.startswith("_"):
            yield node.name, node
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            for item in node.body:
                if isinstance(item, Function) and not item.name.startswith("_"):
                    yield f"{node.name}.{item.name}", item


def is_property(node: Function) -> bool:
    names = [d.attr if isinstance(d, ast.Attribute) else getattr(d, "id", "") for d in node.decorator_list]
    return any("property" in name for name in names)


def arguments_of(node: Function) -> list[str]:
    every = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    return [argument.arg for argument in every if argument.arg not in ("self", "cls")]


def returns_something(node: Function) -> bool:
    return node.returns is not None and ast.unparse(node.returns) not in ("None", "Iterator[None]")


def functions_to_document() -> dict[str, Function]:
    return {
        f"{file.relative_to(REPOSITORY)}: {name}": node
        for file in SOURCES
        for name, node in public_functions(file)
        if not overrides_a_documented_one(file, name)
    }


def overrides_a_documented_one(file: Path, name: str) -> bool:
    """Methods that CasADi or a protocol defines are explained there; command bodies in the help text."""
    method = name.rpartition(".")[2]
    return method in {"get_n_in", "get_n_out", "get_name_in", "get_sparsity_in", "eval", "one", "many"} or (
        "cli" in file.parts
    )


TO_DOCUMENT = functions_to_document()


@pytest.mark.parametrize("where", TO_DOCUMENT)
def test_public_functions_state_arguments_units_errors_and_source(where: str) -> None:
    node = TO_DOCUMENT[where]
    text = ast.get_docstring(node) or ""
    assert text, f"{where} has no docstring"
    summary = text.splitlines()[0]
    assert summary.endswith((".", "?")), f"{where}: the summary is one line that ends with a full stop"
    if is_property(node):
        return
    arguments = arguments_of(node)
    if arguments:
        assert "Args:" in text, f"{where}: Args are missing"
        for argument in arguments:
            assert re.search(rf"^\s+\**{argument}:", text, re.MULTILINE), (
                f"{where}: {argument} is not explained"
            )
    if returns_something(node) and summary:
        assert "Returns:" in text or "Yields:" in text or not arguments, f"{where}: Returns is missing"
    if arguments:
        assert "Source:" in text, f"{where}: Source is missing"
    if any(isinstance(child, ast.Raise) and child.exc is not None for child in ast.walk(node)):
        assert "Raises:" in text, f"{where}: Raises is missing"


def test_public_names_exist_and_have_docstrings() -> None:
    for name in ak.__all__:
        value = getattr(ak, name)
        if inspect.isclass(value) or inspect.isfunction(value) or inspect.ismodule(value):
            assert inspect.getdoc(value), f"armik_sym.{name} has no docstring"


def test_files_stay_small() -> None:
    lengths = {file: len(file.read_text(encoding="utf-8").splitlines()) for file in SOURCES}
    longest = max(lengths, key=lambda file: lengths[file])
    assert lengths[longest] <= 400, longest
    assert statistics.median(lengths.values()) <= 150


def test_library_neither_prints_nor_asserts() -> None:
    for file in SOURCES:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            assert not isinstance(node, ast.Assert), f"{file}: assert"
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                assert node.func.id != "print", f"{file}: print"


LAYERS = [
    "arm",
    "symbolic",
    "elbow",
    "compiled",
    "swivel",
    "motion",
    "fitting",
    "device",
    "solution",
    "pointwise",
    "trajectory",
    "comparison",
    "servo",
    "report",
    "cli",
]
MAY_USE = {
    "arm": set(),
    "symbolic": {"arm"},
    "elbow": {"arm", "symbolic"},
    "compiled": {"arm", "symbolic"},
    "swivel": {"arm", "symbolic", "compiled", "motion"},
    "motion": {"arm"},
    "fitting": {"arm", "swivel", "motion"},
    "device": {"arm", "elbow", "motion"},
    "solution": {"arm", "symbolic", "motion"},
    "pointwise": {"arm", "symbolic", "compiled", "motion", "solution"},
    "trajectory": {"arm", "symbolic", "compiled", "swivel", "motion", "solution"},
    "comparison": {"arm", "symbolic", "compiled", "swivel", "motion", "solution"},
    "servo": {"arm", "motion"},
    "report": {"arm", "symbolic", "compiled", "swivel", "motion", "solution", "comparison", "servo"},
    "cli": {
        "arm",
        "symbolic",
        "compiled",
        "swivel",
        "motion",
        "solution",
        "pointwise",
        "trajectory",
        "fitting",
        "device",
        "comparison",
        "servo",
        "report",
    },
}


@pytest.mark.parametrize("layer", LAYERS)
def test_arrows_between_folders_run_downwards(layer: str) -> None:
    for file in sorted((PACKAGE / layer).rglob("*.py")):
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("armik_sym."):
                used = (node.module or "").split(".")[1]
                if used in LAYERS:
                    assert used in MAY_USE[layer] | {layer}, f"{file.name} imports {node.module}"


def code_blocks(file: Path, language: str) -> list[str]:
    return re.findall(
        rf"^```{language}\n(.*?)^```", file.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )


def test_readme_example_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (block,) = code_blocks(REPOSITORY / "README.md", "python")
    assert len([line for line in block.splitlines() if line.strip()]) <= 12
    monkeypatch.chdir(tmp_path)
    exec(compile(block, "README.md", "exec"), {})  # noqa: S102 - the README is ours


def test_readme_has_exactly_two_set_up_commands_and_ci_runs_them() -> None:
    commands = [block.strip() for block in code_blocks(REPOSITORY / "README.md", "sh")]
    assert len(commands) == 2
    assert all("\n" not in command and "pip install" in command for command in commands)
    assert "armik demo" in commands[0]
    assert "pytest" in commands[1]
    script = (REPOSITORY / ".ci" / "run").read_text(encoding="utf-8")
    assert "setup_command 1" in script
    assert "setup_command 2" in script


def test_links_in_the_documentation_lead_somewhere() -> None:
    for page in [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").glob("*.md"))]:
        for target in re.findall(r"\]\((?!https?:)([^)#]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), f"{page.name} links to {target}"


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(
    example: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(example), run_name="__main__")
    assert capsys.readouterr().out.strip()


def test_import_prints_nothing_and_leaves_matplotlib_alone() -> None:
    code = "import sys, armik_sym; sys.exit('matplotlib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
