//! Serialization by serde: expressions and models as the texts that they are read from, mistakes
//! and rows of sweeps as data. Behind the feature `serde`.
//!
//! Reading back checks a text as any text of a user is checked: a mistake is an error of the
//! format, with the message of the first.

use crate::analysis::sweep::Row;
use crate::diagnostic::{Diagnostic, Error, Severity};
use crate::expr::Expr;
use crate::expr::ast::Dialect;
use crate::model::Model;
use crate::results::Status;
use serde::de::Error as _;
use serde::ser::{SerializeSeq, SerializeStruct};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An expression as it is written: its text, and the word of its language.
#[derive(Serialize, Deserialize)]
struct Written {
    text: String,
    dialect: Word,
}

/// The word of a language.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Word {
    Function,
    Expression,
}

impl Serialize for Expr {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let written = Written {
            text: self.text().to_owned(),
            dialect: match self.ast().dialect {
                Dialect::Function => Word::Function,
                Dialect::Expression => Word::Expression,
            },
        };
        written.serialize(to)
    }
}

impl<'de> Deserialize<'de> for Expr {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let Written { text, dialect } = Written::deserialize(from)?;
        let dialect = match dialect {
            Word::Function => Dialect::Function,
            Word::Expression => Dialect::Expression,
        };
        Expr::parse_dialect(&text, dialect).map_err(D::Error::custom)
    }
}

/// A model is the text of its dataset.
impl Serialize for Model {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&self.to_text())
    }
}

impl<'de> Deserialize<'de> for Model {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let text = String::deserialize(from)?;
        Model::from_text(&text).map_err(D::Error::custom)
    }
}

impl Serialize for Severity {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        })
    }
}

impl Serialize for Status {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.word())
    }
}

/// Places are counted from 1; where one is not known it is null.
impl Serialize for Diagnostic {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let known = |place: usize| (place > 0).then_some(place);
        let mut said = to.serialize_struct("Diagnostic", 11)?;
        said.serialize_field("code", self.code)?;
        said.serialize_field("severity", &self.severity)?;
        said.serialize_field("message", &self.message)?;
        said.serialize_field("file", &self.file)?;
        said.serialize_field("line", &known(self.line))?;
        said.serialize_field("column", &known(self.column))?;
        said.serialize_field("element", &self.element)?;
        said.serialize_field("part", &self.part)?;
        said.serialize_field("argument", &self.argument)?;
        said.serialize_field("name", &self.name)?;
        said.serialize_field("help", &self.help)?;
        said.end()
    }
}

/// An error is the list of its mistakes.
impl Serialize for Error {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut all = to.serialize_seq(Some(self.diagnostics().len()))?;
        for said in self.diagnostics() {
            all.serialize_element(said)?;
        }
        all.end()
    }
}

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut row = to.serialize_struct("Row", 6)?;
        row.serialize_field("run", &self.run)?;
        row.serialize_field("values", &self.values)?;
        row.serialize_field("measures", &self.measures)?;
        row.serialize_field("status", &self.status)?;
        row.serialize_field("warnings", &self.warnings)?;
        row.serialize_field("reason", &self.reason)?;
        row.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn expressions_and_models_come_back_as_they_went() {
        for (text, dialect) in [
            ("SIN(90D)*TIME", Dialect::Function),
            ("sin(90*t)", Dialect::Expression),
        ] {
            let expr = Expr::parse_dialect(text, dialect).unwrap();
            let written = serde_json::to_string(&expr).unwrap();
            assert_eq!(serde_json::from_str::<Expr>(&written).unwrap(), expr);
        }
        let text =
            "a part\nPART/1, GROUND\nPART/2, MASS=2, CM=2, IP=1,1,1\nMARKER/2, PART=2\nEND\n";
        let model = Model::from_text(text).unwrap();
        let again = |model: &Model| -> Model {
            serde_json::from_str(&serde_json::to_string(model).unwrap()).unwrap()
        };
        // lines are those of the text that was written
        let once = again(&model);
        assert_eq!(once.to_text(), model.to_text());
        assert_eq!(again(&once), once);
    }

    #[test]
    fn a_text_with_a_mistake_is_refused_with_its_message() {
        let written = "{\"text\": \"STPE(TIME)\", \"dialect\": \"function\"}";
        let refused = serde_json::from_str::<Expr>(written).unwrap_err();
        assert!(refused.to_string().contains("STPE"), "{refused}");
        assert!(serde_json::from_str::<Model>("\"a\\nPART/2, MAS5=1\\nEND\\n\"").is_err());
    }

    #[test]
    fn mistakes_are_data() {
        let error = Expr::parse("2*STPE(TIME)").unwrap_err();
        let written = serde_json::to_value(&error).unwrap();
        assert_eq!(written[0]["code"], "unknown_name");
        assert_eq!(written[0]["column"], 3);
        assert!(written[0]["line"].is_number() && written[0]["element"].is_null());
    }
}
