//! Diagnostics as text for people: the source line, a caret below the place, and advice.

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use anstream::{AutoStream, ColorChoice};
use cognate::dataset::Source;
use cognate::diagnostic::{Cause, Diagnostic, Severity, Subject};
use cognate::disk;
use std::collections::BTreeMap;
use std::io;

/// The texts that places refer to, by the name of their file; the name is empty for a text without
/// a file.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    texts: Vec<(String, String)>,
}

impl Sources {
    /// Creates sources of one text without a file.
    pub fn of(text: impl Into<String>) -> Self {
        let mut sources = Self::default();
        sources.add("", text);
        sources
    }
    /// Reads the files that diagnostics name; a file that can no longer be read has no text.
    pub fn of_files(diagnostics: &[Diagnostic]) -> Self {
        let mut sources = Self::default();
        for file in diagnostics.iter().filter_map(|d| d.file.as_deref()) {
            if sources.text(Some(file)).is_none()
                && let Ok(bytes) = disk::read(disk::path(file))
            {
                sources.add(file, Source::from_bytes(None, &bytes).text);
            }
        }
        sources
    }
    /// Adds the text of a file.
    pub fn add(&mut self, file: impl Into<String>, text: impl Into<String>) {
        self.texts.push((file.into(), text.into()));
    }
    /// The text of a file; without a file, the text that has none.
    pub fn text(&self, file: Option<&str>) -> Option<&str> {
        self.texts
            .iter()
            .find(|t| t.0 == file.unwrap_or_default())
            .map(|t| t.1.as_str())
    }
}

/// Most diagnostics that are shown in full; a broken file can have thousands.
const MOST_SHOWN: usize = 50;

/// Renders the diagnostics as text, one after another.
pub fn render(diagnostics: &[Diagnostic], sources: &Sources, colour: bool) -> String {
    let renderer = if colour {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let mut text = String::new();
    let (shown, alike) = sorted_out(diagnostics);
    for diagnostic in shown.iter().take(MOST_SHOWN) {
        text += &renderer.render(&[group(diagnostic, sources)]);
        text += "\n";
    }
    if shown.len() > MOST_SHOWN {
        text += &format!("… and {} more\n", shown.len() - MOST_SHOWN);
    }
    for (code, elements) in alike {
        let names: Vec<String> = elements.iter().take(MOST_NAMED).cloned().collect();
        let rest = elements.len() - names.len();
        let rest = if rest > 0 {
            format!(" and {rest} more")
        } else {
            String::new()
        };
        text += &format!("{code}: likewise {}{rest}\n", names.join(", "));
    }
    text
}

/// Codes that a model can have hundreds of, one for each element of a family, all with the same
/// remedy.
const ALIKE: [Cause; 8] = [
    Cause::Unsupported,
    Cause::UserRoutine,
    Cause::CurveData,
    Cause::Skipped,
    Cause::Approximate,
    Cause::Misaligned,
    Cause::ImpossibleInertia,
    Cause::Superseded,
];
/// Number of these that are shown in full.
const FIRST_ALIKE: usize = 3;
/// Number of further elements that are listed by name.
const MOST_NAMED: usize = 12;

/// Separates the diagnostics that are shown in full from the elements of those that repeat them, by
/// code.
fn sorted_out(diagnostics: &[Diagnostic]) -> (Vec<&Diagnostic>, Vec<(&str, Vec<String>)>) {
    let mut shown: Vec<&Diagnostic> = Vec::new();
    let mut alike: Vec<(&str, Vec<String>)> = Vec::new();
    // for each that can repeat: how often it is shown in full, and its row of `alike`
    let mut known: BTreeMap<_, (usize, Option<usize>)> = BTreeMap::new();
    for d in diagnostics {
        if !d.is_any(&ALIKE) {
            shown.push(d);
            continue;
        }
        let (full, row) = known.entry((d.code, d.severity, &d.help)).or_default();
        let element = d.element.clone().filter(|_| *full >= FIRST_ALIKE);
        let Some(element) = element else {
            *full += 1;
            shown.push(d);
            continue;
        };
        let row = *row.get_or_insert_with(|| {
            alike.push((d.code, Vec::new()));
            alike.len() - 1
        });
        let element = Subject::from(element).named(d.name.as_deref());
        alike[row].1.push(element);
    }
    (shown, alike)
}

/// Arranges a diagnostic for the renderer.
fn group<'a>(d: &'a Diagnostic, sources: &'a Sources) -> Group<'a> {
    let level = match d.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    };
    let message = d
        .named()
        .map_or_else(|| d.message.clone(), |e| format!("{e}: {}", d.message));
    let place = excerpt(d, sources);
    let title = match (&place, &d.file) {
        (None, Some(file)) if d.line > 0 => {
            level.primary_title(format!("{file}:{}:{}: {message}", d.line, d.column))
        }
        (None, Some(file)) => level.primary_title(format!("{file}: {message}")),
        (None, None) if d.line > 0 => {
            level.primary_title(format!("line {}, column {}: {message}", d.line, d.column))
        }
        _ => level.primary_title(message),
    };
    let mut group = Group::with_title(title.id(d.code));
    if let Some(Excerpt {
        lines,
        from,
        first_line,
        range,
    }) = place
    {
        let shown = from..from + lines.len();
        let marks = d
            .marks
            .iter()
            .filter(|(span, _)| shown.contains(&span.start) && span.end <= shown.end)
            .map(|(span, what)| {
                let range = span.start - from..span.end - from;
                AnnotationKind::Context.span(range).label(what.as_str())
            });
        let snippet = Snippet::source(lines)
            .line_start(first_line)
            .path(d.file.as_deref())
            .annotation(AnnotationKind::Primary.span(range))
            .annotations(marks);
        group = group.element(snippet);
    }
    group.elements(d.help.iter().map(|advice| Level::HELP.message(advice)))
}

/// The lines around a place, and the place within them.
struct Excerpt<'a> {
    /// whole lines of the text
    lines: &'a str,
    /// byte of the text that the lines begin with
    from: usize,
    /// number of the first of them, from 1
    first_line: usize,
    /// the place, in bytes of these lines
    range: std::ops::Range<usize>,
}

/// Longest piece of a line that is shown around a place, in bytes.
const WIDEST: usize = 400;

/// Cuts the lines around the place of a diagnostic out of its text.
fn excerpt<'a>(d: &Diagnostic, sources: &'a Sources) -> Option<Excerpt<'a>> {
    let text = sources.text(d.file.as_deref())?;
    let (start, end) = match d.span {
        Some(span) => (span.start.min(text.len()), span.end.min(text.len())),
        None if d.line > 0 => {
            let line_start = text
                .split_inclusive('\n')
                .take(d.line - 1)
                .map(str::len)
                .sum::<usize>();
            let line = text.get(line_start..)?.split('\n').next()?;
            let before = line
                .chars()
                .take(d.column.saturating_sub(1))
                .map(char::len_utf8)
                .sum::<usize>();
            let word = line[before..]
                .chars()
                .take_while(|c| c.is_alphanumeric() || *c == '_')
                .map(char::len_utf8)
                .sum::<usize>();
            (line_start + before, line_start + before + word)
        }
        None => return None,
    };
    let (start, end) = (
        floor_boundary(text, start),
        floor_boundary(text, end.max(start)),
    );
    // further places that stand near are shown with it
    let first = (d
        .marks
        .iter()
        .map(|(span, _)| floor_boundary(text, span.start)))
    .filter(|&at| at < start && start - at < WIDEST)
    .fold(start, usize::min);
    let line_start = text[..first].rfind('\n').map_or(0, |i| i + 1);
    let line_end = text[end..].find('\n').map_or(text.len(), |i| end + i);
    // one statement can be a line of a megabyte: only the neighbourhood of the place is shown
    let (from, to) = (
        floor_boundary(text, line_start.max(start.saturating_sub(WIDEST))),
        floor_boundary(text, line_end.min(start + WIDEST)),
    );
    let end = end.min(to).max(start);
    let first_line = 1 + text[..from].matches('\n').count();
    let lines = text[from..to].trim_end_matches('\r');
    Some(Excerpt {
        lines,
        from,
        first_line,
        range: (start - from).min(lines.len())..(end - from).min(lines.len()),
    })
}

/// Returns the nearest place at or before this one that is between two characters.
fn floor_boundary(text: &str, mut at: usize) -> usize {
    at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// Lets the choice of a user rule over what the streams and the environment say.
pub fn choose_colours(choice: clap::ColorChoice) {
    let choice = match choice {
        clap::ColorChoice::Auto => ColorChoice::Auto,
        clap::ColorChoice::Always => ColorChoice::Always,
        clap::ColorChoice::Never => ColorChoice::Never,
    };
    choice.write_global();
}

/// Returns whether standard error gets colours: as the user chose, else where it is a terminal and
/// NO_COLOR is not set.
pub fn colour_on_stderr() -> bool {
    AutoStream::choice(&io::stderr()) != ColorChoice::Never
}

/// Returns whether standard output gets colours.
pub fn colour_on_stdout() -> bool {
    AutoStream::choice(&io::stdout()) != ColorChoice::Never
}

#[cfg(test)]
mod tests {
    use super::*;
    use cognate::diagnostic::Span;

    fn plain(d: Diagnostic, sources: &Sources) -> String {
        render(&[d], sources, false)
    }

    #[test]
    fn a_caret_stands_below_the_place_and_advice_below_it() {
        let text = "STEP(TIME,0,0,1)";
        let d = Diagnostic::error("arity", "STEP takes 5 arguments, 4 given")
            .at(text, Span::new(0, 4))
            .help("STEP(x, x0, h0, x1, h1)");
        let shown = plain(d, &Sources::of(text));
        let lines: Vec<&str> = shown.lines().collect();
        assert_eq!(lines[0], "error[arity]: STEP takes 5 arguments, 4 given");
        let at = lines.iter().position(|l| l.contains(text)).unwrap();
        assert_eq!(lines[at].find("STEP"), lines[at + 1].find("^^^^"));
        assert!(shown.contains("help: STEP(x, x0, h0, x1, h1)"), "{shown}");
    }

    #[test]
    fn what_is_said_of_a_hundred_elements_is_said_of_three() {
        let one = |k: usize| {
            Diagnostic::error("unsupported", format!("solid {k} cannot be read"))
                .element(format!("CONTACT/{k}"))
                .help("leave them out")
        };
        let mut all: Vec<Diagnostic> = (1..=100).map(one).collect();
        all.push(Diagnostic::error("unsupported", "is not solved").element("TIRE/1"));
        let shown = render(&all, &Sources::default(), false);
        assert_eq!(shown.matches("cannot be read").count(), 3, "{shown}");
        assert!(shown.contains("likewise CONTACT/4, CONTACT/5"), "{shown}");
        assert!(shown.contains("and 85 more"), "{shown}");
        assert!(shown.contains("TIRE/1: is not solved"), "{shown}");
    }

    #[test]
    fn places_in_files_show_file_line_and_element() {
        let text = "title\nPART/1, GROUND\nSFORCE/3, FUNCTION=SQR(2)\n";
        let mut sources = Sources::default();
        sources.add("a.adm", text);
        let start = text.find("SQR").unwrap();
        let mut d = Diagnostic::error("unknown_name", "there is no function SQR")
            .at(text, Span::new(start, start + 3))
            .element("SFORCE/3");
        d.file = Some("a.adm".into());
        let shown = plain(d.clone(), &sources);
        assert!(
            shown.contains("a.adm:3:20") && shown.contains("SFORCE/3: there is no function SQR"),
            "{shown}"
        );
        assert!(!shown.contains("GROUND"), "{shown}");
        let without_text = plain(d, &Sources::default());
        assert!(
            without_text.contains("a.adm:3:20: SFORCE/3"),
            "{without_text}"
        );
    }

    #[test]
    fn every_place_in_every_text_can_be_shown() {
        for text in [
            "",
            "\n",
            "ä€𝕏",
            "a\r\nb\r\n",
            "x\n\n\ny",
            &"1+".repeat(5000),
        ] {
            let sources = Sources::of(text);
            for (start, end) in [
                (0, 0),
                (0, 1),
                (1, 2),
                (2, 99),
                (3, 1),
                (9999, 9999),
                (5000, 10_000),
            ] {
                let d = Diagnostic {
                    span: Some(Span { start, end }),
                    ..Diagnostic::error("x", "y")
                };
                assert!(plain(d, &sources).contains("error[x]: y"));
            }
            let d = Diagnostic {
                line: 2,
                column: 7,
                ..Diagnostic::error("x", "y")
            };
            assert!(plain(d, &sources).contains("error[x]"));
        }
    }
}
