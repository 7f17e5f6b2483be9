//! Interfered fluid dynamical system (IIFDS, Yao & Zhao 2018): a path is a line of a flow that runs to the
//! goal and round everything solid. Equation numbers in this folder are those of the paper.

mod field;
mod held;
mod iifds;
mod judge;
mod obstacles;
mod settings;
mod shape;
mod superquadric;
pub mod threats;
mod trace;
pub mod tuning;
mod union;

pub use field::{Body, Coefficients, Field, Modulation};
pub(crate) use held::Held;
pub use iifds::{Settings, plan_iifds};
pub(crate) use judge::Judge;
pub use obstacles::{Class, bodies};
pub use settings::{ClassCoefficients, Classes, Flow, Options};
pub use shape::{Contact, Distance, Shape};
pub use superquadric::Superquadric;
pub use trace::{Advance, Ending, Steps, Walls, trace};
