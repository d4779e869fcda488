"""Notebooks: that of the examples runs from its first cell to its last; long runs show a bar."""

from pathlib import Path

import pytest
from conftest import FALLING
from test_model import SWINGING

EXAMPLES = Path(__file__).parents[1] / "examples"


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda p: p.name)
@pytest.mark.filterwarnings("default")
def test_notebook_runs(path):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    pytest.importorskip("matplotlib")
    pytest.importorskip("pandas")
    notebook = nbformat.read(path, as_version=4)
    client = nbclient.NotebookClient(
        notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": EXAMPLES}}
    )
    client.execute()
    tables = [
        output
        for cell in notebook.cells
        if cell.cell_type == "code"
        for output in cell.outputs
        if "text/html" in output.get("data", {})
    ]
    assert len(tables) >= 2


BAR = """
import pycognate as cg

cg._progress._QUIET_FOR = {quiet}
model = cg.Model.from_text({text!r})
run = model.run(end={end}, steps={steps})
print(run.status)
"""


def displayed(code):
    """Run a cell; return its status line and everything that it has shown on the way."""
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    shown = []

    class Watching(nbclient.NotebookClient):
        def process_message(self, msg, cell, cell_index):
            if msg["msg_type"] in ("display_data", "update_display_data"):
                shown.append(msg["content"]["data"])
            return super().process_message(msg, cell, cell_index)

    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(code)])
    Watching(notebook, timeout=120, startup_timeout=120, kernel_name="python3").execute()
    # warnings go to the other stream
    streams = [output for output in notebook.cells[0].outputs if output.get("name") == "stdout"]
    texts = [output.get("text", "") for output in streams]
    return "".join(texts).strip(), shown


@pytest.mark.filterwarnings("default")
def test_a_long_run_shows_a_bar_in_a_notebook_that_moves_and_goes():
    code = BAR.replace("steps={steps}", "steps=10, limit=3.0")
    status, shown = displayed(code.format(text=SWINGING, end=1e9, quiet=0.5))
    assert status == "limit"
    bars = [data["text/html"] for data in shown]
    assert len(bars) >= 3 and all("<progress" in bar for bar in bars[:-1]) and bars[-1] == ""
    assert len(set(bars)) >= 3 and " of 1e+09" in bars[0]


@pytest.mark.filterwarnings("default")
def test_a_short_run_shows_nothing_in_a_notebook():
    status, shown = displayed(BAR.format(text=FALLING, end=0.01, steps=2, quiet=60))
    assert status == "completed" and shown == []
