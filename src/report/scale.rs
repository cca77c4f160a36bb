//! From errors to places on a colour bar.

/// Which errors a colour bar shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// 0 to 1, evenly.
    Unit,
    /// Powers of ten, evenly in the exponent.
    Decades {
        /// Exponent of the smallest error that is told from 0.
        low: i32,
        /// Exponent of the largest error that is told from larger ones; above `low`.
        high: i32,
    },
}

/// A number beside a colour bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Where on the bar, in `[0, 1]`.
    pub position: f32,
    /// The error there.
    pub label: String,
}

impl Scale {
    /// Where on the bar an error stands, in `[0, 1]`.
    pub fn position(self, error: f32) -> f32 {
        let position = match self {
            Self::Unit => error,
            // 0 is −∞ and stands at the lower end.
            Self::Decades { low, high } => (error.log10() - low as f32) / (high - low) as f32,
        };
        position.clamp(0.0, 1.0)
    }

    /// The numbers beside the bar, from the smallest.
    pub fn ticks(self) -> Vec<Tick> {
        let ticks = |steps: i32, label: &dyn Fn(i32) -> String| -> Vec<Tick> {
            let tick = |i: i32| Tick {
                position: i as f32 / steps as f32,
                label: label(i),
            };
            (0..=steps).map(tick).collect()
        };
        match self {
            Self::Unit => ticks(5, &|i| (f64::from(i) / 5.0).to_string()),
            Self::Decades { low, high } => ticks(high - low, &|i| match low + i {
                0 => "1".to_owned(),
                exponent => format!("1e{exponent}"),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_stand_where_their_errors_do() {
        for scale in [Scale::Unit, Scale::Decades { low: -4, high: 1 }] {
            let ticks = scale.ticks();
            assert_eq!(ticks.len(), 6);
            for Tick { position, label } in ticks {
                let error: f32 = label.parse().unwrap_or(f32::NAN);
                let shown = scale.position(error);
                assert!(
                    (shown - position).abs() < 1e-6,
                    "{label}: {shown}, {position}"
                );
            }
        }
    }

    #[test]
    fn errors_beyond_the_ends_stand_at_them() {
        let scale = Scale::Decades { low: -4, high: 0 };
        assert_eq!(scale.position(0.0), 0.0);
        assert_eq!(scale.position(1e9), 1.0);
        assert_eq!(Scale::Unit.position(2.0), 1.0);
    }
}
