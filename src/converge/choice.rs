//! Which points a page shows beside each other: those that took about the same time.

use super::point::Point;
use super::study::Study;

/// Most times that can be chosen from.
const TIMES: usize = 4;
/// Most points that are shown: their pictures are in the page.
const MOST_POINTS: usize = 48;

/// What can be chosen.
pub struct Choices {
    /// The times, seconds, from the shortest.
    pub seconds: Vec<f64>,
    /// By time, then by method in the order of [`Study::curves`]: an index of `points`.
    pub by_time: Vec<Vec<usize>>,
    /// Indices of the study's points, each once.
    pub points: Vec<usize>,
}

/// The points of every method that are nearest to a few times, from short to long.
pub fn choices(study: &Study) -> Choices {
    let curves = study.curves();
    let times = study.points.iter().map(|p| p.busy_seconds);
    let (low, high) = times.fold((f64::INFINITY, 0.0f64), |(low, high), t| {
        (low.min(t), high.max(t))
    });
    let mut choices = Choices {
        seconds: Vec::new(),
        by_time: Vec::new(),
        points: Vec::new(),
    };
    if !(low > 0.0 && low.is_finite()) {
        return choices;
    }
    let count = (MOST_POINTS / curves.len()).clamp(1, TIMES);
    for i in 1..=count {
        let seconds = low * (high / low).powf(i as f64 / count as f64);
        let row = curves
            .iter()
            .filter_map(|(_, points)| nearest(points, seconds));
        let row: Vec<usize> = row
            .filter_map(|point| study.points.iter().position(|p| std::ptr::eq(p, point)))
            .map(|point| choices.view(point))
            .collect();
        choices.seconds.push(seconds);
        choices.by_time.push(row);
    }
    choices
}

impl Choices {
    /// The index of a point in `points`, where it is put if it is not there.
    fn view(&mut self, point: usize) -> usize {
        let found = self.points.iter().position(|&p| p == point);
        found.unwrap_or_else(|| {
            self.points.push(point);
            self.points.len() - 1
        })
    }
}

fn nearest<'a>(points: &[&'a Point], seconds: f64) -> Option<&'a Point> {
    let distance = |p: &Point| (p.busy_seconds / seconds).ln().abs();
    let nearest = points
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.copied()
}
