//! Command files of Adams View, against the dataset that says the same, and against laws.

use cognate::dataset::{self, Reading, Source};
use cognate::diagnostic::{Diagnostic, Severity};
use cognate::model::{Formula, Model, Orientation};
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
use proptest::prelude::*;
use std::collections::BTreeMap;

const HEAD: &str = "model create model_name = m\n\
    defaults units length = mm angle = deg force = newton mass = kg time = sec\n";

fn read(text: &str) -> Reading {
    dataset::read_source(Source::from_text(Some("model.cmd"), text))
}

fn errors(reading: &Reading) -> Vec<&Diagnostic> {
    let all = reading.diagnostics.iter();
    all.filter(|d| d.severity == Severity::Error).collect()
}

/// The model of a text that has no mistake.
#[track_caller]
fn sound(text: &str) -> Model {
    let reading = read(text);
    assert!(errors(&reading).is_empty(), "{:#?}", errors(&reading));
    reading.model
}

/// A part of mass 1 with a marker at its centre.
fn part(name: &str) -> String {
    format!(
        "part create rigid_body name_and_position part_name = .m.{name} location = 0,0,0 orientation = 0,0,0\n\
         marker create marker_name = .m.{name}.cm location = 0,0,0\n\
         part create rigid_body mass_properties part_name = .m.{name} mass = 1 ixx = 1 iyy = 1 izz = 1 &\n\
           center_of_mass_marker = .m.{name}.cm\n"
    )
}

fn text_of(formula: &Formula) -> String {
    match formula {
        Formula::Expression { text, .. } => text.to_string(),
        Formula::User { .. } => panic!("an expression"),
    }
}

#[test]
fn a_mechanism_of_commands_is_that_of_statements() {
    let commands = format!(
        "{HEAD}! ground\nmarker create marker_name = .m.ground.pivot adams_id = 1 location = 0,0,0\n\
         part create rigid_body name_and_position part_name = .m.rod adams_id = 2 &\n  \
           location = 100.0, 0.0, 0.0 orientation = 90.0d, 0.0d, 0.0d\n\
         marker create marker_name = .m.rod.cm adams_id = 20 location = 0,0,0 orientation = 0,0,0\n\
         marker create marker_name = .m.rod.end adams_id = 21 location = 0, 100, 0 orientation = 270.0d,0,0\n\
         part create rigid_body mass_properties part_name = .m.rod mass = 2 ixx = 30 iyy = 30 izz = 4 &\n  \
           center_of_mass_marker = .m.rod.cm\n\
         constraint create joint revolute joint_name = .m.hinge adams_id = 1 &\n  \
           i_marker_name = .m.rod.end j_marker_name = .m.ground.pivot\n\
         constraint create motion_generator motion_name = .m.drive adams_id = 4 joint_name = .m.hinge &\n  \
           type_of_freedom = rotational function = \"30D*SIN(TIME)\", &\n  \" + 0*AZ(.m.rod.end, .m.ground.pivot)*0\"\n\
         force create body gravitational gravity_field_name = g y_component = -9806.65\n\
         simulation single_run transient type = kinematic end_time = 2 number_of_steps = 20\n"
    );
    let statements = "Adams View model name: m\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\n\
        ! adams_view_name='ground'\nPART/1, GROUND\n! adams_view_name='pivot'\nMARKER/1, PART=1\n\
        ! adams_view_name='rod'\nPART/2, QG=100,0,0, REULER=90D,0D,0D, MASS=2, CM=20, IP=30,30,4\n\
        ! adams_view_name='cm'\nMARKER/20, PART=2\n\
        ! adams_view_name='end'\nMARKER/21, PART=2, QP=0,100,0, REULER=270D,0D,0D\n\
        ! adams_view_name='hinge'\nJOINT/1, REVOLUTE, I=21, J=1\n\
        ! adams_view_name='drive'\nMOTION/4, JOINT=1, ROTATIONAL, FUNCTION=30D*SIN(TIME) + 0*AZ(21, 1)*0\n\
        ACCGRAV/JGRAV=-9806.65\nOUTPUT/REQSAVE, GRSAVE\nRESULTS/XRF\nEND\n";
    let reading = read(&commands);
    assert!(errors(&reading).is_empty(), "{:#?}", errors(&reading));
    let dataset = dataset::read_text(statements).model;
    assert_eq!(reading.model.to_text(), dataset.to_text());
    assert_eq!(
        reading.commands.as_deref(),
        Some("SIMULATE/KINEMATIC, END=2, STEPS=20\n")
    );
}

#[test]
fn abbreviations_line_ends_and_case_change_nothing() {
    let whole = format!("{HEAD}{}", part("rod"));
    let short = whole
        .replace(
            "part create rigid_body name_and_position",
            "Part cre rig name",
        )
        .replace("mass_properties", "mass")
        .replace("center_of_mass_marker", "CENTER")
        .replace("marker_name", "marker")
        .replace(" location", " & ! here\n  loc")
        .replace('\n', "\r\n");
    assert_eq!(sound(&whole).to_text(), sound(&short).to_text());
}

#[test]
fn numbers_are_in_the_units_of_the_file_unless_they_carry_their_own() {
    let text = format!(
        "{HEAD}{}material create material_name = .m.light density = (2000(kg/meter**3))\n\
         variable create variable_name = .m.k real_value = (10(newton-m/rad))\n\
         part create rigid_body name_and_position part_name = .m.box location = (2.5cm), (1inch), 0\n\
         marker create marker_name = .m.box.corner location = 0,0,0\n\
         geometry create shape block block_name = .m.box.b corner_marker = .m.box.corner &\n \
           diag_corner_coords = (10cm), 50, (0.02meter)\n\
         part create rigid_body mass_properties part_name = .m.box material_type = .m.light\n\
         force create element_like bushing bushing_name = .m.mount i_marker_name = .m.rod.cm &\n \
           j_marker_name = .m.box.corner stiffness = 1,2,3 tstiffness = (.m.k), 0, 2 damping = 0,0,0\n",
        part("rod")
    );
    let model = sound(&text);
    let bushing = model.bushings.values().next().expect("a bushing");
    let degree = std::f64::consts::PI / 180.0;
    // 10 N m/rad are 10000 N mm/rad; two newton millimetres per degree are 360/pi per radian
    assert!((bushing.stiffness[3] - 1e4).abs() < 1e-9);
    assert!((bushing.stiffness[5] - 2.0 / degree).abs() < 1e-12);
    let part = model.parts.values().last().expect("a box");
    assert_eq!(part.qg, [25.0, 25.4, 0.0]);
    assert!((part.mass - 2e-6 * 100.0 * 50.0 * 20.0).abs() < 1e-15);
}

/// The pose of the last marker of a model in ground.
fn last_marker(model: &Model) -> Isometry3<f64> {
    let rotation = |orientation: &Orientation| {
        let Orientation::Euler([a, b, c]) = *orientation else {
            return Rotation3::identity();
        };
        let z = |x| Rotation3::from_axis_angle(&Vector3::z_axis(), x);
        z(a) * Rotation3::from_axis_angle(&Vector3::x_axis(), b) * z(c)
    };
    let pose = |p: [f64; 3], orientation: &Orientation| {
        let turn = UnitQuaternion::from_rotation_matrix(&rotation(orientation));
        Isometry3::from_parts(Translation3::new(p[0], p[1], p[2]), turn)
    };
    let (&id, marker) = model.markers.last_key_value().expect("a marker");
    let body = model
        .body_of(id)
        .and_then(|id| model.body(id))
        .expect("a part");
    pose(body.qg, &body.orientation) * pose(marker.qp, &marker.orientation)
}

/// A pose by three angles in degrees about the axes of a sequence.
fn posed(p: [f64; 3], angles: [f64; 3], axes: [usize; 3], is_body: bool) -> Isometry3<f64> {
    let about = |k: usize, x: f64| {
        let axis = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()][k];
        UnitQuaternion::from_axis_angle(&axis, x.to_radians())
    };
    let [a, b, c] = [0, 1, 2].map(|k| about(axes[k], angles[k]));
    let turn = if is_body { a * b * c } else { c * b * a };
    Isometry3::from_parts(Translation3::new(p[0], p[1], p[2]), turn)
}

fn same(a: &Isometry3<f64>, b: &Isometry3<f64>) -> bool {
    let far = (a.translation.vector - b.translation.vector).norm();
    far < 1e-9 && a.rotation.angle_to(&b.rotation) < 1e-7
}

fn listed(x: [f64; 3]) -> String {
    format!("{:?}, {:?}, {:?}", x[0], x[1], x[2])
}

fn triples() -> impl Strategy<Value = ([f64; 3], [f64; 3])> {
    (
        prop::array::uniform3(-50.0..50.0),
        prop::array::uniform3(-170.0..170.0),
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    /// Parts in ground, markers in their parts or relative to other markers, in every sequence of
    /// angles.
    #[test]
    fn frames_compose_in_every_sequence_of_angles(
        of_part in triples(), of_marker in triples(), of_other in triples(), which in 0..4_usize,
    ) {
        let (word, axes, is_body) = [
            ("body313", [2, 0, 2], true),
            ("body123", [0, 1, 2], true),
            ("space321", [2, 1, 0], false),
            ("body321", [2, 1, 0], true),
        ][which];
        let text = format!(
            "{HEAD}defaults units orientation_type = {word}\n\
             part create rigid_body name_and_position part_name = .m.a location = {} orientation = {}\n\
             marker create marker_name = .m.a.first location = {} orientation = {}\n\
             part create rigid_body name_and_position part_name = .m.b location = 1,2,3 orientation = 10,20,30\n\
             marker create marker_name = .m.b.second location = {} orientation = {} relative_to = .m.a.first\n",
            listed(of_part.0), listed(of_part.1), listed(of_marker.0), listed(of_marker.1),
            listed(of_other.0), listed(of_other.1),
        );
        let of = |(p, angles): ([f64; 3], [f64; 3])| posed(p, angles, axes, is_body);
        let expected = of(of_part) * of(of_marker) * of(of_other);
        let reading = read(&text);
        prop_assert!(same(&last_marker(&reading.model), &expected), "{}", reading.model.to_text());
    }

    /// What LOC_RELATIVE_TO and ORI_RELATIVE_TO give is what `relative_to` gives, whatever part the
    /// marker is on and whatever frame holds by default.
    #[test]
    fn functions_of_places_are_places_in_frames(
        of_part in triples(), of_marker in triples(), of_other in triples(), by_default in any::<bool>(),
    ) {
        let default = if by_default { "defaults coordinate_system default = .m.ground\n" } else { "" };
        let text = |marker: &str| format!(
            "{HEAD}part create rigid_body name_and_position part_name = .m.a location = {} orientation = {}\n\
             marker create marker_name = .m.a.first location = {} orientation = {}\n\
             part create rigid_body name_and_position part_name = .m.b location = 1,2,3 orientation = 10,20,30\n\
             {default}marker create marker_name = .m.b.second {marker}\n",
            listed(of_part.0), listed(of_part.1), listed(of_marker.0), listed(of_marker.1),
        );
        let (p, angles) = (listed(of_other.0), listed(of_other.1));
        let by_frame = format!("location = {p} orientation = {angles} relative_to = .m.a.first");
        let by_function = format!(
            "location = (LOC_RELATIVE_TO({{{p}}}, .m.a.first)) orientation = (ORI_RELATIVE_TO({{{angles}}}, .m.a.first))"
        );
        let [a, b] = [by_frame, by_function].map(|marker| last_marker(&read(&text(&marker)).model));
        prop_assert!(same(&a, &b), "{a} {b}");
    }

    /// An axis along a line: that axis points to the other point.
    #[test]
    fn axes_lie_along_lines(of_part in triples(), to in prop::array::uniform3(-50.0..50.0), k in 0..3_usize) {
        let letter = ["x", "y", "z"][k];
        let text = format!(
            "{HEAD}marker create marker_name = .m.ground.to location = {}\n\
             part create rigid_body name_and_position part_name = .m.a location = {} orientation = {}\n\
             marker create marker_name = .m.a.m location = 0,0,0 &\n  \
             orientation = (ORI_ALONG_AXIS(.m.a, .m.ground.to, \"{letter}\"))\n",
            listed(to), listed(of_part.0), listed(of_part.1),
        );
        let pose = last_marker(&read(&text).model);
        let way = Vector3::from(to) - Vector3::from(of_part.0);
        let axis = pose.rotation * [Vector3::x(), Vector3::y(), Vector3::z()][k];
        prop_assert!((axis - way.normalize()).norm() < 1e-8);
    }
}

/// Volumes of Adams' own shapes: ends of a link are half 20-gons, corners of a plate arcs, its
/// re-entrant corner a fillet. The centre is that of a saved file (VehLib, `BHPlate1.cmd`).
#[test]
fn masses_are_those_that_view_computes() {
    let corners = [[3.0, 3.0], [2.9, 3.25], [3.0, 3.6], [2.75, 3.4], [2.7, 3.2]];
    let mut text = String::from(
        "model create model_name = m\ndefaults units length = meter\n\
         part create rigid_body name_and_position part_name = .m.p location = 0,0,0\n",
    );
    for (k, [x, z]) in corners.iter().enumerate() {
        text += &format!("marker create marker_name = .m.p.c{k} location = {x}, 3, {z}\n");
    }
    text += "geometry create shape plate plate_name = .m.p.plate marker_name = .m.p.c0, .m.p.c1, &\n\
        .m.p.c2, .m.p.c3, .m.p.c4 width = 0.05 radius = 0.02\n\
        part create rigid_body mass_properties part_name = .m.p density = 1000\n";
    let model = sound(&text);
    let part = model.parts.values().last().expect("a plate");
    let cm = &model.markers[&part.cm.expect("a marker at the centre")];
    for (x, right) in cm.qp.iter().zip([2.862_000_897_8, 3.0, 3.293_732_187]) {
        assert!((x - right).abs() < 2e-9, "{:?}", cm.qp);
    }
    assert!((part.mass - 1000.0 * 0.05 * 0.111_659_237).abs() < 1e-6);
}

#[test]
fn loops_and_branches_make_what_they_say() {
    let text = format!(
        "{HEAD}variable set variable_name = .m.n integer_value = 4\n\
         for variable_name = k start_value = 1 end_value = (eval(.m.n))\n\
           if condition = (k == 3)\n continue\n end\n\
           part create rigid_body name_and_position part_name = (eval(\".m.p\" // RTOI(k))) location = (k*10), 0, 0\n\
           if condition = (k > 3 || db_exists(\".m.no\"))\n\
             marker create marker_name = (eval(\".m.p\" // RTOI(k) // \".tip\")) location = (-(k + 1)), 0, 0\n\
           elseif condition = (k == 1)\n\
             marker create marker_name = (eval(\".m.p\" // RTOI(k) // \".root\")) location = 0,0,0\n\
           else\n marker create marker_name = (eval(\".m.p\" // RTOI(k) // \".other\")) location = 0,0,0\n end\n\
         end\n"
    );
    let reading = read(&text);
    let mut names = reading
        .model
        .parts
        .values()
        .map(|p| p.place.name.clone().unwrap_or_default());
    assert_eq!(
        names.by_ref().collect::<Vec<_>>(),
        ["ground", "p1", "p2", "p4"]
    );
    let markers = reading.model.markers.values();
    let names: Vec<_> = markers
        .map(|m| m.place.name.clone().unwrap_or_default())
        .collect();
    assert_eq!(names, ["root", "other", "tip"]);
    assert_eq!(reading.model.parts[&4].qg, [40.0, 0.0, 0.0]);
}

#[test]
fn measures_and_springs_become_what_view_writes() {
    let text = format!(
        "{HEAD}marker create marker_name = .m.ground.base location = 0,0,-300\n{}\
         ude create instance instance_name = .m.spring definition_name = .MDI.Forces.spring\n\
         variable modify variable_name = .m.spring.i_marker object_value = .m.rod.cm\n\
         variable modify variable_name = .m.spring.j_marker object_value = (.m.ground.base)\n\
         variable modify variable_name = .m.spring.stiffness_mode string_value = \"linear\"\n\
         variable modify variable_name = .m.spring.stiffness_coefficient real_value = 20.0\n\
         variable modify variable_name = .m.spring.damping_mode string_value = \"none\"\n\
         variable modify variable_name = .m.spring.free_length_mode string_value = \"Design_Length\"\n\
         variable modify variable_name = .m.spring.preload real_value = (.m.rod.mass * 9806.65 * 1.0E-03)\n\
         measure create object measure_name = .m.speed object = .m.rod characteristic = cm_angular_velocity component = z_component\n\
         measure create function measure_name = .m.twice function = \"2*.m.speed + DZ(.m.rod.cm)\"\n",
        part("rod")
    );
    let model = sound(&text);
    let force = text_of(&model.sforces.values().next().expect("a spring").function);
    assert_eq!(force, "- 20.0*(dm(2,1)-300.0) + 0 + 9.80665");
    let of = |name: &str| {
        let mut all = model.variables.values();
        let found = all.find(|v| v.place.name.as_deref() == Some(name));
        text_of(&found.expect("a variable").function)
    };
    assert_eq!(of("spring.deformation"), "DM(2,1) - 300.0");
    assert_eq!(of("speed"), "RTOD*WZ(2,0,0)");
    assert_eq!(of("twice"), "2*VARVAL(4) + DZ(2)");
}

#[test]
fn what_is_switched_off_is_no_part_of_the_model() {
    let text = format!(
        "{HEAD}{}{}constraint create joint fixed joint_name = .m.held i_marker_name = .m.a.cm j_marker_name = .m.b.cm\n\
         constraint attributes constraint_name = .m.held active = off\n\
         part attributes part_name = .m.b active = off\n",
        part("a"),
        part("b")
    );
    let model = sound(&text);
    assert!(model.joints.is_empty());
    assert_eq!((model.parts.len(), model.markers.len()), (2, 1));
}

/// A saved file gives the number first and its expression later: the number counts, unless a design
/// variable has been changed.
#[test]
fn numbers_of_a_saved_file_count_until_a_variable_is_changed() {
    let text = format!(
        "{HEAD}variable create variable_name = .m.l real_value = 100.0\n\
         part create rigid_body name_and_position part_name = .m.p location = 50.0, 0, 0\n\
         marker create marker_name = .m.p.m location = 25.000001, 0, 0\n\
         !-- Expression definitions --\n\
         part modify rigid_body name_and_position part_name = .m.p location = (.m.l / 2), 0, 0\n\
         marker modify marker_name = .m.p.m location = (LOC_RELATIVE_TO({{.m.l / 4, 0, 0}}, .m.p)) relative_to = .m.p\n"
    );
    let model = sound(&text);
    assert_eq!(
        (model.parts[&2].qg[0], model.markers[&1].qp[0]),
        (50.0, 25.000001)
    );
    let source = Source::from_text(Some("model.cmd"), text.as_str());
    let changed = BTreeMap::from([(".m.l".to_owned(), 200.0)]);
    let reading = dataset::read_with(source, &changed);
    assert!(errors(&reading).is_empty(), "{:#?}", reading.diagnostics);
    let model = reading.model;
    assert_eq!(
        (model.parts[&2].qg[0], model.markers[&1].qp[0]),
        (100.0, 50.0)
    );
    let source = Source::from_text(Some("model.cmd"), text);
    let unknown = BTreeMap::from([(".m.ll".to_owned(), 200.0)]);
    let reading = dataset::read_with(source, &unknown);
    assert!(errors(&reading)[0].help.concat().contains(".m.l"));
}

/// Wrong text, line, code, and a part of message or advice.
const MISTAKES: &[(&str, usize, &str, &str)] = &[
    (
        "motion create motion_name = .m.x",
        3,
        "unknown_command",
        "motion_generator",
    ),
    (
        "marker create marker_name = .m.a.b locaton = 1,2,3",
        3,
        "unknown_argument",
        "location",
    ),
    (
        "marker create marker_name = .m.a.b location = 1 2 3",
        3,
        "view_syntax",
        "commas",
    ),
    (
        "marker create marker_name = .m.ground.b location = (1 + ), 2, 3",
        3,
        "view_expression",
        "`)`",
    ),
    (
        "variable create variable_name = .m.x real_value = (.m.y)",
        3,
        "view_expression",
        ".m.y",
    ),
    (
        "marker modify marker_name = .m.ground.nobody location = 1,2,3",
        3,
        "unknown_element",
        "nobody",
    ),
    ("end", 3, "view_syntax", "if, for and while"),
    ("if condition = (1)", 3, "view_syntax", "no `end`"),
    (
        "constraint create joint revolute joint_name = .m.j i_marker_name = .m.ground.q j_marker_name = .m.ground.r",
        3,
        "view_expression",
        ".m.ground.q",
    ),
    (
        "data_element create variable variable_name = .m.v function = \"DX(.m.no.where)\"",
        3,
        "view_expression",
        ".m.no.where",
    ),
    (
        "data_element create variable variable_name = .m.v function = \"SIN(TIME\"",
        3,
        "unexpected_end",
        "",
    ),
    (
        "data_element create variable variable_name = .m.v function = \"\"",
        3,
        "missing_argument",
        "function",
    ),
    (
        "ude create instance instance_name = .m.t definition_name = .MDI.Forces.vpg_tire",
        3,
        "view_unsolved",
        "vpg_tire",
    ),
    // decimal commas
    (
        "part create rigid_body name_and_position part_name = .m.a\npart create rigid_body mass_properties part_name = .m.a mass = 15,0 ixx = 1 iyy = 1 izz = 1",
        4,
        "view_expression",
        "with a point",
    ),
    (
        "marker create marker_name = .m.ground.i\nmarker create marker_name = .m.ground.j\nforce create element_like bushing bushing_name = .m.b i_marker_name = .m.ground.i j_marker_name = .m.ground.j stiffness = 1,2",
        5,
        "view_expression",
        "3 numbers",
    ),
    (
        "simulation single_run transient type = auto_select end_time = 2,5 number_of_steps = 20 model_name = .m",
        3,
        "view_expression",
        "end_time = 2,5",
    ),
    (
        "simulation single_run transient end_time = 2 number_of_steps = 2.5",
        3,
        "view_expression",
        "a whole number",
    ),
    // a lost & before the line of j_marker_name
    (
        "marker create marker_name = .m.ground.i\nconstraint create joint fixed joint_name = .m.j i_marker_name = .m.ground.i",
        4,
        "missing_argument",
        "j has no j_marker_name an argument on a further line needs &",
    ),
];

#[test]
fn mistakes_are_told_in_their_lines_with_cause_and_advice() {
    for (text, line, code, part) in MISTAKES {
        let reading = read(&format!("{HEAD}{text}\n"));
        let found = errors(&reading);
        let hit = found.iter().find(|d| d.line == *line && d.code == *code);
        let Some(d) = hit else {
            panic!("{text}: {code} is not among {found:#?}");
        };
        let said = format!("{} {}", d.message, d.help.concat());
        assert!(said.contains(part), "{text}: {said}");
    }
    let none = read("interface dialog_box create dialog_box_name = .gui.d\n");
    assert_eq!(errors(&none)[0].code, "view_no_model");
}

/// A mistake behind a name that became a number stands where it was typed.
#[test]
fn mistakes_in_functions_stand_where_they_were_typed() {
    let function = "data_element create variable variable_name = .m.v function = \"DX(.m.ground.origin) + \", &\n    \"SNI(TIME)\"";
    let text = format!(
        "{HEAD}marker create marker_name = .m.ground.origin location = 0,0,0\n{function}\n"
    );
    let reading = read(&text);
    let d = errors(&reading)[0];
    assert_eq!((d.code, d.line, d.column), ("unknown_name", 5, 6), "{d}");
}

#[test]
fn names_with_blanks_stand_in_quotation_marks() {
    let text = format!(
        "{HEAD}part create rigid_body name_and_position part_name = .m.\"front axle\" location = 1,2,3\n\
         marker create marker_name = .m.\"front axle\".\"left hub\" location = (LOC_RELATIVE_TO({{0,0,0}}, .m.\"front axle\"))\n\
         measure create function measure_name = .m.v function = \"DX(.m.\\\"front axle\\\".\\\"left hub\\\")\"\n"
    );
    let model = sound(&text);
    let names: Vec<_> = model
        .parts
        .values()
        .filter_map(|p| p.place.name.clone())
        .collect();
    assert_eq!(names, ["ground", "front axle"]);
    assert_eq!(text_of(&model.variables[&1].function), "DX(1)");
}

#[test]
fn places_are_in_the_coordinates_of_the_file() {
    let at = |kind: &str, location: &str| {
        let text = format!(
            "{HEAD}defaults units coordinate_system_type = {kind}\n\
             part create rigid_body name_and_position part_name = .m.p location = {location}\n"
        );
        sound(&text).parts[&2].qg
    };
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(near(at("cylindrical", "2, 90, 5"), [0.0, 2.0, 5.0]));
    assert!(near(at("spherical", "2, 90, 90"), [0.0, 2.0, 0.0]));
    assert!(near(at("cylindrical", "({1, 2, 3})"), [1.0, 2.0, 3.0]));
}

#[test]
fn a_marker_that_is_named_and_not_there_is_told() {
    let text = format!(
        "{HEAD}part create rigid_body name_and_position part_name = .m.p location = 0,0,0\n\
         part create rigid_body mass_properties part_name = .m.p mass = 1 center_of_mass_marker = .m.p.cm\n"
    );
    let reading = read(&text);
    let d = errors(&reading)[0];
    assert_eq!((d.code, d.line), ("view_expression", 4), "{d}");
    let own = read(&format!(
        "{HEAD}variable create variable_name = .m.x real_value = (.m.x + 1)\n\
        marker create marker_name = .m.ground.q location = (.m.x), 0, 0\n"
    ));
    assert!(!errors(&own).is_empty());
}

/// Markers in ground coordinates, on parts that stand elsewhere, without a word that they are.
#[test]
fn markers_that_would_meet_in_ground_are_doubted() {
    let text = |default: &str| {
        format!(
            "{HEAD}{default}part create rigid_body name_and_position part_name = .m.p location = 50,0,0\n\
             marker create marker_name = .m.p.q location = 100,0,0\n\
             marker create marker_name = .m.ground.r location = 100,0,0\n\
             constraint create joint revolute joint_name = .m.j i_marker_name = .m.p.q j_marker_name = .m.ground.r\n"
        )
    };
    let doubted = |text: &str| {
        read(text)
            .diagnostics
            .iter()
            .any(|d| d.code == "view_frames")
    };
    assert!(doubted(&text("")));
    assert!(!doubted(&text(
        "defaults coordinate_system default_coordinate_system = .m.ground\n"
    )));
}

#[test]
fn an_angle_between_three_markers_is_a_variable() {
    let points = ["a", "b", "c"]
        .map(|name| format!("marker create marker_name = .m.ground.{name} location = 0,0,0\n"));
    let text = format!(
        "{HEAD}{}measure create angle measure_name = .m.bend first = .m.ground.a middle = .m.ground.b last = .m.ground.c\n",
        points.concat()
    );
    assert_eq!(
        text_of(&sound(&text).variables[&1].function),
        "RTOD*INCANG(1,2,3)"
    );
}

/// The angles of an orientation, by their numbers.
#[test]
fn angles_of_an_orientation_are_variables() {
    let text = format!(
        "{HEAD}marker create marker_name = .m.ground.a location = 0,0,0\n{}\
         measure create orient measure_name = .m.yaw to_frame = .m.p.cm from_frame = .m.ground.a &\n  \
           characteristic = yaw_pitch_roll component = angle_1_component\n\
         measure create orient measure_name = .m.roll to_frame = .m.p.cm &\n  \
           characteristic = yaw_pitch_roll component = angle_3_component\n",
        part("p")
    );
    let model = sound(&text);
    let all: Vec<String> = model
        .variables
        .values()
        .map(|v| text_of(&v.function))
        .collect();
    assert_eq!(all, ["RTOD*YAW(2,1)", "RTOD*ROLL(2,0)"]);
}

/// A link touches with its bar and its two round ends, whatever frame its first marker has.
#[test]
fn a_link_in_a_contact_is_its_bar_and_its_ends() {
    let text = format!(
        "{HEAD}{}marker create marker_name = .m.p.a location = 10, 20, 30 orientation = 90, 0, 0\n\
         marker create marker_name = .m.p.b location = 10, 70, 30\n\
         geometry create shape link link_name = .m.p.l i_marker = .m.p.a j_marker = .m.p.b width = 8 depth = 4\n\
         marker create marker_name = .m.ground.c location = 0,0,0\n\
         geometry create shape ellipsoid ellipsoid_name = .m.ground.e center_marker = .m.ground.c &\n  \
           x_scale_factor = 2 y_scale_factor = 2 z_scale_factor = 2\n\
         contact create contact_name = .m.k i_geometry_name = .m.p.l j_geometry_name = .m.ground.e &\n  \
           stiffness = 1e5 damping = 10 dmax = 0.1 exponent = 2.2 coulomb_friction = off\n",
        part("p")
    );
    let model = sound(&text);
    let contact = model.contacts.values().next().expect("a contact");
    assert_eq!((contact.i_geometry.len(), contact.j_geometry.len()), (3, 1));
    let pose = |marker: u32| {
        let all = model.statements();
        let id = format!("MARKER/{marker}");
        all.into_iter()
            .find(|(of, _)| of.to_string() == id)
            .map(|(_, text)| text)
    };
    use cognate::model::Shape;
    for id in &contact.i_geometry {
        match model.graphics[id].shape {
            Shape::Box { corner, size } => {
                assert_eq!(size, [50.0, 8.0, 4.0]);
                // a corner half a width and half a depth beside the first marker
                let qp = model.markers[&corner].qp;
                assert!(
                    (qp[0] - 14.0).abs() < 1e-12 && (qp[1] - 20.0).abs() < 1e-12,
                    "{qp:?}"
                );
                assert!((qp[2] - 28.0).abs() < 1e-12, "{:?}", pose(corner));
            }
            Shape::Cylinder { cm, length, radius } => {
                assert_eq!((length, radius), (4.0, 4.0));
                assert!(model.markers[&cm].qp[2] - 28.0 < 1e-12);
            }
            ref other => panic!("{other:?}"),
        }
    }
}

/// Commands that could change a model and are not read are told; those that show it are not.
#[test]
fn what_is_not_read_is_told_and_what_only_shows_is_not() {
    let said = |text: &str| read(&format!("{HEAD}{text}\n")).diagnostics;
    for text in [
        "macro create macro_name = .m.x commands = \"marker create\"",
        "move translation part_name = .m.ground c1 = 5",
        "group attributes group_name = .m.g active = off",
        "file command read file_name = \"more.cmd\"",
        "marker copy marker_name = .m.ground.a new_marker_name = .m.ground.b",
    ] {
        let found = said(text);
        let told = |d: &&Diagnostic| d.code == "view_left_out" && d.severity == Severity::Warning;
        assert!(found.iter().any(|d| told(&d)), "{text}: {found:#?}");
    }
    for text in [
        "view erase",
        "group create group_name = .m.g objects_in_group = .m.ground",
        "part attributes part_name = .m.ground color = RED",
        "model display model_name = m",
    ] {
        assert!(said(text).is_empty(), "{text}: {:#?}", said(text));
    }
}

#[test]
fn a_velocity_that_is_taken_away_is_not_given() {
    let velocity = |more: &str| {
        let text = format!(
            "{HEAD}{}part create rigid_body initial_velocity part_name = .m.p vx = 5 wz = 90\n{more}",
            part("p")
        );
        let part = &sound(&text).parts[&2];
        (part.velocity[0], part.angular_velocity[2])
    };
    let (vx, wz) = velocity("");
    assert_eq!(vx, Some(5.0));
    assert!(wz.is_some_and(|w| (w - std::f64::consts::FRAC_PI_2).abs() < 1e-12));
    let taken = "part modify rigid_body initial_velocity part_name = .m.p no_vx = true\n";
    assert_eq!(velocity(taken).0, None);
}
