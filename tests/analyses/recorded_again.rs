//! Rows of a sweep over numbers that are constants of the equations: each is the run of the changed model alone, to the bit,
//! with the same status and warnings, whichever rows came before it and whatever their programs had in common with its own.

use crate::running::{Analysis, Options, begin, sweep, whole};
use cognate::results::Status;

/// Numbers that fold, and numbers that do not.
const VALUES: [f64; 6] = [0.0, 1.0, -1.0, 0.5, 2.0, 0.37];

/// A model, the end of its run, its parameters with the value that each has, and its measures.
struct Case {
    name: &'static str,
    text: String,
    end: f64,
    parameters: &'static [(&'static str, f64)],
    measures: &'static [&'static str],
}

const FREE: &str = "PART/1, GROUND\nMARKER/1, PART=1\nMARKER/9, PART=1, QP=0,0,1\n\
    PART/2, MASS=1, CM=3, IP=1,2,3, QG=0.3,0.2,0.47, REULER=0.3,0.4,0.5, VX=0.4\nMARKER/2, PART=2\nMARKER/3, PART=2\n\
    MARKER/4, PART=2, QP=0.1,0.2,0.3, REULER=0.1,0.2,0.3\nACCGRAV/KGRAV=-9.81\n";

fn cases() -> Vec<Case> {
    let pendulum = pendulum!(
        "MARKER/23, PART=2, QP=0.5,0,0, REULER=0.2,0,0\nMARKER/3, PART=1, QP=0,1,0\n\
         SPRINGDAMPER/1, TRANSLATION, I=23, J=3, K=10, C=0.1, L=0.5\nFRICTION/1, JOINT=1, MU_STATIC=0.3, MU_DYNAMIC=0.2, PIN_RADIUS=0.02\n\
         SFORCE/3, ROTATION, I=21, J=1, FUNCTION=0.1*STEP(TIME,0.1,0,0.2,1)-0.3*WZ(21,1)\nEND\n"
    );
    let crank = include_str!("../../examples/slider_crank.adm");
    let andrews = include_str!("../data/references/a03_andrews.adm");
    let case = |name, text, end, parameters, measures| Case {
        name,
        text,
        end,
        parameters,
        measures,
    };
    vec![
        case(
            "pendulum",
            pendulum.to_string(),
            0.4,
            &[
                ("PART/2.MASS", 2.0),
                ("PART/2.IP(3)", 0.1),
                ("MARKER/20.QP(1)", 1.0),
                ("MARKER/23.QP(2)", 0.0),
                ("MARKER/23.REULER(1)", 0.2),
                ("SPRINGDAMPER/1.K", 10.0),
                ("SPRINGDAMPER/1.C", 0.1),
                ("ACCGRAV.JGRAV", -9.81),
                ("ACCGRAV.IGRAV", 0.0),
                ("FRICTION/1.MU_DYNAMIC", 0.2),
            ],
            &["last(AZ(21,1))", "max(FX(21,1))"],
        ),
        case(
            "slider-crank",
            crank.to_string(),
            0.1,
            &[
                ("PART/4.MASS", 1.0),
                ("PART/3.IP(3)", 950.0),
                ("MARKER/30.QP(1)", 75.0),
                ("MARKER/22.QP(2)", 0.0),
                ("MARKER/12.REULER(3)", 0.0),
                ("ACCGRAV.JGRAV", -9806.65),
            ],
            &["last(DX(41,11))", "max(MOTION(1,0,8,0))"],
        ),
        case(
            "andrews",
            andrews.to_string(),
            0.002,
            &[
                ("PART/4.MASS", 0.02373),
                ("PART/7.MASS", 0.00706),
                ("SPRINGDAMPER/1.K", 4530.0),
                ("SPRINGDAMPER/1.C", 0.0),
                ("MARKER/30.QP(1)", 0.014),
            ],
            &["last(DX(33,1))", "max(DM(29,30))"],
        ),
        case(
            "bushing and spline",
            format!(
                "free\n{FREE}BUSHING/1, I=4, J=9, K=40,30,20, KT=1,2,3, C=0.7,0.6,0.5, CT=0.1,0.2,0.3, FORCE=1,2,3\n\
                 SPLINE/1, X=-2,-1,0,1,2, Y=-3,-1,0,1,3\nVFORCE/1, I=2, JFLOAT=99, RM=1, FX=-AKISPL(DX(2),0,1), FY=0, FZ=IMPACT(DZ(2),VZ(2),0.5,100,1.5,7,0.02)\n\
                 MARKER/99, PART=1, FLOATING\nEND\n"
            ),
            0.4,
            &[
                ("PART/2.MASS", 1.0),
                ("PART/2.IP(1)", 1.0),
                ("BUSHING/1.K(1)", 40.0),
                ("BUSHING/1.CT(3)", 0.3),
                ("BUSHING/1.FORCE(2)", 2.0),
                ("MARKER/4.QP(1)", 0.1),
                ("MARKER/9.QP(3)", 1.0),
            ],
            &["last(DX(2))", "max(AX(4,9))"],
        ),
        case(
            "contact",
            format!(
                "ball\n{FREE}GRAPHICS/1, PLANE, RM=1\nGRAPHICS/2, ELLIPSOID, CM=2, XSCALE=1, YSCALE=1, ZSCALE=1\n\
                 CONTACT/1, IGEOM=2, JGEOM=1, IMPACT, STIFFNESS=1000, EXPONENT=1.5, DAMPING=7, DMAX=0.02\n\
                 , COULOMB_FRICTION=ON, MU_STATIC=0.3, MU_DYNAMIC=0.2, STICTION_TRANSITION_VELOCITY=0.01, FRICTION_TRANSITION_VELOCITY=0.02\nEND\n"
            ),
            0.2,
            &[
                ("PART/2.MASS", 1.0),
                ("CONTACT/1.STIFFNESS", 1000.0),
                ("CONTACT/1.EXPONENT", 1.5),
                ("CONTACT/1.MU_DYNAMIC", 0.2),
                ("ACCGRAV.KGRAV", -9.81),
            ],
            &["last(DZ(2))", "max(WX(2))"],
        ),
    ]
}

/// What a run has: measures by their bits, status, warnings, why it ended.
type Outcome = (Vec<u64>, Option<Status>, usize, String);

#[test]
fn rows_that_are_recorded_again_are_runs_of_the_changed_model_alone_to_the_bit() {
    let mut completed = 0;
    for Case {
        name,
        text,
        end,
        parameters,
        measures,
    } in cases()
    {
        let mut s = sweep(&text, end, 8);
        for (parameter, _) in parameters {
            s.parameter(parameter)
                .unwrap_or_else(|e| panic!("{name} {parameter}: {e}"));
        }
        for measure in measures {
            s.measure(measure)
                .unwrap_or_else(|e| panic!("{name} {measure}: {e}"));
        }
        let given: Vec<f64> = parameters.iter().map(|p| p.1).collect();
        let mut points = vec![given.clone()];
        for k in 0..given.len() {
            for factor in [1.01, 0.97] {
                let mut point = given.clone();
                point[k] *= factor;
                points.push(point);
            }
            // numbers that fold, whose products are 1, and that are those of another element
            let others = VALUES.into_iter().chain([1.0 / given[k], given[0]]);
            for value in others.filter(|x| x.is_finite()) {
                let mut point = given.clone();
                point[k] = value;
                points.push(point);
            }
        }
        // each number at a place and under loads of their own
        let shifted: Vec<f64> = given.iter().map(|x| x * 1.02).collect();
        for k in 0..given.len() {
            for factor in [1.0, 0.99] {
                let mut point = shifted.clone();
                point[k] *= factor;
                points.push(point);
            }
        }
        // all at once, and the first again
        points.push(given.iter().map(|x| x * 1.003).collect());
        points.push(given);
        let options = Options {
            columns: measures
                .iter()
                .map(|m| m[m.find('(').map_or(0, |k| k + 1)..m.len() - 1].to_string())
                .collect(),
            ..Options::default()
        };
        for row in s.rows(&points, 1).expect("rows") {
            let mut model = whole(&text);
            for (parameter, &x) in s.parameters().iter().zip(&row.values) {
                parameter.set(&mut model, x).expect("a number");
            }
            let mut alone = begin(model, "alone", options.clone());
            let expected: Outcome = match alone.run_to(Analysis::Transient, end, 8) {
                Ok(status) => {
                    let of = |m: &cognate::analysis::sweep::Measure| match status {
                        Status::Completed => m.of(&alone.run).to_bits(),
                        _ => f64::NAN.to_bits(),
                    };
                    let record = &alone.run.record;
                    (
                        s.measures().iter().map(of).collect(),
                        Some(status),
                        record.warnings.len(),
                        record.stop_reason.clone(),
                    )
                }
                Err(e) => (
                    vec![f64::NAN.to_bits(); measures.len()],
                    None,
                    0,
                    e.first().to_string(),
                ),
            };
            completed += usize::from(row.status == Status::Completed);
            let status = Some(row.status).filter(|&status| status != Status::Model);
            let bits = row.measures.iter().map(|x| x.to_bits()).collect();
            let found: Outcome = (bits, status, row.warnings, row.reason.clone());
            assert_eq!(found, expected, "{name} {:?}", row.values);
        }
    }
    assert!(completed > 130, "{completed} runs were completed");
}
