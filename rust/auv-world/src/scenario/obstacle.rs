//! Solid obstacles, as the file has them.

use serde::{Deserialize, Serialize};

use crate::math::{Vec2, Vec3};

/// A solid obstacle: a shape, where it is, and how fast it moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Obstacle {
    /// A ball.
    Sphere(Sphere),
    /// A vertical cylinder through all depths: a disc on the map.
    Disc(Disc),
    /// A vertical cylinder between two depths.
    Cylinder(Cylinder),
    /// A superquadric, |x/a|^ex + |y/b|^ey + |z/c|^ez <= 1 (IIFDS eq. 1).
    Superquadric(Superquadric),
    /// A polygon, extruded between two depths.
    Polygon(Polygon),
}

/// A ball.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Centre (m).
    pub position_m: Vec3,
    /// Radius (m).
    pub radius_m: f64,
    /// Velocity (m/s); the centre reflects at the walls.
    #[serde(default)]
    pub velocity_mps: Vec3,
    /// How it departs from that velocity; without it, never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manoeuvre: Option<Manoeuvre>,
}

/// A disc on the map, solid at all depths.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Centre (m).
    pub position_m: Vec2,
    /// Radius (m).
    pub radius_m: f64,
    /// Velocity (m/s); the centre reflects at the walls.
    #[serde(default)]
    pub velocity_mps: Vec2,
    /// How it departs from that velocity; without it, never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manoeuvre: Option<Manoeuvre>,
}

/// A vertical cylinder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Centre (m).
    pub position_m: Vec2,
    /// Radius (m).
    pub radius_m: f64,
    /// Depth of the top (m).
    pub top_m: f64,
    /// Depth of the bottom (m).
    pub bottom_m: f64,
    /// Velocity (m/s); the centre reflects at the walls.
    #[serde(default)]
    pub velocity_mps: Vec2,
}

/// A superquadric with axes along x, y, z.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Superquadric {
    /// Centre (m).
    pub position_m: Vec3,
    /// Semi-axes a, b, c (m).
    pub semi_axes_m: Vec3,
    /// Exponents along x, y, z, each at least 1.
    pub exponents: Vec3,
    /// Velocity (m/s); the centre reflects at the walls.
    #[serde(default)]
    pub velocity_mps: Vec3,
}

/// A simple polygon, extruded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Polygon {
    /// Corners in order (m).
    pub vertices_m: Vec<Vec2>,
    /// Depth of the top (m).
    pub top_m: f64,
    /// Depth of the bottom (m).
    pub bottom_m: f64,
    /// Velocity (m/s); the mean of the corners reflects at the walls.
    #[serde(default)]
    pub velocity_mps: Vec2,
}

/// How an obstacle changes course. Its centre reflects at the walls as ever.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Manoeuvre {
    /// Round and round on the map at an even speed.
    Turn {
        /// Rate of the course (rad/s), positive from x towards y; not 0.
        rate_radps: f64,
    },
    /// To one side of its course and to the other, at an even speed.
    Zigzag {
        /// How far the course is off (rad), first from x towards y if positive.
        angle_rad: f64,
        /// From one turn to the next but one (s). The first comes after a quarter of it.
        period_s: f64,
    },
    /// New velocities at given times.
    Legs {
        /// In order of time.
        legs: Vec<Leg>,
    },
}

/// A velocity from some time on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Leg {
    /// From then on (s after the start).
    pub from_s: f64,
    /// Velocity (m/s). That of a disc is one on the map: its last entry is 0.
    pub velocity_mps: Vec3,
}
