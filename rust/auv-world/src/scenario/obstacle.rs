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
