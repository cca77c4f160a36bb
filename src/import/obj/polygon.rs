//! Polygons to triangles.

use earcut::Earcut;

use crate::math::DVec3;

/// Clipping takes time that grows with the square of the corners, for polygons that cross themselves
/// more than for others. Those with more corners than this, which take 5 to 20 seconds, are fanned.
const MOST_CORNERS: usize = 1 << 17;

/// Once polygons of a file that crossed themselves had this many corners squared, a second or two,
/// large ones are no longer clipped.
const MOST_WASTED: u64 = 1 << 30;

/// Polygons of up to this many corners are always clipped: the time is in proportion to the file.
const SMALL: usize = 256;

/// What came out of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Triangles that cover it once.
    Covered,
    /// It has no area; its triangles have none either, or cancel out.
    NoArea,
    /// It crosses itself: triangles that overlap.
    Overlapping,
    /// It is too large to be clipped in good time: a fan, whose triangles may overlap.
    TooLarge,
}

/// Cuts polygons into triangles, and keeps its buffers from one to the next.
pub struct Triangulator {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    cut: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// Sum of the squared numbers of corners of large polygons that crossed themselves.
    wasted: u64,
}

/// Twice the area of the polygon `ring` times its normal (Newell's sum), taken from its first
/// corner, so that polygons far from the origin keep their digits.
pub fn area_vector(ring: &[DVec3]) -> DVec3 {
    let first = ring[0];
    ring.windows(2)
        .map(|pair| (pair[0] - first).cross(pair[1] - first))
        .sum()
}

impl Triangulator {
    /// One with empty buffers.
    pub fn new() -> Self {
        Self {
            earcut: Earcut::new(),
            flat: Vec::new(),
            cut: Vec::new(),
            triangles: Vec::new(),
            wasted: 0,
        }
    }

    /// Cuts the polygon `ring`, of at least three corners, into exactly `ring.len() - 2`
    /// triangles that turn the way it does. They hold numbers of its corners.
    pub fn cut(&mut self, ring: &[DVec3]) -> (&[[u32; 3]], Outcome) {
        self.triangles.clear();
        let outcome = if ring.len() == 4 {
            quad(ring, &mut self.triangles)
        } else {
            self.ears(ring)
        };
        if self.triangles.len() + 2 != ring.len() {
            self.triangles.clear();
            let corners = 1..ring.len() as u32 - 1;
            self.triangles.extend(corners.map(|i| [0, i, i + 1]));
        }
        (&self.triangles, outcome)
    }

    fn ears(&mut self, ring: &[DVec3]) -> Outcome {
        let area = area_vector(ring);
        let Some(normal) = area.try_normalize().filter(|_| has_area(ring, area)) else {
            return Outcome::NoArea;
        };
        let is_small = ring.len() <= SMALL;
        if ring.len() > MOST_CORNERS || (!is_small && self.wasted > MOST_WASTED) {
            return Outcome::TooLarge;
        }
        let (u, v) = normal.any_orthonormal_pair();
        let flatten = |&p: &DVec3| [(p - ring[0]).dot(u), (p - ring[0]).dot(v)];
        self.flat.clear();
        self.flat.extend(ring.iter().map(flatten));
        self.earcut.earcut_slice(&self.flat, &[], &mut self.cut);
        let (triangles, _) = self.cut.as_chunks::<3>();
        self.triangles.extend_from_slice(triangles);
        self.turn_with_the_ring();
        restore_dropped(&self.flat, &mut self.triangles);
        if self.covers_once(area.length()) {
            Outcome::Covered
        } else {
            // A fan at least keeps the border; what was clipped may have lost parts of it.
            self.triangles.clear();
            if !is_small {
                self.wasted += (ring.len() as u64).pow(2);
            }
            Outcome::Overlapping
        }
    }

    fn turn_with_the_ring(&mut self) {
        let total: f64 = self
            .triangles
            .iter()
            .map(|&t| signed_area(&self.flat, t))
            .sum();
        if total < 0.0 {
            for triangle in &mut self.triangles {
                triangle.swap(1, 2);
            }
        }
    }

    /// Whether the triangles lie side by side and fill `area` (twice the polygon's), up to
    /// rounding.
    fn covers_once(&self, area: f64) -> bool {
        const TOLERANCE: f64 = 1e-9;
        let covered: f64 = self
            .triangles
            .iter()
            .map(|&t| signed_area(&self.flat, t).abs())
            .sum();
        self.triangles.len() + 2 == self.flat.len() && (covered - area).abs() <= TOLERANCE * area
    }
}

/// Whether the `area` of `ring` is more than the rounding of its terms.
fn has_area(ring: &[DVec3], area: DVec3) -> bool {
    const ROUNDING: f64 = 1e-13;
    let first = ring[0];
    let terms = ring.windows(2);
    let sum: f64 = terms
        .map(|pair| (pair[0] - first).length() * (pair[1] - first).length())
        .sum();
    area.length() > ROUNDING * sum
}

/// Cuts along the diagonal that leaves both halves turning as the whole does: the first where
/// both do.
fn quad(ring: &[DVec3], triangles: &mut Vec<[u32; 3]>) -> Outcome {
    let whole = area_vector(ring);
    if !has_area(ring, whole) {
        return Outcome::NoArea;
    }
    let smaller_half = |halves: [[u32; 3]; 2]| {
        let [first, second] = halves.map(|t| area_vector(&t.map(|i| ring[i as usize])).dot(whole));
        first.min(second)
    };
    let cuts = [[[0, 1, 2], [0, 2, 3]], [[1, 2, 3], [1, 3, 0]]];
    let smaller = cuts.map(smaller_half);
    let best = if smaller[0] > 0.0 || smaller[0] >= smaller[1] {
        0
    } else {
        1
    };
    triangles.extend_from_slice(&cuts[best]);
    if smaller[best] >= 0.0 {
        Outcome::Covered
    } else {
        Outcome::Overlapping
    }
}

/// Twice the area of a triangle in the plane; negative where it turns clockwise.
fn signed_area(flat: &[[f64; 2]], triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|i| flat[i as usize]);
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Brings back the corners that ear clipping dropped because they lie on an edge: the triangle
/// on that edge is split at them, so that the polygon meets its neighbours without gaps.
fn restore_dropped(flat: &[[f64; 2]], triangles: &mut Vec<[u32; 3]>) {
    let count = flat.len();
    if triangles.is_empty() || triangles.len() + 2 == count {
        return;
    }
    let mut is_kept = vec![false; count];
    for &corner in triangles.as_flattened() {
        is_kept[corner as usize] = true;
    }
    let kept: Vec<u32> = (0..count as u32).filter(|&i| is_kept[i as usize]).collect();
    let mut next_kept = vec![0; count];
    for (i, &corner) in kept.iter().enumerate() {
        next_kept[corner as usize] = kept[(i + 1) % kept.len()];
    }
    let mut edges = OuterEdges::new(&next_kept, triangles);
    for &a in &kept {
        let b = next_kept[a as usize];
        let dropped: Vec<u32> = (1..count as u32)
            .map(|step| (a + step) % count as u32)
            .take_while(|&i| i != b)
            .collect();
        if dropped.is_empty() {
            continue;
        }
        match edges.triangle_on(a) {
            Some(triangle) if lie_in_order(flat, a, &dropped, b) => {
                edges.split(triangle, a, &dropped, b, triangles);
            }
            _ => triangles.extend(fan_without_area(a, &dropped, b)),
        }
    }
}

/// Which triangle lies on each edge of a ring whose corners are followed by `next`.
struct OuterEdges<'a> {
    next: &'a [u32],
    triangle_on: Vec<Option<u32>>,
}

impl<'a> OuterEdges<'a> {
    fn new(next: &'a [u32], triangles: &[[u32; 3]]) -> Self {
        let mut edges = Self {
            next,
            triangle_on: vec![None; next.len()],
        };
        for (i, &triangle) in triangles.iter().enumerate() {
            edges.note(i as u32, triangle);
        }
        edges
    }

    fn note(&mut self, number: u32, [a, b, c]: [u32; 3]) {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            if self.next[from as usize] == to {
                self.triangle_on[from as usize] = Some(number);
            }
        }
    }

    fn triangle_on(&self, corner: u32) -> Option<u32> {
        self.triangle_on[corner as usize]
    }

    /// Splits triangle `number`, which lies on the edge from `a` to `b`, at corners between them.
    fn split(
        &mut self,
        number: u32,
        a: u32,
        between: &[u32],
        b: u32,
        triangles: &mut Vec<[u32; 3]>,
    ) {
        let corners = triangles[number as usize];
        let Some(&apex) = corners.iter().find(|&&i| i != a && i != b) else {
            return;
        };
        triangles[number as usize] = [a, between[0], apex];
        for (i, &from) in between.iter().enumerate() {
            let to = between.get(i + 1).copied().unwrap_or(b);
            self.note(triangles.len() as u32, [from, to, apex]);
            triangles.push([from, to, apex]);
        }
    }
}

/// Whether the corners `between` are met in their order on the way from `a` straight to `b`.
fn lie_in_order(flat: &[[f64; 2]], a: u32, between: &[u32], b: u32) -> bool {
    let [ax, ay] = flat[a as usize];
    let [bx, by] = flat[b as usize];
    let along = |&i: &u32| {
        let [x, y] = flat[i as usize];
        (x - ax) * (bx - ax) + (y - ay) * (by - ay)
    };
    let mut ways = between.iter().map(along).collect::<Vec<_>>();
    ways.push(along(&b));
    ways[0] >= 0.0 && ways.is_sorted()
}

/// Triangles without area that keep the corners of a spike, `between` `a` and `b`.
fn fan_without_area(a: u32, between: &[u32], b: u32) -> impl Iterator<Item = [u32; 3]> {
    let ends = between.iter().skip(1).copied().chain([b]);
    between
        .iter()
        .zip(ends)
        .map(move |(&from, to)| [a, from, to])
}
