//! Why a map of polygons cannot be planned on, in words for whoever drew it.

/// What is wrong with a map or with a place on it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MapError {
    /// The area is no rectangle.
    #[error("the area from {low:?} to {high:?} m is no rectangle with width and height")]
    Area {
        /// Its lower corner (m).
        low: [f64; 2],
        /// Its upper corner (m).
        high: [f64; 2],
    },
    /// A number that must not be negative, or must be at least 1.
    #[error("{name} = {value}: {allowed}")]
    Number {
        /// Its name.
        name: &'static str,
        /// The value found.
        value: f64,
        /// What was allowed.
        allowed: &'static str,
    },
    /// A polygon that is none.
    #[error("polygon {index}: {reason}")]
    Polygon {
        /// Its place in the list.
        index: usize,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A place outside the area.
    #[error("the {name} {point:?} lies outside the area")]
    Outside {
        /// "start" or "goal".
        name: &'static str,
        /// The place (m).
        point: [f64; 2],
    },
    /// A place inside a danger zone.
    #[error("the {name} {point:?} lies inside the danger zone of polygon {polygons:?}")]
    InZone {
        /// "start" or "goal".
        name: &'static str,
        /// The place (m).
        point: [f64; 2],
        /// The polygons of the zone.
        polygons: Vec<usize>,
    },
    /// Danger zones part start and goal.
    #[error("the danger zones of polygons {polygons:?} part the goal from the start")]
    NoWay {
        /// The polygons of the zones on the border of the water that can be reached.
        polygons: Vec<usize>,
    },
    /// Zones that lie so that links and cells cannot be told apart at a ten millionth of a metre.
    #[error("near {point:?} the danger zones lie too close for links: {reason}")]
    Degenerate {
        /// Where (m).
        point: [f64; 2],
        /// What failed.
        reason: &'static str,
    },
}
