//! Logarithmic axes: their range, their ticks, and what stands at them.

use std::ops::Range;

use plotters::coord::ranged1d::{
    KeyPointHint, KeyPointWeight, NoDefaultFormatting, Ranged, ValueFormatter,
};

/// A logarithmic axis.
#[derive(Clone, Debug)]
pub struct LogAxis {
    range: Range<f64>,
}

/// Labels are written out, and not as powers of ten, where all are within this range.
const PLAIN: Range<f64> = 0.99e-3..1e5;

/// Fewest labels that an axis has, unless the range is very small.
const FEWEST_LABELS: usize = 3;
const MOST_LABELS: usize = 7;

impl LogAxis {
    /// An axis with room around all positive `values`; one decade where there are none.
    pub fn around(values: impl Iterator<Item = f64>) -> Self {
        let (least, most) = values
            .filter(|&v| is_drawable(v))
            .fold((f64::INFINITY, 0.0f64), |(least, most), v| {
                (least.min(v), most.max(v))
            });
        if most == 0.0 {
            return Self { range: 1.0..10.0 };
        }
        let room = (most / least).powf(0.06).max(1.25);
        Self {
            range: least / room..most * room,
        }
    }

    /// What has a label: powers of ten, and more between them where those are too few.
    fn labelled(&self) -> Vec<f64> {
        let steps: [&[i32]; 3] = [&[1], &[1, 2, 5], &[1, 2, 3, 4, 5, 6, 8]];
        let labelled = steps.map(|of| self.multiples(of));
        let enough = labelled.iter().find(|l| l.len() >= FEWEST_LABELS);
        let [.., finest] = &labelled;
        let labelled = enough.unwrap_or(finest);
        let step = labelled.len().div_ceil(MOST_LABELS).max(1);
        labelled.iter().copied().step_by(step).collect()
    }

    /// These multiples of the powers of ten in the range.
    fn multiples(&self, of: &[i32]) -> Vec<f64> {
        let (first, last) = (self.range.start.log10().floor(), self.range.end.log10());
        (first as i32..=last as i32)
            .flat_map(|decade| of.iter().map(move |&m| power(m, decade)))
            .filter(|v| self.range.contains(v))
            .collect()
    }

    /// What stands at `value`.
    pub fn label(&self, value: f64) -> String {
        let decade = (value.log10() + 1e-9).floor() as i32;
        if self.labelled().iter().all(|v| PLAIN.contains(v)) {
            let digits = usize::try_from(-decade).unwrap_or(0);
            return format!("{value:.digits$}");
        }
        let raised: String = decade.to_string().chars().map(superscript).collect();
        match (value / power(1, decade)).round() {
            1.0 => format!("10{raised}"),
            times => format!("{times}·10{raised}"),
        }
    }
}

/// Whether a logarithmic axis has a place for it.
pub fn is_drawable(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

/// Correctly rounded, which `powi` is not.
fn power(times: i32, decade: i32) -> f64 {
    let factor = 10f64.powi(decade.abs());
    let times = f64::from(times);
    if decade < 0 {
        times / factor
    } else {
        times * factor
    }
}

fn superscript(digit: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    digit.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])
}

impl Ranged for LogAxis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value / self.range.start).ln() / (self.range.end / self.range.start).ln();
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        match hint.weight() {
            KeyPointWeight::Bold => self.labelled(),
            KeyPointWeight::Any => self.multiples(&[1, 2, 3, 4, 5, 6, 7, 8, 9]),
        }
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

impl ValueFormatter<f64> for LogAxis {
    fn format_ext(&self, value: &f64) -> String {
        self.label(*value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(values: [f64; 2]) -> Vec<String> {
        let axis = LogAxis::around(values.into_iter());
        axis.labelled().into_iter().map(|v| axis.label(v)).collect()
    }

    #[test]
    fn labels_suit_the_range() {
        assert_eq!(labels([2.0, 25.0]), ["2", "5", "10", "20"]);
        assert_eq!(
            labels([0.01, 3.0]),
            ["0.01", "0.10", "1"].map(|l| l.replace("0.10", "0.1"))
        );
        assert_eq!(labels([1e3, 1.6e7]), ["10³", "10⁴", "10⁵", "10⁶", "10⁷"]);
        assert_eq!(
            labels([3.1e-5, 5.5e-5]),
            ["3·10⁻⁵", "4·10⁻⁵", "5·10⁻⁵", "6·10⁻⁵"]
        );
    }

    #[test]
    fn every_range_has_room_and_few_labels() {
        for decades in 1..40 {
            let values = [1e-20, 1e-20 * 10f64.powi(decades)];
            let axis = LogAxis::around(values.into_iter());
            let Range { start, end } = axis.range();
            assert!(start < values[0] && end > values[1]);
            assert!((2..=8).contains(&axis.labelled().len()), "{decades}");
        }
        assert_eq!(
            LogAxis::around([f64::NAN, -1.0].into_iter()).range(),
            1.0..10.0
        );
    }
}
