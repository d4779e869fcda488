//! Tables of text: columns as wide as what stands in them, as many side by side as there is room.

/// A table: a row of heads, and rows of cells. Cells that begin with a letter stand at the left.
pub struct Table {
    rows: Vec<Vec<String>>,
    n_heads: usize,
}

/// Blanks between columns.
const GAP: usize = 2;

impl Table {
    /// Begins a table with its heads.
    pub fn new<S: Into<String>>(heads: impl IntoIterator<Item = S>) -> Self {
        let heads = heads.into_iter().map(Into::into).collect();
        Self {
            rows: vec![heads],
            n_heads: 1,
        }
    }

    /// Adds a second row of heads.
    pub fn head(&mut self, row: Vec<String>) {
        self.rows.push(row);
        self.n_heads = self.rows.len();
    }

    /// Adds a row.
    pub fn push(&mut self, row: impl IntoIterator<Item = String>) {
        self.rows.push(row.into_iter().collect());
    }

    /// Returns the width of a column, in characters.
    fn width(&self, column: usize) -> usize {
        let cells = self.rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    }

    /// Returns true if a column holds words: these stand at the left.
    fn is_text(&self, column: usize) -> bool {
        let cells = self.rows.iter().skip(self.n_heads);
        let mut cells = cells
            .filter_map(|row| row.get(column))
            .filter(|cell| !cell.is_empty());
        cells.any(|cell| cell.parse::<f64>().is_err())
    }

    /// Returns how many columns fit into a width; at least two.
    pub fn n_fitting(&self, width: usize) -> usize {
        let n = self.rows.first().map_or(0, Vec::len);
        let mut used = 0;
        for column in 0..n {
            used += self.width(column) + if column > 0 { GAP } else { 0 };
            if used > width && column > 1 {
                return column;
            }
        }
        n
    }

    /// Prints the first `n` columns.
    pub fn first(&self, n: usize) -> String {
        let columns: Vec<usize> = (0..n).collect();
        self.lines(&columns)
    }

    /// Prints all columns in blocks that fit into a width; each block repeats the first column.
    pub fn text(&self, width: usize) -> String {
        let n = self.rows.first().map_or(0, Vec::len);
        let (mut text, mut block, mut used) = (String::new(), vec![0], self.width(0));
        for column in 1..n {
            let more = GAP + self.width(column);
            if used + more > width && block.len() > 1 {
                text += &self.lines(&block);
                text.push('\n');
                (block, used) = (vec![0], self.width(0));
            }
            block.push(column);
            used += more;
        }
        text + &self.lines(&block)
    }

    /// Prints some columns.
    fn lines(&self, columns: &[usize]) -> String {
        let shape = |&column: &usize| (column, self.width(column), self.is_text(column));
        let shapes: Vec<_> = columns.iter().map(shape).collect();
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::new();
            for &(column, width, is_text) in &shapes {
                let cell = row.get(column).map_or("", String::as_str);
                if !line.is_empty() {
                    line += &" ".repeat(GAP);
                }
                if is_text {
                    line += &format!("{cell:width$}");
                } else {
                    line += &format!("{cell:>width$}");
                }
            }
            text += line.trim_end();
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_that_do_not_fit_follow_below_with_the_first() {
        let mut table = Table::new(["name", "a long head", "x"]);
        table.push(["one", "1", "-2.5"].map(String::from));
        assert_eq!(
            table.text(80),
            "name  a long head     x\none             1  -2.5\n"
        );
        assert_eq!(
            table.text(20),
            "name  a long head\none             1\n\nname     x\none   -2.5\n"
        );
        assert_eq!((table.n_fitting(80), table.n_fitting(20)), (3, 2));
    }
}
