//! Words by which files of results call the kinds of elements that their sets belong to.

use crate::model::ElementKind;

/// Returns the word for a kind of element in files of results: `Single_Component_Force`.
pub const fn word_of(kind: ElementKind) -> &'static str {
    use ElementKind as E;
    match kind {
        E::Part | E::PointMass => "Part",
        E::Joint => "Joint",
        E::Jprim => "Primitive_Joint",
        E::Motion => "Motion",
        E::Coupler => "Coupler",
        E::Gear => "Gear",
        E::Gcon => "General_Constraint",
        E::Ptcv => "Point_Curve",
        E::Cvcv => "Curve_Curve",
        E::Sforce => "Single_Component_Force",
        E::Vforce => "Force_Vector",
        E::Vtorque => "Torque_Vector",
        E::Gforce => "General_Force",
        E::SpringDamper => "Spring_Damper",
        E::Bushing => "Bushing",
        E::Field => "Field",
        E::Beam => "Beam",
        E::Nforce => "Nforce",
        E::Variable => "ADAMS_Variable",
        E::Diff => "Differential_Equation",
        E::Lse => "Linear_State_Equation",
        E::Tfsiso => "Transfer_Function",
        E::Gse => "General_State_Equation",
        E::Pinput => "Plant_Input",
        E::Poutput => "Plant_Output",
        E::Friction => "Friction",
        E::Contact => "Contact",
        E::Marker => "Marker",
        E::Sensor => "Sensor",
        E::Array => "Array",
        E::Curve => "Curve",
        E::Spline => "Spline",
        E::String => "String",
        E::Matrix => "Matrix",
        E::Request | E::Mrequest => "Request",
        E::Graphics => "Graphics",
        other => other.keyword(),
    }
}
