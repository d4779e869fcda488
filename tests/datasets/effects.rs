//! Arguments that are accepted have an effect, or it is said that they have none.
//!
//! Each argument of each statement is changed in a model where its statement matters: what comes out must be
//! different, or something else must be said. What matters to other programs alone (drawings, prints, units of
//! columns) is not asked for here.

use crate::running::{self, Analysis};
use cognate::analysis::session::Options;
use cognate::analysis::watch::Unwatched;
use cognate::dataset::{self};
use cognate::internals::dataset::manual::{self, Effect};
use cognate::internals::dataset::row::Argument;
use cognate::internals::dataset::statement::STATEMENTS;
use cognate::internals::dataset::value::Kind;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Ground, with the markers that all models use.
const BASE: &str = "\
UNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=METER, TIME=SECOND
PART/1, GROUND
MARKER/10, PART=1
MARKER/11, PART=1, QP=0,1,0
MARKER/12, PART=1, REULER=90D,90D,0
MARKER/13, PART=1, FLOATING
";
const ARM: &str = "PART/2, MASS=2, CM=20, IP=.1,.2,.3
MARKER/20, PART=2, QP=1,0,0
MARKER/21, PART=2
";
const HINGE: &str = "JOINT/1, REVOLUTE, I=21, J=10\n";
const WEIGHT: &str = "ACCGRAV/JGRAV=-9.81\n";

/// What comes out of a model, and all that is said of it.
fn outcome(text: &str, analysis: Analysis) -> String {
    let reading = dataset::read_text(text);
    let mut said = String::new();
    for d in &reading.diagnostics {
        let _ = writeln!(said, "{:?} {} {}", d.element, d.code, d.message);
    }
    if reading.failed() {
        return said;
    }
    let options = || Options {
        full: true,
        ..running::options(
            &["DX(20,10)+DY(20,10)", "VX(20,10)", "WZ(20,10)", "AZ(20,10)"],
            1e-6,
        )
    };
    let options = || Options {
        error: None,
        ..options()
    };
    let session = running::begin(reading.model.clone(), "effect", options());
    for d in session
        .preview(analysis, 0.3)
        .iter()
        .chain(&reading.model.doubts())
    {
        let _ = writeln!(said, "{:?} {} {}", d.element, d.code, d.message);
    }
    let mut session = running::begin(reading.model, "effect", options());
    match session.simulate(analysis, 0.3, 6, &mut Unwatched) {
        Err(errors) => {
            for d in errors {
                let _ = writeln!(said, "{:?} {} {}", d.element, d.code, d.message);
            }
        }
        Ok(status) => {
            let _ = writeln!(said, "{status:?} {}", session.run.record.stop_reason);
        }
    }
    for w in &session.run.record.warnings {
        let _ = writeln!(said, "{} {}", w.code, w.sentence());
    }
    for column in &session.run.columns {
        let _ = write!(said, "{} {:?} ", column.name, column.unit);
        let bits: Vec<u64> = column.values.iter().map(|x| x.to_bits()).collect();
        let _ = writeln!(said, "{bits:?}");
    }
    for event in &session.run.log {
        let _ = writeln!(said, "{event:?}");
    }
    said
}

/// Values to try for an argument.
fn values(argument: &Argument) -> Vec<String> {
    let list = |n: usize, of: &str| vec![vec![of; n.clamp(1, 36)].join(",")];
    match argument.kind {
        Kind::Flag => vec![String::new()],
        Kind::Id => vec!["20".into(), "2".into()],
        Kind::Ids { min, .. } => list(min, "20"),
        Kind::Real { .. } => vec!["0.37".into(), "0.011".into()],
        Kind::Reals { min, .. } => list(min, "0.37"),
        Kind::Word(words) | Kind::Words(words) if words.is_empty() => vec!["T".into()],
        Kind::Word(words) | Kind::Words(words) => words.iter().map(ToString::to_string).collect(),
        Kind::Text | Kind::Raw => vec!["else".into()],
        Kind::Texts => vec!["\"else\"".into()],
        Kind::Formula => vec!["0.37".into()],
    }
}

const CASES: &[(&str, &[&str], &str, Analysis)] = &[
    (
        "PART/2",
        &["MASS=2", "CM=20", "IP=.1,.2,.3", "QG=1,0,0", "WX=1", "WY=2"],
        "SFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=1\nMARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2, REULER=1,1,1\n",
        Analysis::Dynamic,
    ),
    (
        "POINT_MASS/2",
        &["MASS=2", "CM=20", "QG=1,0,0", "VX=1"],
        "SFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=1\nMARKER/20, POINT_MASS=2, QP=1,0,0\n",
        Analysis::Dynamic,
    ),
    (
        "MARKER/30",
        &["PART=2", "QP=.1,.2,.3"],
        "PART/2, MASS=2, CM=20, IP=.1,.2,.3\nMARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2\nJOINT/1, REVOLUTE, I=30, J=10\n",
        Analysis::Dynamic,
    ),
    (
        "JOINT/1",
        &["REVOLUTE", "I=21", "J=10", "IC=0.1,1"],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "JOINT/1",
        &["TRANSLATIONAL", "I=21", "J=12", "IC=0.1,1"],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "JOINT/1",
        &["CYLINDRICAL", "I=21", "J=12", "ICTRAN=0.1,1", "ICROT=0.1,1"],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "JOINT/1",
        &["SCREW", "I=21", "J=12", "PITCH=0.3"],
        "$ARMJOINT/2, CYLINDRICAL, I=21, J=12\n",
        Analysis::Dynamic,
    ),
    (
        "JOINT/1",
        &["SPHERICAL", "I=21", "J=10"],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "JOINT/1",
        &["FIXED", "I=21", "J=10"],
        "$ARM",
        Analysis::Transient,
    ),
    (
        "JPRIM/1",
        &["ATPOINT", "I=21", "J=10"],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "MOTION/1",
        &["JOINT=1", "ROTATIONAL", "FUNCTION=TIME"],
        "$ARM$HINGE",
        Analysis::Transient,
    ),
    (
        "MOTION/1",
        &["JOINT=1", "ROTATIONAL", "VELOCITY", "FUNCTION=TIME"],
        "$ARM$HINGE",
        Analysis::Transient,
    ),
    (
        "MOTION/1",
        &["JOINT=1", "ROTATIONAL", "ACCELERATION", "FUNCTION=TIME"],
        "$ARM$HINGE",
        Analysis::Transient,
    ),
    (
        "MOTION/1",
        &["I=21", "J=10", "X", "FUNCTION=TIME"],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "COUPLER/1",
        &["JOINTS=1,2", "TYPE=R:T", "SCALES=1,2"],
        "$WEIGHT$ARM$HINGEPART/3, MASS=1, CM=30, IP=1,1,1\nMARKER/30, PART=3\nJOINT/2, TRANSLATIONAL, I=30, J=12\n",
        Analysis::Dynamic,
    ),
    (
        "GEAR/1",
        &["JOINTS=1,2", "CV=14"],
        "$ARM$HINGEPART/3, MASS=1, CM=30, IP=1,1,1\nMARKER/30, PART=3, QP=0,1,0\nJOINT/2, REVOLUTE, I=30, J=11\nMARKER/14, PART=1, QP=0,0.3,0, REULER=90D,90D,0\n",
        Analysis::Dynamic,
    ),
    (
        "GCON/1",
        &["FUNCTION=DX(20,10)-1"],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "CURVE/1",
        &["CLOSED", "MATRIX=1", "CURVE_POINTS"],
        "$ARMMATRIX/1, FULL=RORDER, ROWS=5, COLUMNS=3, VALUES=1,0,0,0,1,0,-1,0,0,0,-1,0,1,0,0\nPTCV/1, CURVE=1, RM=10, I=20, JFLOAT=13\nJPRIM/2, INPLANE, I=20, J=10\nJOINT/9, PLANAR, I=20, J=10\n",
        Analysis::Dynamic,
    ),
    (
        "CURVE/1",
        &["OPEN", "FUNCTION=USER(1)", "MINPAR=-1", "MAXPAR=1"],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "PTCV/1",
        &["CURVE=1", "RM=10", "I=20", "JFLOAT=13"],
        "$ARMCURVE/1, CLOSED, MATRIX=1, CURVE_POINTS\nMATRIX/1, FULL=RORDER, ROWS=5, COLUMNS=3, VALUES=1,0,0,0,1,0,-1,0,0,0,-1,0,1,0,0\nJOINT/9, PLANAR, I=20, J=10\n",
        Analysis::Dynamic,
    ),
    (
        "CVCV/1",
        &[
            "ICURVE=2",
            "IRM=20",
            "IFLOAT=22",
            "JCURVE=1",
            "JRM=10",
            "JFLOAT=13",
        ],
        "PART/2, MASS=1, CM=20, IP=1,1,1, QG=1.5,0,0\nMARKER/20, PART=2\nMARKER/22, PART=2, FLOATING\nCURVE/1, CLOSED, MATRIX=1, CURVE_POINTS\nMATRIX/1, FULL=RORDER, ROWS=5, COLUMNS=3, VALUES=1,0,0,0,1,0,-1,0,0,0,-1,0,1,0,0\nCURVE/2, CLOSED, MATRIX=2, CURVE_POINTS\nMATRIX/2, FULL=RORDER, ROWS=5, COLUMNS=3, VALUES=.5,0,0,0,.5,0,-.5,0,0,0,-.5,0,.5,0,0\nJOINT/9, PLANAR, I=20, J=10\n",
        Analysis::Dynamic,
    ),
    (
        "SFORCE/1",
        &["TRANSLATIONAL", "I=20", "J=11", "FUNCTION=TIME"],
        "$ARM$HINGE",
        Analysis::Dynamic,
    ),
    (
        "SFORCE/1",
        &["ROTATIONAL", "I=21", "J=10", "ACTIONONLY", "FUNCTION=TIME"],
        "$ARM$HINGE",
        Analysis::Dynamic,
    ),
    (
        "VFORCE/1",
        &["I=20", "JFLOAT=13", "RM=10", "FX=1", "FY=2", "FZ=0"],
        "$ARM$HINGE",
        Analysis::Dynamic,
    ),
    (
        "VTORQUE/1",
        &["I=20", "JFLOAT=13", "RM=10", "TX=1", "TY=2", "TZ=3"],
        "$ARM$HINGE",
        Analysis::Dynamic,
    ),
    (
        "GFORCE/1",
        &[
            "I=20",
            "JFLOAT=13",
            "RM=10",
            "FX=1",
            "FY=2",
            "FZ=0",
            "TX=1",
            "TY=2",
            "TZ=3",
        ],
        "$ARM$HINGE",
        Analysis::Dynamic,
    ),
    (
        "SPRINGDAMPER/1",
        &[
            "TRANSLATIONAL",
            "I=20",
            "J=11",
            "K=10",
            "C=1",
            "LENGTH=1",
            "FORCE=2",
        ],
        "$ARM$HINGE",
        Analysis::Dynamic,
    ),
    (
        "SPRINGDAMPER/1",
        &[
            "ROTATIONAL",
            "I=21",
            "J=10",
            "KT=10",
            "CT=1",
            "ANGLE=1",
            "TORQUE=2",
        ],
        "$ARM$HINGE",
        Analysis::Dynamic,
    ),
    (
        "BUSHING/1",
        &[
            "I=21",
            "J=10",
            "K=10,20,30",
            "C=1,2,3",
            "FORCE=1,2,3",
            "KT=1,2,3",
            "CT=1,2,3",
            "TORQUE=1,2,3",
        ],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "FIELD/1",
        &[
            "I=21",
            "J=10",
            "KMATRIX=10,0,0,0,0,0,0,10,0,0,0,0,0,0,10,0,0,0,0,0,0,10,0,0,0,0,0,0,10,0,0,0,0,0,0,10",
            "CRATIO=0.1",
            "LENGTH=1,0,0,0,0,0",
            "FORCE=1,1,1,1,1,1",
        ],
        "$ARM",
        Analysis::Dynamic,
    ),
    (
        "BEAM/1",
        &[
            "I=20",
            "J=10",
            "LENGTH=1",
            "IXX=1",
            "IYY=1",
            "IZZ=1",
            "AREA=1",
            "ASY=1.2",
            "ASZ=1.2",
            "EMODULUS=100",
            "GMODULUS=50",
            "CRATIO=0.01",
        ],
        "$WEIGHT$ARMGFORCE/1, I=20, JFLOAT=13, RM=10, FX=0, FY=0, FZ=3, TX=1, TY=1, TZ=1\n",
        Analysis::Dynamic,
    ),
    (
        "NFORCE/1",
        &["IMARKERS=20", "J=10", "KMATRIX=1", "CRATIO=0.1"],
        "$WEIGHT$ARM$HINGEMATRIX/1, FULL=RORDER, ROWS=6, COLUMNS=6, VALUES=10,0,0,0,0,0,0,10,0,0,0,0,0,0,10,0,0,0,0,0,0,10,0,0,0,0,0,0,10,0,0,0,0,0,0,10\n",
        Analysis::Dynamic,
    ),
    (
        "CONTACT/1",
        &[
            "IGEOM=1",
            "JGEOM=2",
            "IMPACT",
            "STIFFNESS=1000",
            "DAMPING=10",
            "DMAX=.01",
            "EXPONENT=1.5",
        ],
        "$ARM$WEIGHTGFORCE/1, I=20, JFLOAT=13, RM=10, FX=0, FY=0, FZ=3, TX=1, TY=1, TZ=1\nGRAPHICS/1, ELLIPSOID, CM=20, XSCALE=.2, YSCALE=.2, ZSCALE=.2\nGRAPHICS/2, PLANE, RM=15, XMIN=-9, XMAX=9, YMIN=-9, YMAX=9\nMARKER/15, PART=1, QP=0,-.11,0, REULER=0,-90D,0\n",
        Analysis::Dynamic,
    ),
    (
        "CONTACT/1",
        &[
            "IGEOM=1",
            "JGEOM=2",
            "POISSON",
            "PENALTY=1000",
            "RESTITUTION_COEFFICIENT=.5",
            "COULOMB_FRICTION=ON",
            "MU_STATIC=.3",
            "MU_DYNAMIC=.2",
            "STICTION_TRANSITION_VELOCITY=.01",
            "FRICTION_TRANSITION_VELOCITY=.1",
        ],
        "PART/2, MASS=2, CM=20, IP=.1,.2,.3, VX=1\nMARKER/20, PART=2, QP=1,0,0\nMARKER/21, PART=2\n$WEIGHTGRAPHICS/1, ELLIPSOID, CM=20, XSCALE=.2, YSCALE=.2, ZSCALE=.2\nGRAPHICS/2, PLANE, RM=15, XMIN=-9, XMAX=9, YMIN=-9, YMAX=9\nMARKER/15, PART=1, QP=0,-.11,0, REULER=0,-90D,0\n",
        Analysis::Dynamic,
    ),
    (
        "FRICTION/1",
        &[
            "JOINT=1",
            "MU_STATIC=.3",
            "MU_DYNAMIC=.2",
            "STICTION_TRANSITION_VELOCITY=.01",
            "MAX_STICTION_DEFORMATION=.01",
            "EFFECT=ALL",
            "INPUTS=ALL",
            "FRICTION_TORQUE_PRELOAD=1",
            "FRICTION_ARM=.1",
            "BENDING_REACTION_ARM=.5",
            "PIN_RADIUS=.2",
        ],
        "$ARM$HINGE",
        Analysis::Dynamic,
    ),
    (
        "FRICTION/1",
        &[
            "JOINT=1",
            "MU_STATIC=.3",
            "MU_DYNAMIC=.2",
            "STICTION_TRANSITION_VELOCITY=.01",
            "MAX_STICTION_DEFORMATION=.01",
            "EFFECT=ALL",
            "INPUTS=ALL",
            "FRICTION_FORCE_PRELOAD=1",
            "REACTION_ARM=.1",
            "INITIAL_OVERLAP=.5",
            "OVERLAP_DELTA=INCREASE",
        ],
        "$ARMJOINT/1, TRANSLATIONAL, I=21, J=12, IC=0.1,1\n",
        Analysis::Dynamic,
    ),
    (
        "FRICTION/1",
        &[
            "JOINT=1",
            "MU_STATIC=.3",
            "MU_DYNAMIC=.2",
            "STICTION_TRANSITION_VELOCITY=.01",
            "BALL_RADIUS=.2",
        ],
        "$ARMJOINT/1, SPHERICAL, I=21, J=10\n",
        Analysis::Dynamic,
    ),
    (
        "FRICTION/1",
        &[
            "JOINT=1",
            "MU_STATIC=.3",
            "MU_DYNAMIC=.2",
            "STICTION_TRANSITION_VELOCITY=.01",
            "PIN_RADIUS=.2",
        ],
        "$ARMJOINT/1, CYLINDRICAL, I=21, J=12, ICTRAN=0,1, ICROT=0,1\n",
        Analysis::Dynamic,
    ),
    (
        "FRICTION/1",
        &[
            "JOINT=1",
            "MU_STATIC=.3",
            "MU_DYNAMIC=.2",
            "MAX_STICTION_DEFORMATION=.01",
        ],
        "$ARMJOINT/1, TRANSLATIONAL, I=21, J=12\nACCGRAV/JGRAV=-9.81, IGRAV=1\n",
        Analysis::Dynamic,
    ),
    (
        "FRICTION/1",
        &[
            "JOINT=1",
            "MU_STATIC=.3",
            "MU_DYNAMIC=.2",
            "FRICTION_TORQUE_PRELOAD=1",
        ],
        "$ARM$HINGE$WEIGHTSFORCE/1, ROTATIONAL, I=21, J=10, FUNCTION=-3*AZ(21,10)+9\n",
        Analysis::Static,
    ),
    (
        "VARIABLE/1",
        &["IC=1", "FUNCTION=TIME"],
        "$ARM$HINGESFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=VARVAL(1)\n",
        Analysis::Dynamic,
    ),
    (
        "VARIABLE/1",
        &["IC=1", "FUNCTION=VARVAL(1)**2-2+VARVAL(1)"],
        "$ARM$HINGESFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=VARVAL(1)\n",
        Analysis::Dynamic,
    ),
    (
        "DIFF/1",
        &["IC=1", "FUNCTION=-DIF(1)"],
        "$ARM$HINGESFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=DIF(1)\n",
        Analysis::Dynamic,
    ),
    (
        "DIFF/1",
        &["IC=1", "FUNCTION=2-DIF(1)"],
        "$ARM$HINGESFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=DIF(1)\n$WEIGHT",
        Analysis::Static,
    ),
    (
        "DIFF/1",
        &["IC=1,2", "IMPLICIT", "FUNCTION=DIF1(1)+DIF(1)"],
        "$ARM$HINGESFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=DIF(1)\n$WEIGHT",
        Analysis::Dynamic,
    ),
    ("ARRAY/4", &["IC", "NUMBERS=1"], "$LSE", Analysis::Dynamic),
    ("ARRAY/2", &["U", "VARIABLES=1"], "$LSE", Analysis::Dynamic),
    ("ARRAY/1", &["X"], "$LSE", Analysis::Dynamic),
    ("ARRAY/3", &["Y"], "$LSE", Analysis::Dynamic),
    (
        "LSE/1",
        &["X=1", "U=2", "Y=3", "IC=4", "A=1", "B=2", "C=3", "D=4"],
        "$LSE",
        Analysis::Dynamic,
    ),
    (
        "LSE/1",
        &["X=1", "U=2", "Y=3", "IC=4", "A=1", "B=2", "C=3", "D=4"],
        "$LSE",
        Analysis::Static,
    ),
    (
        "MATRIX/1",
        &["FULL=RORDER", "ROWS=1", "COLUMNS=1", "VALUES=-1"],
        "$LSE",
        Analysis::Dynamic,
    ),
    (
        "TFSISO/1",
        &["X=1", "U=2", "Y=3", "NUMERATOR=1", "DENOMINATOR=1,1"],
        "$TF",
        Analysis::Dynamic,
    ),
    (
        "TFSISO/1",
        &["X=1", "U=2", "Y=3", "NUMERATOR=1", "DENOMINATOR=1,1"],
        "$TF",
        Analysis::Static,
    ),
    (
        "GSE/1",
        &["X=1", "U=2", "Y=3", "NS=1", "NO=1", "FUNCTION=USER(1)"],
        "$TF",
        Analysis::Dynamic,
    ),
    (
        "SPLINE/1",
        &["X=0,1,2,3,4", "Y=0,1,4,9,16"],
        "$ARM$HINGESFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=AKISPL(10*TIME+2,0,1)\n",
        Analysis::Dynamic,
    ),
    ("STRING/1", &["STRING=abc"], "$ARM$HINGE", Analysis::Dynamic),
    (
        "SENSOR/1",
        &["VALUE=0.1", "GE", "FUNCTION=TIME**2+0.03", "HALT"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "SENSOR/1",
        &["VALUE=0.05", "GE", "FUNCTION=TIME**2+0.03", "PRINT"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "SENSOR/1",
        &["VALUE=0.05", "GE", "FUNCTION=TIME**2+0.03", "PRINT"],
        "$ARM$HINGEMOTION/1, ROTATIONAL, JOINT=1, FUNCTION=TIME\n",
        Analysis::Kinematic,
    ),
    (
        "SENSOR/1",
        &[
            "VALUE=0.05",
            "EQ",
            "ERROR=0.001",
            "FUNCTION=TIME**2+0.03",
            "PRINT",
        ],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "SENSOR/1",
        &[
            "VALUE=0.05",
            "EQ",
            "ERROR=0.001",
            "FUNCTION=TIME**2+0.03",
            "EVALUATE=TIME",
            "STEPSIZE=.01",
            "DT=.01",
        ],
        "$ARM$HINGESFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=SENVAL(1)\n$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "REQUEST/1",
        &["DISPLACEMENT", "I=20", "J=11", "RM=10"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "REQUEST/1",
        &["F2=TIME", "F3=DX(20)"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "MREQUEST/1",
        &["DISPLACEMENT", "PARTS=ALL", "RM=10"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "MREQUEST/1",
        &["FORCE", "JOINTS=ALL", "RM=10"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "ACCGRAV/SETTING",
        &["IGRAV=1", "JGRAV=-9"],
        "$ARM$HINGE",
        Analysis::Dynamic,
    ),
    (
        "INTEGRATOR/SETTING",
        &["GSTIFF", "ERROR=1E-4"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "INTEGRATOR/SETTING",
        &["HHT", "ERROR=1E-4"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "INTEGRATOR/SETTING",
        &["NEWMARK", "ERROR=1E-4"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "EQUILIBRIUM/SETTING",
        &["ERROR=1E-4"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Static,
    ),
    (
        "KINEMATICS/SETTING",
        &["ERROR=1E-4"],
        "$ARM$HINGEMOTION/1, ROTATIONAL, JOINT=1, FUNCTION=TIME\n",
        Analysis::Kinematic,
    ),
    (
        "IC/SETTING",
        &["ERROR=1E-4"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "PREFERENCES/SETTING",
        &["SOLVER=CXX"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "DEBUG/SETTING",
        &["EPRINT"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "LSOLVER/SETTING",
        &["CALAHAN"],
        "$ARM$HINGE$WEIGHT",
        Analysis::Dynamic,
    ),
    (
        "OUTPUT/SETTING",
        &["REQSAVE"],
        "$ARM$HINGE$WEIGHTREQUEST/1, D, I=20, J=11\n",
        Analysis::Dynamic,
    ),
    (
        "RESULTS/SETTING",
        &["XRF"],
        "$ARM$HINGE$WEIGHTREQUEST/1, D, I=20, J=11\n",
        Analysis::Dynamic,
    ),
    (
        "RESULTS/SETTING",
        &["XRF"],
        "$ARMJOINT/9, PLANAR, I=21, J=10\nPTCV/1, CURVE=1, I=20, RM=10\nCURVE/1, CLOSED, MATRIX=1, CURVE_POINTS\nMATRIX/1, FULL=RORDER, ROWS=5, COLUMNS=3, VALUES=1,0,0,0,1,0,-1,0,0,0,-1,0,1,0,0\nSFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=VARVAL(1)\nVARIABLE/1, FUNCTION=TIME\nGRAPHICS/1, PLANE, RM=12\nGRAPHICS/2, ELLIPSOID, CM=20, XSCALE=.1, YSCALE=.1, ZSCALE=.1\nCONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=1E3, DAMPING=1, DMAX=.01, EXPONENT=1.5\n",
        Analysis::Dynamic,
    ),
];

const LSE: &str = "$ARM$HINGESFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=ARYVAL(3,1)
VARIABLE/1, FUNCTION=TIME
ARRAY/1, X
ARRAY/2, U, VARIABLES=1
ARRAY/3, Y
ARRAY/4, IC, NUMBERS=1
MATRIX/1, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES=-1
MATRIX/2, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES=2
MATRIX/3, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES=3
MATRIX/4, FULL=RORDER, ROWS=1, COLUMNS=1, VALUES=4
LSE/1, X=1, U=2, Y=3, IC=4, A=1, B=2, C=3, D=4
";
const TF: &str = "$ARM$HINGESFORCE/1, TRANSLATIONAL, I=20, J=11, FUNCTION=ARYVAL(3,1)
VARIABLE/1, FUNCTION=TIME+1
ARRAY/1, X
ARRAY/2, U, VARIABLES=1
ARRAY/3, Y
ARRAY/4, IC, NUMBERS=1
";

/// Arguments that change nothing here, and why that is no fault; `*`: all of a statement.
const EXEMPT: &[(&str, &str, &str)] = &[
    ("GSE", "*", "it needs a routine"),
    ("STRING", "*", "routines read it"),
    ("PART", "EXACT", "these models are assembled as drawn"),
    ("POINT_MASS", "EXACT", "these models are assembled as drawn"),
    (
        "MARKER",
        "NODE_ID",
        "an argument of markers on flexible bodies",
    ),
    (
        "MARKER",
        "NODE_LABEL",
        "an argument of markers on flexible bodies",
    ),
    ("MARKER", "VALUE", "an argument of markers on curves"),
    ("SPLINE", "BLOCK", "a part of the FILE"),
    ("SPLINE", "CHANNEL", "a part of the FILE"),
    ("MATRIX", "NAME", "a part of the FILE"),
    ("MATRIX", "FULL", "one number"),
    ("MATRIX", "SPARSE", "one number"),
    ("NFORCE", "IMARKERS", "there is one only"),
    ("CONTACT", "TYPE", "the geometries say it"),
    (
        "EQUILIBRIUM",
        "ERROR",
        "rest is found better than asked for",
    ),
    (
        "EQUILIBRIUM",
        "IMBALANCE",
        "rest is found better than asked for",
    ),
    ("EQUILIBRIUM", "MAXIT", "few are needed"),
    ("EQUILIBRIUM", "STABILITY", "the stiffness is regular"),
    ("EQUILIBRIUM", "TLIMIT", "a pendulum turns"),
    ("EQUILIBRIUM", "STATICS", "what is done without it"),
    ("EQUILIBRIUM", "DEFAULT", "what is done without it"),
    ("IC", "ERROR", "nothing is redundant"),
    ("INTEGRATOR", "MAXIT", "few are needed"),
    ("RESULTS", "XRF", "what is done without it"),
    ("RESULTS", "FORMATTED", "a form of the file"),
    ("OUTPUT", "REQSAVE", "the program writes the file"),
    ("OUTPUT", "GRSAVE", "the program writes the file"),
    ("REQUEST", "COMMENT", "a text"),
    ("MREQUEST", "COMMENT", "a text"),
    ("REQUEST", "CLABELS", "texts"),
    ("REQUEST", "CUNITS", "texts"),
    ("REQUEST", "TITLE", "texts"),
    (
        "KINEMATICS",
        "HMAX",
        "states are found to rounding in any steps",
    ),
    ("CONTACT", "MAX_STICTION_DEFORMATION", "it slides"),
    ("SENSOR", "RESTART", "what every trigger does"),
];

fn is_exempt(keyword: &str, word: &str) -> bool {
    let mut all = EXEMPT.iter();
    all.any(|(k, w, _)| *k == keyword && (*w == "*" || *w == word))
}

/// The statements of a case, but for the one that is examined.
fn rest_of(head: &str, rest: &str) -> String {
    let named = [
        ("$LSE", LSE),
        ("$TF", TF),
        ("$ARM", ARM),
        ("$HINGE", HINGE),
        ("$WEIGHT", WEIGHT),
    ];
    let all = named.iter().fold(rest.to_owned(), |text, (name, what)| {
        text.replace(name, what)
    });
    let head = format!("{head},");
    let others = all.lines().filter(|line| !line.starts_with(&head));
    others.fold(BASE.to_owned(), |text, line| text + line + "\n")
}

/// Returns the arguments with another value of one, or with it, or without it.
fn changed(arguments: &[&str], word: &str, value: &str) -> Vec<String> {
    let mut all: Vec<String> = arguments.iter().map(ToString::to_string).collect();
    let given = all.iter().position(|a| a.split('=').next() == Some(word));
    let written = if value.is_empty() {
        word.to_owned()
    } else {
        format!("{word}={value}")
    };
    match given {
        Some(k) if value.is_empty() => {
            all.remove(k);
        }
        Some(k) => all[k] = written,
        None => all.push(written),
    }
    all
}

#[test]
fn accepted_arguments_have_an_effect_or_it_is_said_that_they_have_none() {
    let mut has_effect: BTreeMap<String, bool> = BTreeMap::new();
    for (head, arguments, rest, analysis) in CASES {
        let keyword = head.split('/').next().expect("a head");
        let rest = rest_of(head, rest);
        let head = head.trim_end_matches("SETTING");
        let text = |all: &[String]| {
            let all = format!("{head}, {}", all.join("\n, ")).replacen("/, ", "/", 1);
            format!("TEST\n{rest}{all}\nEND\n")
        };
        let as_is: Vec<String> = arguments.iter().map(ToString::to_string).collect();
        let before = outcome(&text(&as_is), *analysis);
        let mut rows = STATEMENTS.iter();
        let row = rows
            .find(|s| s.keyword().eq_ignore_ascii_case(keyword))
            .expect("a row");
        for argument in row.arguments() {
            let word = argument.keyword();
            let known = has_effect
                .entry(format!("{keyword} {word}"))
                .or_insert(false);
            if *known || is_exempt(keyword, &word) {
                *known = true;
                continue;
            }
            let tried = values(&argument);
            let is_told = |line: &str| line.contains(" ignored ") && line.contains(&word);
            if row.is_idle() || before.lines().any(is_told) {
                *known = before.contains(" ignored ");
                continue;
            }
            *known = tried.iter().any(|value| {
                outcome(&text(&changed(arguments, &word, value)), *analysis) != before
            });
        }
    }
    let silent: Vec<&String> = has_effect
        .iter()
        .filter(|(_, has)| !**has)
        .map(|(key, _)| key)
        .collect();
    assert!(
        silent.is_empty(),
        "accepted without effect, and not told: {silent:#?}"
    );
}

#[test]
fn the_manual_says_kept_of_all_that_is_told_to_have_no_effect() {
    for (_, page) in manual::all() {
        let row = page.row().expect("a row of the tables");
        if row.is_idle() {
            assert_ne!(page.effect, Effect::Solved, "{}", page.keyword);
        }
        for entry in page.entries().iter().filter(|e| e.argument.idle) {
            let (keyword, argument) = (page.keyword, entry.note.name);
            assert_eq!(entry.note.effect, Effect::Kept, "{keyword} {argument}");
        }
    }
}
