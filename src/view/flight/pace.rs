//! When the eye is where: at constant ground speed, or by times given.
//!
//! Moments run from the first to the last stop of a flight: metres of the way where no times are given, else seconds. By
//! times the metres are a monotone cubic of the seconds (`monotone`): never back, never past, the speed without jumps.

use super::monotone::Monotone;

/// Which moment is where.
#[derive(Debug, Clone)]
pub(super) enum Pace {
    /// So many metres at constant speed.
    Constant(f64),
    /// Metres by seconds, from the first to the last of these.
    Timed(Monotone, [f64; 2]),
}

impl Pace {
    /// The first and the last moment.
    pub(super) fn span(&self) -> [f64; 2] {
        match self {
            Self::Constant(length) => [0.0, *length],
            Self::Timed(_, span) => *span,
        }
    }

    /// Metres at a moment.
    pub(super) fn metres(&self, moment: f64) -> f64 {
        match self {
            Self::Constant(_) => moment,
            Self::Timed(metres, _) => metres.at(moment),
        }
    }

    /// The moments at which the eye comes to a place so many metres along, and leaves it.
    pub(super) fn moments(&self, metres: f64) -> [f64; 2] {
        match self {
            Self::Constant(_) => [metres; 2],
            Self::Timed(way, _) => [way.first_at(metres), way.last_at(metres)],
        }
    }
}
