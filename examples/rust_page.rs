//! The program of docs/rust.md, piece after piece; a test keeps both alike.
//!
//! `cargo run --example rust_page`

fn main() -> Result<(), cognate::Error> {
    use cognate::expr::{Evaluator, SharedEvaluator, ast::Dialect};

    let mut spring = Evaluator::parse("-25*(DM(1,2) - 10) - 2*VR(1,2)")?;
    spring.eval(&[12.0, 0.5])?;
    spring.gradient(&[12.0, 0.5])?;
    let shared = SharedEvaluator::parse("SIN(2*PI*TIME)", Dialect::Function)?;

    use cognate::expr::{Expr, Names};
    use cognate::scalar::Scalar;

    let names = Names::new()
        .variables(["x", "v"])
        .constant("g", 9.81)
        .define("hertz(x, k)", "k*MAX(x, 0)**1.5")
        .law("drag", |[v]| v * Scalar::abs(v))
        .function_with_slopes("map", |[x]| (x * x, [2.0 * x]));
    let f = Expr::parse_with("hertz(x, 2e5) - 0.3*drag(v) + g*map(x)", &names)?;
    Evaluator::new(f, &Default::default())?.gradient(&[0.01, 2.0])?;

    use cognate::{Analysis, ModelBuilder, Options};

    let builder = ModelBuilder::new("pendulum");
    builder.units("MKS").gravity([0.0, -9.81, 0.0]);
    let rod = builder
        .part("rod")
        .mass(2.0)
        .inertia([0.0, 0.2, 0.2])
        .center([0.5, 0.0, 0.0]);
    let tip = rod.at([1.0, 0.0, 0.0]);
    builder.revolute("hinge", &rod.at([0.0; 3]), &builder.ground());
    let mut session = builder.session(Options::default())?;
    session.add_column(&format!("DY({tip})"))?;
    session.run_to(Analysis::Dynamic, 1.0, 100)?;
    let height = session
        .run
        .column(&format!("DY({tip})"))
        .unwrap_or_default();

    use cognate::analysis::sweep::{Sweep, design};

    let model = builder.build()?;
    let mut sweep = Sweep::over(model, Analysis::Dynamic, 1.0, 100);
    sweep.parameter(&format!("PART/{rod}.MASS"))?;
    sweep.measure(&format!("max(abs(DY({tip})))"))?;
    let points = design::grid(&[vec![1.0, 2.0, 5.0]])?;
    for row in sweep.rows(&points, 2)? {
        println!("{:?} {:?} {}", row.values, row.measures, row.reason);
    }

    // what the page does not go on with
    assert_eq!(height.len(), 101);
    drop(shared);
    Ok(())
}
