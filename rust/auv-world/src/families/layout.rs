//! What makes one family differ from another, as a table. Lengths are in units of the papers' maps: a
//! kilometre for LFHH, a metre for AFHH.

use super::{Difficulty, Variant};

/// A box 20 wide, 40 long and, in 3-D, 20 deep, and what is in it.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// The family's name.
    pub name: &'static str,
    /// 2 or 3.
    pub dimensions: u8,
    /// The unit of length (m).
    pub unit_m: f64,
    /// The vehicle's speed (m/s).
    pub speed_mps: f64,
    /// Its fastest turn (degrees a second).
    pub yaw_rate_deg: f64,
    /// Number of discs or spheres at each difficulty: easy, normal, hard.
    pub obstacles: [usize; 3],
    /// Their least and greatest radius.
    pub radius: [f64; 2],
    /// Number of peaks on the sea floor.
    pub peaks: usize,
    /// Their least and greatest height.
    pub peak_height: [f64; 2],
    /// Number of vortices.
    pub vortices: usize,
    /// Path length between map changes; 0 = the map never changes.
    pub change_every: f64,
    /// Standard deviation of an obstacle's step at a change.
    pub obstacle_step: f64,
    /// How hard.
    pub calibration: fn(Variant, Difficulty) -> Calibration,
}

/// What a difficulty stands for.
#[derive(Debug, Clone, Copy)]
pub struct Calibration {
    /// Fastest current over the vehicle's speed; of a single ring in the `paper` variant.
    pub current_ratio: f64,
    /// Time limit over the still-water straight-line time.
    pub time_factor: f64,
}

/// All families.
pub const LAYOUTS: [Layout; 3] = [
    Layout {
        name: "lfhh-2d",
        dimensions: 2,
        unit_m: 1000.0,
        speed_mps: 2.0,
        yaw_rate_deg: 3.0,
        obstacles: [22; 3],
        radius: [0.8, 1.6],
        peaks: 0,
        peak_height: [0.0, 0.0],
        vortices: 6,
        change_every: 6.0,
        obstacle_step: 0.7,
        calibration: |variant, difficulty| lfhh(variant, difficulty, [1.25, 1.3]),
    },
    Layout {
        name: "lfhh-3d",
        dimensions: 3,
        unit_m: 1000.0,
        speed_mps: 2.0,
        yaw_rate_deg: 3.0,
        obstacles: [70; 3],
        radius: [1.5, 3.0],
        peaks: 12,
        peak_height: [6.0, 15.0],
        vortices: 6,
        change_every: 6.0,
        obstacle_step: 0.5,
        calibration: |variant, difficulty| lfhh(variant, difficulty, [1.3, 1.4]),
    },
    Layout {
        name: "afhh",
        dimensions: 3,
        unit_m: 1.0,
        speed_mps: 0.5,
        // A small vehicle that hovers: it turns within the capture radius.
        yaw_rate_deg: 180.0,
        obstacles: [60, 120, 200],
        radius: [1.0, 2.0],
        peaks: 5,
        peak_height: [4.0, 12.0],
        vortices: 0,
        change_every: 0.0,
        obstacle_step: 0.5,
        calibration: |_, difficulty| afhh(difficulty),
    },
];

/// Calibrated so that at `normal` the straight line succeeds in less than 20 %, the sonar rule in less than
/// 80 % and the snapshot re-planner in more than 90 % of the debiased worlds. `time_factors`: of the
/// debiased worlds, normal and hard.
fn lfhh(variant: Variant, difficulty: Difficulty, time_factors: [f64; 2]) -> Calibration {
    use Difficulty::{Easy, Hard, Normal};
    let [normal, hard] = time_factors;
    let (current_ratio, time_factor) = match (variant, difficulty) {
        (Variant::Paper, Easy) => (0.1, 1.5),
        (Variant::Paper, Normal) => (0.4, 1.5),
        (Variant::Paper, Hard) => (0.7, 1.5),
        (Variant::Debiased, Easy) => (0.2, 1.5),
        (Variant::Debiased, Normal) => (0.8, normal),
        (Variant::Debiased, Hard) => (1.2, hard),
    };
    Calibration { current_ratio, time_factor }
}

/// In still water the spheres and the time limit make a tank hard, calibrated alike; the current ratio is for
/// vortices that are asked for.
fn afhh(difficulty: Difficulty) -> Calibration {
    let (current_ratio, time_factor) = match difficulty {
        Difficulty::Easy => (0.2, 1.5),
        Difficulty::Normal => (0.4, 1.15),
        Difficulty::Hard => (0.9, 1.1),
    };
    Calibration { current_ratio, time_factor }
}
