"""Models that tests share."""

import os
import signal
from pathlib import Path

import pycognate as cg
import pytest

ROOT = Path(__file__).parents[2]
SLIDER_CRANK = ROOT / "examples" / "slider_crank.adm"

FALLING = """a falling ball
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
ACCGRAV/KGRAV=-10
PART/1, GROUND
MARKER/1, PART=1
!                             adams_view_name='ball'
PART/2, MASS=2, CM=2, IP=1,1,1
MARKER/2, PART=2
REQUEST/1, F4=DZ(2)\\, CNAMES="","","","Z","","","","", RESULTS_NAME=ball
END
"""

PUSHED = """a cart that a routine pushes
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/1, PART=1, REULER=90D,90D,0D
PART/2, MASS=2, CM=2, IP=1,1,1
MARKER/2, PART=2, REULER=90D,90D,0D
JOINT/1, TRANSLATIONAL, I=2, J=1
SFORCE/3, TRANSLATIONAL, I=2, J=1, ACTIONONLY, FUNCTION=USER(50)\\
END
"""


@pytest.fixture
def slider_crank():
    return cg.Model.read(SLIDER_CRANK)


@pytest.fixture
def falling():
    return cg.Model.from_text(FALLING)


@pytest.fixture
def pushed():
    return cg.Model.from_text(PUSHED)


@pytest.fixture(autouse=True)
def ctrl_c_interrupts():
    """Let Ctrl-C interrupt, also where a shell runs the tests in the background and has it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def pytest_terminal_summary(terminalreporter):
    """Says what was left out and why; where CI is true, that is a failure (`pytest_sessionfinish`)."""
    for report in terminalreporter.stats.get("skipped", []):
        why = report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr
        terminalreporter.write_line(f"left out: {report.nodeid}: {why}")


def pytest_sessionfinish(session):
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if os.environ.get("CI") == "true" and reporter and reporter.stats.get("skipped"):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED
