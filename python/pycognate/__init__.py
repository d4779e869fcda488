"""ADAMS functions and multibody models on numpy arrays.

Examples
--------
>>> import pycognate as cg
>>> cg.expr("STEP5(TIME, 0, 0, 1, 10)*SIN(2*PI*TIME)")(0.25)
1.03515625
"""

from ._builder import Body, Element, Marker, ModelBuilder
from ._core import Expr, __version__
from ._errors import (
    ColumnError,
    Diagnostic,
    Error,
    ExprError,
    IncompleteRun,
    ModelError,
    ModelFileNotFound,
    ResultsError,
    ResultsFileNotFound,
)
from ._expr import expr
from ._linear import LinearSystem, Mode
from ._model import Model, Options, RunOptions, Session, run
from ._run import Animation, Run, get_results, read_res, read_results
from ._sweep import SweepTable, sweep
from ._verify import Verification

__all__ = [
    "Animation",
    "Body",
    "ColumnError",
    "Diagnostic",
    "Element",
    "Error",
    "Expr",
    "ExprError",
    "IncompleteRun",
    "LinearSystem",
    "Marker",
    "Mode",
    "Model",
    "ModelBuilder",
    "ModelError",
    "ModelFileNotFound",
    "Options",
    "ResultsError",
    "ResultsFileNotFound",
    "Run",
    "RunOptions",
    "Session",
    "SweepTable",
    "Verification",
    "__version__",
    "expr",
    "get_results",
    "read_res",
    "read_results",
    "run",
    "sweep",
]
