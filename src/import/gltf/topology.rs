//! From the drawing modes of OpenGL to triangles (glTF 2.0, section 3.7.2.1).

/// How vertices form primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mode {
    /// Points or lines: nothing that we show.
    NotTriangles,
    /// Three corners each.
    Triangles,
    /// Each corner with the two before it, every other time the other way round.
    Strip,
    /// Each pair of neighbours with the first corner.
    Fan,
}

impl Mode {
    /// `mode` of primitives that do not say.
    pub const DEFAULT_CODE: u32 = 4;

    /// From `mode` of a primitive; `None` where that is not known.
    pub fn from_code(mode: u32) -> Option<Self> {
        match mode {
            0..=3 => Some(Self::NotTriangles),
            4 => Some(Self::Triangles),
            5 => Some(Self::Strip),
            6 => Some(Self::Fan),
            _ => None,
        }
    }

    /// How many triangles `corners` corners make.
    pub fn triangle_count(self, corners: usize) -> usize {
        match self {
            Self::NotTriangles => 0,
            Self::Triangles => corners / 3,
            Self::Strip | Self::Fan => corners.saturating_sub(2),
        }
    }

    /// The triangles of `corners`, degenerate ones included, counter-clockwise as the
    /// specification orders them.
    pub fn triangles(self, corners: &[u32]) -> Vec<[u32; 3]> {
        let c = corners;
        (0..self.triangle_count(c.len()))
            .map(|i| match self {
                Self::NotTriangles | Self::Triangles => [c[3 * i], c[3 * i + 1], c[3 * i + 2]],
                Self::Strip => [c[i], c[i + 1 + i % 2], c[i + 2 - i % 2]],
                Self::Fan => [c[i + 1], c[i + 2], c[0]],
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_orientation() {
        let strip = Mode::Strip.triangles(&[0, 1, 2, 3, 4]);
        assert_eq!(strip, [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        let fan = Mode::Fan.triangles(&[9, 1, 2, 3]);
        assert_eq!(fan, [[1, 2, 9], [2, 3, 9]]);
    }

    #[test]
    fn too_few_corners_make_nothing() {
        for mode in [Mode::Triangles, Mode::Strip, Mode::Fan, Mode::NotTriangles] {
            assert!(mode.triangles(&[0, 1]).is_empty(), "{mode:?}");
        }
    }
}
