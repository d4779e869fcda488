//! A verification as text: the count line by line, then the findings; equal findings about many
//! elements are given once.

use cognate::analysis::verify::{Advice, Dependent, Undetermined, Verification, listed};
use cognate::diagnostic::counted;
use cognate::model::{ElementId, Model};
use std::fmt::Write;

/// Number of findings of one sort above which they are grouped: one in full, the names of the
/// others.
const MOST_UNGROUPED: usize = 6;

/// Names of elements in sentences.
type Called<'a> = &'a dyn Fn(ElementId) -> String;

/// Prints the verification of a model, with elements as its file names them.
pub fn of(v: &Verification, model: &Model) -> String {
    let called: Called<'_> = &|id| model.called(id);
    let mut out = String::new();
    let mut line = |text: String| {
        let _ = writeln!(out, "{text}");
    };
    let parts = if v.parts == 1 {
        "part, with 6"
    } else {
        "parts, 6 each"
    };
    line(format!("{:5}  {parts}", v.parts));
    if v.point_masses > 0 {
        let masses = if v.point_masses == 1 {
            "point mass, with 3"
        } else {
            "point masses, 3 each"
        };
        line(format!("{:5}  {masses}", v.point_masses));
    }
    for (what, n, equations) in &v.counted {
        line(format!(
            "{n:5}  {what}, {}",
            counted(*equations, "equation")
        ));
    }
    line(format!("Gruebler count: {}", v.gruebler));
    let Some(freedom) = v.freedom else {
        line("no position satisfies all constraints".into());
        return out;
    };
    line(format!(
        "freedom: {freedom} (from the rank of the constraints where they are assembled)"
    ));
    if v.freedom_nearby != v.freedom {
        line(format!(
            "freedom near that position: {}",
            v.freedom_nearby.unwrap_or(freedom)
        ));
    }
    if let Some(positions) = v
        .freedom_of_position
        .filter(|p| Some(*p) != v.freedom_nearby)
    {
        line(format!(
            "freedom of position: {positions} (equations of velocities hold no position)"
        ));
    }
    for f in v.free.iter().take(MOST_FREE) {
        line(format!("free: {}", f.words));
    }
    if v.free.len() > MOST_FREE {
        let rest = v.free.len() - MOST_FREE;
        line(format!("free: {rest} more, which --json tells"));
    }
    if v.dependent.is_empty() {
        line("no redundant constraint".into());
    }
    let all = redundant(&v.dependent, called)
        .into_iter()
        .chain(not_unique(&v.undetermined, called));
    all.chain(advice(&v.advice, called)).for_each(&mut line);
    for warning in &v.warnings {
        line(format!("warning: {}", warning.record(model).sentence()));
    }
    out
}

/// Most free directions that are listed.
const MOST_FREE: usize = 40;

/// Prints the redundant constraints.
fn redundant(all: &[Dependent], called: Called<'_>) -> Vec<String> {
    let by_element = groups(all, |a, b| {
        (&a.element, &a.fixed_by, a.only_here) == (&b.element, &b.fixed_by, b.only_here)
    });
    let sentence = |(first, group): &(&Dependent, Vec<&Dependent>)| {
        let rows: Vec<&str> = group.iter().map(|d| d.equation.as_str()).collect();
        let words = first.sentence_of(group, called);
        format!("redundant: {words} ({})", rows.join(", "))
    };
    if by_element.len() <= MOST_UNGROUPED {
        return by_element.iter().map(sentence).collect();
    }
    // rotations or translations, as many of them, fixed by one other element or around a loop
    type Group<'a> = (&'a Dependent, Vec<&'a Dependent>);
    let kind = |(first, group): &Group<'_>| {
        let rotations: Vec<bool> = group.iter().map(|d| d.direction.is_rotation()).collect();
        (rotations, first.fixed_by.len() == 1, first.only_here)
    };
    let mut lines = vec![format!(
        "{}; --json tells of each what fixes it already",
        counted(all.len(), "redundant equation")
    )];
    for (first, group) in groups(&by_element, |a, b| kind(a) == kind(b)) {
        let mut others: Vec<String> = group[1..]
            .iter()
            .map(|(d, _)| match d.fixed_by.as_slice() {
                &[one] => format!("{} by {}", called(d.element), called(one)),
                _ => called(d.element),
            })
            .collect();
        others.dedup();
        let mut text = sentence(first);
        if !others.is_empty() {
            let where_ = if first.0.fixed_by.len() == 1 {
                ""
            } else {
                ", around loops of theirs,"
            };
            let _ = write!(text, "; likewise{where_} {}", others.join(", "));
        }
        lines.push(text);
    }
    lines
}

/// Prints the reactions that are not unique.
fn not_unique(all: &[Undetermined], called: Called<'_>) -> Vec<String> {
    let tell = |first: &Undetermined, group: &[&Undetermined], axes: &str| {
        format!(
            "not unique: {} of {} ({axes}); results tell the smallest set",
            first.components.join(" "),
            listed(group.iter().map(|u| &u.element), called),
        )
    };
    let exact = groups(all, |a, b| {
        (&a.components, &a.axes) == (&b.components, &b.axes)
    });
    if exact.len() <= MOST_UNGROUPED {
        let tell = |(first, group): &(&Undetermined, Vec<&Undetermined>)| {
            tell(first, group, &format!("axes of {}", first.axes))
        };
        return exact.iter().map(tell).collect();
    }
    let alike = groups(all, |a, b| a.components == b.components);
    let tell = |(first, group): &(&Undetermined, Vec<&Undetermined>)| {
        tell(first, group, "axes of the J marker of each")
    };
    alike.iter().map(tell).collect()
}

/// Prints the advice; equal advice about many elements is given once.
fn advice(all: &[Advice], called: Called<'_>) -> Vec<String> {
    if all.len() <= MOST_UNGROUPED {
        let line = |a: &Advice| format!("advice: {}", a.sentence(called));
        return all.iter().map(line).collect();
    }
    let mut lines = Vec::new();
    for (first, group) in groups(all, |a, b| a.change == b.change) {
        let others = &group[1..];
        let mut text = format!("advice: {}", first.sentence(called));
        if !others.is_empty() {
            let others = listed(others.iter().map(|a| &a.element), called);
            let _ = write!(text, "; likewise {others}");
        }
        lines.push(text);
    }
    lines
}

/// Groups equal entries, in the order of the first of each group.
fn groups<T>(all: &[T], same: impl Fn(&T, &T) -> bool) -> Vec<(&T, Vec<&T>)> {
    let mut found: Vec<(&T, Vec<&T>)> = Vec::new();
    for x in all {
        match found.iter_mut().find(|(first, _)| same(first, x)) {
            Some((_, group)) => group.push(x),
            None => found.push((x, vec![x])),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use cognate::analysis::verify::Change;
    use cognate::internals::direction::{Axis, Direction};
    use cognate::model::ElementKind;

    fn dependent(k: u32, fixed_by: &[u32]) -> Dependent {
        let element = ElementKind::Joint.id(k);
        let fixed_by = fixed_by.iter().map(|&k| ElementKind::Joint.id(k)).collect();
        Dependent {
            row: format!("{element} Zi.Xj"),
            equation: "Zi.Xj".into(),
            element,
            direction: Direction::Rotation(Axis::Ground(1)),
            fixed_by,
            combination: Vec::new(),
            only_here: false,
            drives: false,
        }
    }

    #[test]
    fn few_findings_are_told_one_by_one_and_many_by_their_kinds() {
        let few: Vec<Dependent> = (1..=6).map(|k| dependent(k, &[9])).collect();
        let called: Called<'_> = &|id| id.to_string();
        assert_eq!(redundant(&few, called).len(), 6);
        let mut many: Vec<Dependent> = (1..=20).map(|k| dependent(k, &[90])).collect();
        many.extend((31..=35).map(|k| dependent(k, &[91, 92])));
        let lines = redundant(&many, called);
        assert_eq!(lines.len(), 3, "{lines:#?}");
        assert!(lines[0].starts_with("25 redundant equations"));
        assert!(lines[1].contains("likewise JOINT/2 by JOINT/90"));
        assert!(lines[2].contains("JOINT/35") && lines[2].contains("loops"));
        // every element is named
        for d in &many {
            assert!(
                lines.iter().any(|l| l.contains(&d.element.to_string())),
                "{}",
                d.element
            );
        }
    }

    #[test]
    fn advice_of_one_kind_is_given_once() {
        let of = |k: u32| Advice {
            element: ElementKind::Jprim.id(k),
            change: Change::Remove,
        };
        let all: Vec<Advice> = (1..=9).map(of).collect();
        let lines = advice(&all, &|id| id.to_string());
        assert_eq!(lines.len(), 1);
        assert!(lines[0].ends_with(
            "likewise JPRIM/2, JPRIM/3, JPRIM/4, JPRIM/5, JPRIM/6, JPRIM/7, JPRIM/8, JPRIM/9"
        ));
    }
}
