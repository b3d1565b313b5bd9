"""The package itself: examples, documents, stubs."""

import ast
import os
import re
import subprocess
import sys

import possibility
import pytest
from conftest import ROOT, SHORT_WALK

EXAMPLES = sorted((ROOT / "python/examples").glob("*.py"))
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)
DOCUMENTS = {"docs/python.md": 8, "README.md": 1}


def code_lines(code):
    return [line for line in code.splitlines() if line.strip() and not line.strip().startswith("#")]


@pytest.fixture
def workplace(plan, tmp_path, monkeypatch):
    """A folder that looks like the project's, with a plan."""
    for folder in ("models", "experiments"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    plan.save(tmp_path / "plan")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    return tmp_path


EXPECTED = {"block_move": "solved: 12 ", "van_der_pol": "solved: 2.8672",
            "brachistochrone": "solved: 1.80160", "exports": ", 34) ",
            "scenario_in_code": "survives", "joint_torques": "joint_torques.png"}


def needs_matplotlib(code):
    if "matplotlib" in code:
        pytest.importorskip("matplotlib", reason="python3-matplotlib is not installed")


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_runs(example, workplace):
    needs_matplotlib(example.read_text())
    done = subprocess.run([sys.executable, str(example)], cwd=workplace, capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stderr
    assert EXPECTED[example.stem] in done.stdout


@pytest.mark.parametrize("document", DOCUMENTS)
def test_the_code_of_the_documents_runs(document, workplace):
    blocks = BLOCK.findall((ROOT / document).read_text())
    assert len(blocks) >= DOCUMENTS[document]
    names = {"__name__": "document"}
    for block in blocks:
        needs_matplotlib(block)
        assert len(code_lines(block)) <= 15
        exec(compile(block, document, "exec"), names)


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_short(example):
    code = example.read_text().split('"""', 2)[2]
    assert len(code_lines(code)) <= 18


def test_the_stubs_name_everything_of_the_extension():
    folder = os.path.dirname(possibility.__file__)
    assert os.path.exists(os.path.join(folder, "py.typed"))
    with open(os.path.join(folder, "_possibility.pyi")) as file:
        tree = ast.parse(file.read())
    stubs = {node.name: node for node in tree.body
             if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    extension = possibility._possibility
    assert set(stubs) == {name for name in dir(extension) if not name.startswith("__")}
    for name, node in stubs.items():
        if not isinstance(node, ast.ClassDef) or name == "InputError":
            continue
        documented = {each.name for each in node.body if isinstance(each, ast.FunctionDef)}
        real = {each for each in vars(getattr(extension, name)) if not each.startswith("_")}
        assert documented - {"__init__"} == real, name


def test_all_names_exist():
    for name in possibility.__all__:
        assert hasattr(possibility, name), name


def test_importing_is_quiet():
    done = subprocess.run([sys.executable, "-W", "error", "-c", "import possibility"],
                          capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_built_scenario_can_be_planned_by_the_program(workplace):
    """The scenario beside a saved plan is complete."""
    scenario = possibility.load_scenario("plan/scenario.yaml")
    assert scenario.name == SHORT_WALK["name"]
    assert possibility.load_plan("plan").is_current
