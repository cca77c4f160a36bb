//! Axis-aligned boxes.

use glam::Vec3;

/// An axis-aligned bounding box; [`Aabb::EMPTY`] holds no point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lower corner.
    pub min: Vec3,
    /// Upper corner.
    pub max: Vec3,
}

impl Aabb {
    /// The box of no points: the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// The smallest box around `points`.
    pub fn of_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::including)
    }

    /// The smallest box around this one and `point`.
    pub fn including(self, point: Vec3) -> Self {
        Self {
            min: self.min.min(point),
            max: self.max.max(point),
        }
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Whether it holds no point.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Its edges; zero where it is empty.
    pub fn extent(&self) -> Vec3 {
        (self.max - self.min).max(Vec3::ZERO)
    }

    /// Its middle.
    pub fn center(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// Largest magnitude of a coordinate of its corners; infinite where it is empty.
    pub fn reach(&self) -> f32 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// Half its surface: what the surface area heuristic compares
    /// (Goldsmith and Salmon 1987, "Automatic Creation of Object Hierarchies for Ray Tracing").
    pub fn half_area(&self) -> f32 {
        let e = self.extent();
        e.x * e.y + e.y * e.z + e.z * e.x
    }

    /// The axis (0, 1, 2) of its longest edge; the first of equals.
    pub fn longest_axis(&self) -> usize {
        let e = self.extent();
        if e.x >= e.y && e.x >= e.z {
            0
        } else if e.y >= e.z {
            1
        } else {
            2
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reach_is_that_of_the_farthest_coordinate_on_either_side() {
        let corners = [Vec3::new(-7.0, 1.0, 2.0), Vec3::new(-3.0, 5.0, 2.5)];
        let bounds = Aabb::of_points(corners);
        assert_eq!(bounds.reach(), 7.0);
        assert_eq!(Aabb::of_points(corners.map(|p| -p)).reach(), 7.0);
        assert_eq!(bounds.including(8.0 * Vec3::Y).reach(), 8.0);
        assert_eq!(Aabb::of_points([Vec3::ZERO]).reach(), 0.0);
        assert_eq!(Aabb::EMPTY.reach(), f32::INFINITY);
    }
}
