//! The frequent forms of the text of a dataset or a command file, taken apart in one pass.
//!
//! The form of a dataset is that of `grammar/dataset.pest`, that of a command file the one of
//! `grammar/command.pest`. Most files have only words and marks,
//! lines that go on behind a comma at the beginning of the next (a comma or a backslash may end the
//! first as well), quoted texts and comments. Of
//! these the same comes out here, for a small part of the work. Whatever else stands in a text
//! leaves all of it to the grammar.

use super::syntax::{Item, Syntax, Token, TokenKind, Tokens, view_name};
use crate::diagnostic::Span;

/// Takes a dataset apart; `None`: something in it is not frequent.
pub(super) fn dataset(text: &str) -> Option<Syntax> {
    let mut reader = Reader {
        bytes: text.as_bytes(),
        at: 0,
    };
    let title = reader.rest_of_line()?;
    let syntax = Syntax {
        title,
        ..Syntax::default()
    };
    if reader.at == text.len() {
        return Some(syntax);
    }
    items(text, reader, syntax, true)
}

/// Takes a command file, or the part of it after the headings, apart; `None`: something in it is
/// not frequent.
pub(super) fn script(text: &str) -> Option<Syntax> {
    let reader = Reader {
        bytes: text.as_bytes(),
        at: 0,
    };
    items(text, reader, Syntax::default(), false)
}

/// Reads comments and statements to the end of the text, or to the statement END where it `ends`
/// the text.
fn items(text: &str, mut reader: Reader, mut syntax: Syntax, ends: bool) -> Option<Syntax> {
    let (mut name, mut tokens) = (None, Vec::new());
    while let Some(byte) = reader.here() {
        match byte {
            b' ' | b'\t' | b'\n' | b'\r' => {
                reader.newline()?;
            }
            b'!' => {
                let span = reader.rest_of_line()?;
                name = view_name(text.get(span.start..span.end)?).or(name);
                syntax.items.push(Item::Comment(span));
            }
            _ if ends && reader.is_end()? => {
                let end = reader.at + END.len();
                syntax.end = Some(Span::new(reader.at, end));
                syntax.after = Span::new(end, text.len());
                return Some(syntax);
            }
            _ => {
                tokens.clear();
                reader.statement(&mut tokens)?;
                let (first, last) = (tokens.first()?.span, tokens.last()?.span);
                syntax.items.push(Item::Statement(Tokens {
                    span: Span::new(first.start, last.end),
                    tokens: tokens.clone(),
                    name: name.take(),
                }));
            }
        }
    }
    Some(syntax)
}

const END: &str = "END";

/// Returns whether a byte is a mark or begins a character that may be one: no part of a word that
/// is frequent.
fn ends_word(byte: u8) -> bool {
    ENDS_WORD[usize::from(byte)]
}

const ENDS_WORD: [bool; 256] = {
    const MARKS: &[u8] = b" ,=():/\n\\\r\t;!&\"\x0B\x0C";
    let mut ends = [false; 256];
    let mut k = 0;
    while k < MARKS.len() {
        ends[MARKS[k] as usize] = true;
        k += 1;
    }
    let mut byte = 0x80;
    while byte < ends.len() {
        ends[byte] = true;
        byte += 1;
    }
    ends
};

/// A text and the place up to which it has been read.
struct Reader<'t> {
    bytes: &'t [u8],
    at: usize,
}

impl Reader<'_> {
    fn here(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    /// Reads up to the end of the line; `None`: it ends in a way that is not frequent.
    fn rest_of_line(&mut self) -> Option<Span> {
        let rest = self.bytes.get(self.at..)?;
        let ends = |&b: &u8| b == b'\n' || b == b'\r';
        let end = self.at + rest.iter().position(ends).unwrap_or(rest.len());
        let span = Span::new(self.at, end);
        self.at = end;
        self.is_line_end().then_some(span)
    }

    /// Returns whether a line or the text ends here.
    fn is_line_end(&self) -> bool {
        match self.here() {
            None | Some(b'\n') => true,
            Some(b'\r') => self.bytes.get(self.at + 1) == Some(&b'\n'),
            _ => false,
        }
    }

    /// Reads a blank or the end of a line.
    fn newline(&mut self) -> Option<()> {
        if self.here() == Some(b'\r') {
            self.is_line_end().then_some(())?;
            self.at += 1;
        }
        self.at += 1;
        Some(())
    }

    fn blanks(&mut self) {
        while let Some(b' ' | b'\t') = self.here() {
            self.at += 1;
        }
    }

    /// Returns whether END stands here, a statement of its own.
    fn is_end(&self) -> Option<bool> {
        let word = self.bytes.get(self.at..self.at + END.len());
        if !word.is_some_and(|word| word.eq_ignore_ascii_case(END.as_bytes())) {
            return Some(false);
        }
        match self.bytes.get(self.at + END.len()) {
            Some(0x80..) => None,
            Some(b) => Some(matches!(
                b,
                b' ' | b'\t' | 0x0B | 0x0C | b'\n' | b'\r' | b'!' | b';' | b'/'
            )),
            None => Some(true),
        }
    }

    /// Reads a statement that begins with a word; its tokens are put behind none.
    fn statement(&mut self, tokens: &mut Vec<Token>) -> Option<()> {
        loop {
            self.blanks();
            let start = self.at;
            let kind = match self.here() {
                None | Some(b'\n' | b'\r' | b'!') => match self.continuation(tokens)? {
                    true => continue,
                    false => return Some(()),
                },
                Some(b'=') => TokenKind::Equals,
                Some(b'/') => TokenKind::Slash,
                Some(b'(') => TokenKind::Open,
                Some(b')') => TokenKind::Close,
                Some(b':') => TokenKind::Colon,
                Some(mark @ (b',' | b'\\')) => {
                    // one at the end of a line carries on, unless the next begins with a comma
                    self.at += 1;
                    self.blanks();
                    match self.here() {
                        Some(b'\n' | b'\r' | b'!') => {
                            self.continuation(&mut Vec::new())?.then_some(())?;
                        }
                        None | Some(0x0B | 0x0C | 0x80..) => return None,
                        _ => {}
                    }
                    self.at = start;
                    match mark {
                        b',' => TokenKind::Comma,
                        _ => TokenKind::Backslash,
                    }
                }
                Some(b'"') => {
                    let rest = self.bytes.get(start + 1..)?;
                    let ends = |b: &u8| matches!(b, b'"' | b'\n' | b'\r');
                    let length = rest.iter().position(ends)?;
                    (rest[length] == b'"').then_some(())?;
                    self.at = start + 1 + length;
                    TokenKind::Quoted
                }
                Some(byte) if ends_word(byte) => return None,
                Some(_) => {
                    let rest = self.bytes.get(start..)?;
                    let length = rest.iter().position(|&b| ends_word(b));
                    self.at = start + length.unwrap_or(rest.len()) - 1;
                    if self.bytes.get(self.at + 1).is_some_and(|&b| b >= 0x80) {
                        return None;
                    }
                    TokenKind::Atom
                }
            };
            if tokens.is_empty() && kind != TokenKind::Atom {
                return None;
            }
            self.at += 1;
            let span = Span::new(start, self.at);
            tokens.push(Token { kind, span });
        }
    }

    /// Reads, at the end of a line, on to the comma that begins the next one, comments between them
    /// included; false: the statement ends here.
    fn continuation(&mut self, tokens: &mut Vec<Token>) -> Option<bool> {
        let (end, n_tokens) = (self.at, tokens.len());
        while self.here().is_some() {
            self.blanks();
            match self.here() {
                Some(b'!') => {
                    let span = self.rest_of_line()?;
                    let kind = TokenKind::Comment;
                    tokens.push(Token { kind, span });
                }
                Some(b'\n' | b'\r') => self.newline()?,
                Some(b',') => {
                    let span = Span::new(self.at, self.at + 1);
                    let kind = TokenKind::Continuation;
                    tokens.push(Token { kind, span });
                    self.at += 1;
                    return Some(true);
                }
                Some(0x0B | 0x0C | 0x80..) => return None,
                _ => break,
            }
        }
        tokens.truncate(n_tokens);
        self.at = end;
        Some(false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::syntax::{Source, dataset_by_grammar, script_by_grammar};
    use proptest::prelude::*;
    use std::path::Path;

    fn by_grammar(text: &str) -> Syntax {
        dataset_by_grammar(&Source::from_text(None, text), &mut Vec::new())
    }

    fn script_of_grammar(text: &str) -> Syntax {
        script_by_grammar(&Source::from_text(None, text), &mut Vec::new())
    }

    /// Files with an ending below a folder, as text.
    fn files(folder: &Path, ending: &str, found: &mut Vec<String>) {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                files(&path, ending, found);
            } else if path
                .extension()
                .is_some_and(|e| e.eq_ignore_ascii_case(ending))
            {
                let bytes = std::fs::read(&path).expect("a file can be read");
                found.push(Source::from_bytes(None, &bytes).text);
            }
        }
    }

    /// Files of examples, of tests and of the corpus, as text.
    fn all_files(ending: &str) -> Vec<String> {
        let mut all = Vec::new();
        for folder in ["examples", "tests"] {
            files(Path::new(folder), ending, &mut all);
        }
        if let Some(corpus) = std::env::var_os("COGNATE_CORPUS") {
            files(Path::new(&corpus), ending, &mut all);
        }
        all.retain(|text| text.len() < 100_000);
        all
    }

    #[test]
    fn datasets_come_out_as_the_grammar_says() {
        let (all, mut frequent) = (all_files("adm"), 0);
        for text in &all {
            if let Some(syntax) = dataset(text) {
                frequent += 1;
                assert_eq!(syntax, by_grammar(text), "{text}");
            }
        }
        assert!(2 * frequent > all.len(), "{frequent} of {}", all.len());
    }

    #[test]
    fn command_files_come_out_as_the_grammar_says() {
        let (all, mut frequent) = (all_files("acf"), 0);
        for text in &all {
            if let Some(syntax) = script(text) {
                frequent += 1;
                assert_eq!(syntax, script_of_grammar(text), "{text}");
            }
        }
        assert!(2 * frequent > all.len(), "{frequent} of {}", all.len());
    }

    #[test]
    fn a_mark_before_a_line_that_goes_on_with_a_comma_is_frequent() {
        for text in [
            "t\nREQUEST/1\n, F2=1\\\n, F3=2\nEND",
            "t\nPART/1,\n! and\n, GROUND\nEND",
            "t\nREQUEST/1, F2=1\\ ! a comment\n\n , F3=2\n",
        ] {
            assert_eq!(dataset(text), Some(by_grammar(text)), "{text}");
        }
        // it carries on by itself
        assert_eq!(dataset("t\nPART/1,\nGROUND\n"), None);
        assert_eq!(dataset("t\nPART/1\\\nGROUND\n"), None);
    }

    /// Pieces of which texts are made that are and are not frequent.
    const PIECES: &[&str] = &[
        "MARKER/1",
        "PART",
        "end",
        "END",
        "1.5E-3",
        "x_y",
        "-",
        "\0",
        "é",
        "\u{A0}",
        "\u{FEFF}",
        " ",
        "  ",
        "\t",
        "\n",
        "\n",
        "\n",
        "\r\n",
        "\r",
        ",",
        ",",
        ",\n",
        "\n,",
        "=",
        "/",
        ":",
        "(",
        ")",
        "\\",
        "\\\n",
        "&",
        "&\n",
        ";",
        "!",
        "! adams_view_name='a'",
        "!\n,",
        "\"",
        "\"a b\"",
        "\u{0B}",
        "\u{0C}",
        "STOP",
        "LIST\n",
    ];

    proptest! {
        #[test]
        fn any_text_comes_out_as_the_grammar_says_or_is_left_to_it(
            pieces in proptest::collection::vec(0..PIECES.len(), 0..24),
            begun in any::<bool>(),
        ) {
            let begin = if begun { "title\n" } else { "" };
            let text: String = [begin].into_iter().chain(pieces.iter().map(|&k| PIECES[k])).collect();
            if let Some(syntax) = dataset(&text) {
                prop_assert_eq!(syntax, by_grammar(&text), "{:?}", text);
            }
            if let Some(syntax) = script(&text) {
                prop_assert_eq!(syntax, script_of_grammar(&text), "{:?}", text);
            }
        }
    }
}
