//! Changes of a dataset's text that leave the rest of it as it stands, to the byte: an element is
//! taken out, or has another name.

use super::Dataset;
use super::syntax::{Item, view_name};
use crate::diagnostic::Span;
use crate::model::ElementId;

impl Dataset {
    /// Returns the statement of an element as it was written; of several the last, which is the one
    /// that counts.
    pub fn statement(&self, id: ElementId) -> Option<&str> {
        let item = self.items_of(id).next_back()?;
        Some(self.source.slice(self.syntax.items[item].span()))
    }

    /// Returns the text without the statement of an element and the comment with its name; `None`
    /// where there is no such statement.
    pub fn without(&self, id: ElementId) -> Option<String> {
        let mut text = self.to_text().to_owned();
        let mut found = false;
        for item in self.own_items_of(id) {
            let statement = self.syntax.items[item].span();
            let first = self.name_of(item).map_or(statement, |(comment, _)| comment);
            text.replace_range(self.in_file(self.lines(first.start, statement.end)), "");
            found = true;
        }
        found.then_some(text)
    }

    /// Returns the text with another name in the comment above an element's statement; `None` where
    /// there is no such statement.
    pub fn renamed(&self, id: ElementId, name: &str) -> Option<String> {
        let mut text = self.to_text().to_owned();
        let mut found = false;
        for item in self.own_items_of(id) {
            match self.name_of(item) {
                Some((_, old)) => text.replace_range(self.in_file(old), name),
                None => {
                    let at = self.syntax.items[item].span().start;
                    let at = self.in_file(self.lines(at, at)).start;
                    text.insert_str(at, &["! adams_view_name='", name, "'\n"].concat());
                }
            }
            found = true;
        }
        found.then_some(text)
    }

    /// Returns the file in which an element stands, where it is one that the dataset includes.
    pub fn included_file_of(&self, id: ElementId) -> Option<&str> {
        let item = self.items_of(id).next_back()?;
        let file = self.source.file_at(self.syntax.items[item].span().start);
        file.filter(|file| self.source.file.as_deref() != Some(file))
    }

    /// Returns the indices of the statements of an element in the file itself, the last first.
    fn own_items_of(&self, id: ElementId) -> impl Iterator<Item = usize> {
        let is_own = |item: &usize| {
            let start = self.syntax.items[*item].span().start;
            self.source.file_at(start) == self.source.file.as_deref()
        };
        self.items_of(id).rev().filter(is_own)
    }

    /// Returns the bytes within their file of bytes of the text.
    fn in_file(&self, bytes: std::ops::Range<usize>) -> std::ops::Range<usize> {
        let span = self.source.in_file(Span::new(bytes.start, bytes.end));
        span.start..span.end
    }

    /// Returns the indices of the statements of an element; what commands of Adams View made has
    /// none.
    fn items_of(&self, id: ElementId) -> impl DoubleEndedIterator<Item = usize> {
        let written = self.records.len().min(self.syntax.items.len());
        let all = self.records[..written].iter().enumerate();
        let mine = all.filter(move |(_, record)| {
            let row = record.as_ref().map(|r| (r.row.kind(), r.id));
            row == Some((Some(id.kind), Some(id.number)))
        });
        mine.map(|(item, _)| item)
    }

    /// Returns the comment above a statement that names it, and the place of the name in the text.
    fn name_of(&self, item: usize) -> Option<(Span, std::ops::Range<usize>)> {
        let before = self.syntax.items[..item].iter().rev();
        let comments = before.map_while(|item| match item {
            Item::Comment(span) => Some(*span),
            Item::Statement(_) => None,
        });
        for span in comments {
            let comment = self.source.slice(span);
            if let Some(name) = view_name(comment) {
                let at = span.start + comment.find(&["'", &name, "'"].concat())? + 1;
                return Some((span, at..at + name.len()));
            }
        }
        None
    }

    /// Returns the bytes of the whole lines from one byte to another, the end of the last included.
    fn lines(&self, first: usize, last: usize) -> std::ops::Range<usize> {
        let text = self.source.text.as_bytes();
        let is_end = |b: &u8| *b == b'\n';
        let start = text[..first].iter().rposition(is_end).map_or(0, |k| k + 1);
        let rest = text[last..].iter().position(is_end);
        start..rest.map_or(text.len(), |k| last + k + 1)
    }
}

#[cfg(test)]
mod tests {
    use crate::dataset::read_text;
    use crate::model::ElementKind;

    const TEXT: &str = "two joints\nPART/1, GROUND\n! a remark\nPART/2, MASS=1, CM=2\nMARKER/2, PART=2\n\
        MARKER/1, PART=1\n!          adams_view_name='crank'\n! beside it\nJOINT/1\n, I=2, J=1\n, REVOLUTE ! last\n\
        COUPLER/4, JOINTS=1,1, SCALES=1,2\nEND\n";

    #[test]
    fn an_element_is_taken_out_with_its_name_and_nothing_else() {
        let dataset = read_text(TEXT).dataset;
        let joint = ElementKind::Joint.id(1);
        let without = dataset.without(joint).unwrap();
        let (before, after) = TEXT.split_once("!          adams").unwrap();
        let after = &after[after.find("COUPLER").unwrap()..];
        assert_eq!(without, [before, after].concat());
        assert_eq!(
            dataset.statement(joint),
            Some("JOINT/1\n, I=2, J=1\n, REVOLUTE")
        );
        assert_eq!(dataset.without(ElementKind::Joint.id(2)), None);
    }

    #[test]
    fn a_name_is_changed_where_it_stands_or_is_put_above_the_statement() {
        let dataset = read_text(TEXT).dataset;
        let joint = ElementKind::Joint.id(1);
        let renamed = dataset.renamed(joint, "rocker").unwrap();
        assert_eq!(renamed, TEXT.replace("'crank'", "'rocker'"));
        let coupler = ElementKind::Coupler.id(4);
        let named = read_text(&dataset.renamed(coupler, "belt").unwrap());
        let place = named.model.element(coupler).unwrap().place();
        assert_eq!(place.name.as_deref(), Some("belt"));
        assert_eq!(named.model.joints, read_text(TEXT).model.joints);
    }
}
