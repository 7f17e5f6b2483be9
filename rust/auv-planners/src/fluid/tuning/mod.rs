//! The coefficients of the flow, tuned (section IV): rho, theta, sigma of all obstacles, and lambda. One
//! evaluation is one line drawn and judged.

mod differential;
mod genetic;
mod objective;
mod tuner;

pub use differential::{Settings as DifferentialSettings, plan_iifds_de, tune_differential};
pub use genetic::{Leaders, Mutation, Settings as GeneticSettings, plan_iifds_ga, plan_iifds_iga, tune_genetic};
pub use objective::{Kind, Objective, length_and_angle};
pub use tuner::{Genes, Tuned};
