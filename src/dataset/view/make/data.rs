//! Variables, splines, matrices, arrays, curves, equations, plants.

use super::{Draft, Maker, Want};
use crate::diagnostic::{Diagnostic, counted};
use crate::model::Formula;

impl Maker<'_> {
    pub(super) fn make_data(&mut self) {
        let all = self
            .db
            .of_kind("data_element")
            .chain(self.db.of_kind("part equation"));
        for k in all.collect::<Vec<_>>() {
            let Some(mut draft) = self.draft(k) else {
                let kind = self.db.objects[k].kind;
                if kind != "data_element plant state" {
                    self.refuse(k, kind);
                }
                continue;
            };
            match self.db.objects[k].kind {
                "data_element variable" => {
                    self.numbers(&mut draft, &[("initial_condition", "IC")], true);
                    self.must_have_function(&mut draft, k, "function", "FUNCTION");
                }
                "data_element plant input" | "data_element plant output" => {
                    self.elements(&mut draft, "variable_name", "VARIABLES");
                }
                "data_element spline" => self.spline(&mut draft, k),
                "data_element string" => {
                    let text = self.db.texts(k, "string").concat();
                    draft.give("STRING", Want::Text(text), self.db.span(k, "string"));
                }
                "data_element curve" => self.curve(&mut draft, k),
                kind if kind.starts_with("data_element matrix") => self.matrix(&mut draft, k),
                kind if kind.starts_with("data_element array") => self.array(&mut draft, k),
                "part equation differential_equation" => {
                    self.numbers(&mut draft, &[("initial_condition", "IC")], true);
                    self.flags(
                        &mut draft,
                        &[("implicit", "IMPLICIT"), ("static_hold", "STATIC_HOLD")],
                    );
                    self.must_have_function(&mut draft, k, "function", "FUNCTION");
                }
                _ => self.system(&mut draft, k),
            }
            self.push(draft);
        }
    }

    fn spline(&self, draft: &mut Draft, k: usize) {
        if self.db.is_on(k, "linear_extrapolate") == Some(true) {
            let span = self.db.span(k, "linear_extrapolate");
            draft.give("LINEAR_EXTRAPOLATE", Want::Flag, span);
        }
        let file = self.db.texts(k, "file_name").concat();
        if !file.is_empty() {
            draft.give("FILE", Want::Text(file), self.db.span(k, "file_name"));
            for (argument, keyword) in [("block_name", "BLOCK"), ("channel", "CHANNEL")] {
                let text = self.db.texts(k, argument).concat();
                if !text.is_empty() {
                    draft.give(keyword, Want::Text(text), self.db.span(k, argument));
                }
            }
            return;
        }
        self.numbers(draft, &[("x", "X")], true);
        let (y, span) = (
            self.db.numbers(k, "y").unwrap_or_default(),
            self.db.span(k, "y"),
        );
        let Some(z) = self.db.numbers(k, "z").filter(|z| !z.is_empty()) else {
            return draft.give("Y", Want::Numbers(y), span);
        };
        // a surface: for each z the values over x
        let n = y.len() / z.len();
        if n == 0 || y.len() % z.len() != 0 {
            draft.record.mistaken = true;
            let what = format!(
                "{} do not go with {} of z",
                counted(y.len(), "value"),
                z.len()
            );
            return self.say(k, "y", Diagnostic::error("view_expression", what));
        }
        for (row, z) in y.chunks_exact(n).zip(z) {
            let row = [&[z], row].concat();
            draft.give("Y", Want::Numbers(row), span);
        }
    }

    fn matrix(&self, draft: &mut Draft, k: usize) {
        match self.db.objects[k].kind {
            "data_element matrix file" => {
                let file = self.db.texts(k, "file_name").concat();
                draft.give("FILE", Want::Text(file), self.db.span(k, "file_name"));
                let name = self.db.texts(k, "name_of_matrix_in_file").concat();
                if !name.is_empty() {
                    draft.give(
                        "NAME",
                        Want::Text(name),
                        self.db.span(k, "name_of_matrix_in_file"),
                    );
                }
            }
            "data_element matrix sparse" => {
                draft.flag("SPARSE");
                for (argument, keyword) in [("row_index", "I"), ("column_index", "J")] {
                    let numbers = self.db.numbers(k, argument).unwrap_or_default();
                    let kind = crate::model::ElementKind::Matrix;
                    let all = numbers.into_iter().map(|n| kind.id(n as u32)).collect();
                    draft.give(keyword, Want::Ids(all), self.db.span(k, argument));
                }
                self.numbers(draft, &[("values", "VALUES")], true);
            }
            _ => {
                let order = self.db.choice(k, "input_order").unwrap_or_default();
                let order = if order.starts_with("by_r") {
                    "RORDER"
                } else {
                    "CORDER"
                };
                draft.give(
                    "FULL",
                    Want::Word(order.into()),
                    self.db.span(k, "input_order"),
                );
                for (argument, keyword) in [("row_count", "ROWS"), ("column_count", "COLUMNS")] {
                    if let Some(n) = self.db.number(k, argument) {
                        draft.give(keyword, Want::Count(n as usize), self.db.span(k, argument));
                    }
                }
                self.numbers(draft, &[("values", "VALUES")], true);
            }
        }
    }

    fn array(&self, draft: &mut Draft, k: usize) {
        let span = self.db.span(k, "size");
        let size = self.db.number(k, "size").map(|n| n as usize);
        match self.db.objects[k]
            .kind
            .rsplit(' ')
            .next()
            .unwrap_or_default()
        {
            "u_input_array" => {
                draft.flag("U");
                let count = self.db.references_of(k, "variable_name").len();
                draft.give("SIZE", Want::Count(count), span);
                self.elements(draft, "variable_name", "VARIABLES");
            }
            kind @ ("x_state_array" | "y_output_array") => {
                draft.flag(if kind.starts_with('x') { "X" } else { "Y" });
                if let Some(size) = size {
                    draft.give("SIZE", Want::Count(size), span);
                }
            }
            _ => {
                draft.flag("IC");
                let numbers = self.db.numbers(k, "numbers").unwrap_or_default();
                let size = size.unwrap_or(numbers.len());
                draft.give("SIZE", Want::Count(size), span);
                draft.give(
                    "NUMBERS",
                    Want::Numbers(numbers),
                    self.db.span(k, "numbers"),
                );
            }
        }
    }

    fn curve(&self, draft: &mut Draft, k: usize) {
        match self.db.is_on(k, "closed") {
            Some(true) => draft.flag("CLOSED"),
            Some(false) => draft.flag("OPEN"),
            None => {}
        }
        if self.user(draft, "user_function", "routine", "FUNCTION") {
            let ends = [
                ("minimum_parameter", "MINPAR"),
                ("maximum_parameter", "MAXPAR"),
            ];
            return self.numbers(draft, &ends, true);
        }
        self.element(draft, "matrix_name", "MATRIX");
        if let Some(n) = self.db.number(k, "interpolation_order") {
            draft.give(
                "ORDER",
                Want::Count(n as usize),
                self.db.span(k, "interpolation_order"),
            );
        }
        match self.db.choice(k, "fit_type") {
            Some(word) if word.starts_with("control") => draft.flag("CONTROL_POINTS"),
            Some(word) if word.starts_with("curve") => draft.flag("CURVE_POINTS"),
            _ => {}
        }
        let ends = [
            ("minimum_parameter", "MINPAR"),
            ("maximum_parameter", "MAXPAR"),
        ];
        self.numbers(draft, &ends, true);
    }

    fn system(&self, draft: &mut Draft, k: usize) {
        for (argument, keyword) in [
            ("x_state_array_name", "X"),
            ("u_input_array_name", "U"),
            ("y_output_array_name", "Y"),
            ("ic_array_name", "IC"),
            ("a_state_matrix_name", "A"),
            ("b_input_matrix_name", "B"),
            ("c_output_matrix_name", "C"),
            ("d_feedforward_matrix_name", "D"),
            ("discrete_state_array_name", "XD"),
            ("discrete_ic_array_name", "ICD"),
        ] {
            if self.db.given(k, argument).is_some() {
                self.element(draft, argument, keyword);
            }
        }
        for (argument, keyword) in [
            ("state_equation_count", "NS"),
            ("output_equation_count", "NO"),
            ("discrete_state_equation_count", "ND"),
        ] {
            if let Some(n) = self.db.number(k, argument) {
                draft.give(keyword, Want::Count(n as usize), self.db.span(k, argument));
            }
        }
        let coefficients = [
            ("numerator_coefficients", "NUMERATOR"),
            ("denominator_coefficients", "DENOMINATOR"),
            ("sample_period", "SAMPLE_PERIOD"),
        ];
        self.numbers(draft, &coefficients, true);
        self.flags(draft, &[("static_hold", "STATIC_HOLD")]);
        let constants = self.db.numbers(k, "user_function");
        if let Some(constants) = constants.filter(|c| !c.is_empty()) {
            let routine = self.db.word(k, "routine").filter(|r| !r.is_empty());
            let formula = Formula::User { constants, routine };
            draft.give(
                "FUNCTION",
                Want::Formula(formula),
                self.db.span(k, "user_function"),
            );
        }
    }
}
