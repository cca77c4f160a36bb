//! Tables for people: columns in line, or as Markdown.

use std::fmt::{self, Display};

/// Rows of text under a head. The first column is aligned to the left, the others to the right.
pub struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with these columns and no rows.
    pub fn new(head: &[&str]) -> Self {
        Self {
            rows: vec![head.iter().map(|&name| name.to_owned()).collect()],
        }
    }

    /// Adds a row; columns that it lacks stay empty.
    pub fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        let columns = self.rows[0].len();
        let mut lines: Vec<String> = self
            .rows
            .iter()
            .map(|row| format!("| {} |\n", row.join(" | ")))
            .collect();
        lines.insert(1, format!("|:--|{}\n", "--:|".repeat(columns - 1)));
        lines.concat()
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.rows[0].len();
        let width = |column: usize| {
            let cells = self.rows.iter().filter_map(move |row| row.get(column));
            cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        for (i, row) in self.rows.iter().enumerate() {
            let mut line = String::new();
            for (column, (cell, &width)) in row.iter().zip(&widths).enumerate() {
                line += &match column {
                    0 => format!("  {cell:<width$}"),
                    _ => format!("  {cell:>width$}"),
                };
            }
            let end = if i == 0 { "" } else { "\n" };
            write!(f, "{end}{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// A number with as many digits as its size is worth: three, and no fewer than stand before the
/// point.
pub fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if size < 1e-3 => format!("{value:.2e}"),
        size => {
            let digits = (2.0 - size.log10().floor()).max(0.0) as usize;
            format!("{value:.digits$}")
        }
    }
}

/// As [`number`]; a dash where it is not known.
pub fn known(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.0, 1234.5, 99.95, 1.2345, 0.012_345, 0.000_123].map(number);
        assert_eq!(shown, ["0", "1234", "100.0", "1.23", "0.0123", "1.23e-4"]);
        assert_eq!(known(None), "-");
    }

    #[test]
    fn columns_are_in_line() {
        let mut table = Table::new(&["name", "x"]);
        table.row(vec!["a".to_owned(), "100".to_owned()]);
        table.row(vec!["long name".to_owned(), "2".to_owned()]);
        let expected = "  name         x\n  a          100\n  long name    2";
        assert_eq!(table.to_string(), expected);
        assert_eq!(
            table.markdown(),
            "| name | x |\n|:--|--:|\n| a | 100 |\n| long name | 2 |\n"
        );
    }
}
