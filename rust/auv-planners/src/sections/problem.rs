//! The section problem: one waypoint on each section between start and target; what a population
//! planner sees of it is a box of numbers and a cost.

use auv_world::World;
use auv_world::math::Vec3;

use super::{CellMap, Frame};
use crate::cost::{Cost, CostOptions, CostTerms, Evaluator, Segments};
use crate::error::PlanError;

/// A section must be at least this far from start and target, in sections, to get a waypoint.
const NEAREST: f64 = 0.3;

/// A path to be found from start to target, in the world as it is now.
///
/// A candidate is a list of genes: the lateral places (m) of its inner waypoints and then, in 3-D, their
/// depths (m).
#[derive(Debug, Clone)]
pub struct SectionProblem {
    world: World,
    frame: Frame,
    /// Free and blocked cells, in 3-D.
    cells: Option<CellMap>,
    evaluator: Evaluator,
    start: Vec3,
    target: Vec3,
    sections: Vec<usize>,
    /// x and y of each section at lateral place 0.
    bases: [Vec<f64>; 2],
    low: Vec<f64>,
    high: Vec<f64>,
    level: f64,
}

impl SectionProblem {
    /// The problem from `start` to `target`, which may lie anywhere: the inner waypoints lie on the
    /// sections strictly between them.
    ///
    /// # Errors
    /// [`PlanError`] if start or target is not a place in the world, or a cost option is not allowed.
    pub fn new(world: &World, start: Vec3, target: Vec3, cost: Cost, options: &CostOptions) -> Result<Self, PlanError> {
        check_place(world, "start", start)?;
        check_place(world, "goal", target)?;
        let mut evaluator = Evaluator::new(world, cost, options)?;
        let (frame, cells) = match evaluator.cells() {
            Some((frame, map)) => (frame.clone(), Some(map.clone())),
            None => {
                let frame = Frame::new(world);
                let cells = (world.scenario().dimensions == 3).then(|| CellMap::new(world, &frame));
                (frame, cells)
            }
        };
        let sections = between(&frame, start, target);
        evaluator.track().resize(sections.len() + 2);
        let [top, bottom] = frame.depth_bounds();
        let bounds = sections.iter().map(|section| frame.lateral_bounds(*section));
        let (mut low, mut high): (Vec<f64>, Vec<f64>) = bounds.map(|[low, high]| (low, high)).unzip();
        if world.scenario().dimensions == 3 {
            low.extend(sections.iter().map(|_| top));
            high.extend(sections.iter().map(|_| bottom));
        }
        let world = world.clone();
        let bases = [0, 1].map(|axis| sections.iter().map(|section| frame.base(*section)[axis]).collect());
        Ok(Self { world, frame, cells, evaluator, start, target, sections, bases, low, high, level: top })
    }

    /// Number of inner waypoints.
    pub fn inner(&self) -> usize {
        self.sections.len()
    }

    /// Number of genes.
    pub fn genes(&self) -> usize {
        self.low.len()
    }

    /// Whether waypoints have a depth of their own.
    pub fn has_depth(&self) -> bool {
        self.low.len() > self.sections.len()
    }

    /// Least value of each gene (m).
    pub fn low(&self) -> &[f64] {
        &self.low
    }

    /// Greatest value of each gene (m).
    pub fn high(&self) -> &[f64] {
        &self.high
    }

    /// The section of each inner waypoint.
    pub fn sections(&self) -> &[usize] {
        &self.sections
    }

    /// The world as it was when the problem was made.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Where the sections lie.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The map of free and blocked cells, in 3-D or if collisions are tested on it.
    pub fn cells(&self) -> Option<&CellMap> {
        self.cells.as_ref()
    }

    /// Start and target (m).
    pub fn ends(&self) -> [Vec3; 2] {
        [self.start, self.target]
    }

    /// What single segments cost.
    pub(crate) fn segments(&self) -> Segments {
        Segments::new(&self.evaluator, self.ends())
    }

    /// The depth of all waypoints where they have none of their own (m).
    pub fn level(&self) -> f64 {
        self.level
    }

    /// The inner waypoint `i` of a candidate (m).
    #[inline]
    pub fn waypoint(&self, genes: &[f64], i: usize) -> Vec3 {
        let inner = self.inner();
        let depth = if self.has_depth() { genes[inner + i] } else { self.level };
        self.frame.point(self.sections[i], genes[i], depth)
    }

    /// The path of a candidate, from start to target (m).
    pub fn path(&self, genes: &[f64]) -> Vec<Vec3> {
        let inner = (0..self.inner()).map(|i| self.waypoint(genes, i));
        std::iter::once(self.start).chain(inner).chain(std::iter::once(self.target)).collect()
    }

    /// The cost of a candidate.
    #[inline]
    pub fn evaluate(&mut self, genes: &[f64]) -> CostTerms {
        let inner = self.inner();
        let right = self.frame.right();
        let track = self.evaluator.track();
        track.set(0, self.start);
        for axis in 0..2 {
            let place = if axis == 0 { &mut track.x } else { &mut track.y };
            let bases = &self.bases[axis];
            for ((place, base), lateral) in place[1..=inner].iter_mut().zip(bases).zip(genes) {
                *place = base + right[axis] * lateral;
            }
        }
        if genes.len() > inner {
            track.z[1..=inner].copy_from_slice(&genes[inner..]);
        } else {
            track.z[1..=inner].fill(self.level);
        }
        track.set(inner + 1, self.target);
        self.evaluator.terms()
    }
}

/// The sections strictly between two points, in the order of travel.
fn between(frame: &Frame, start: Vec3, target: Vec3) -> Vec<usize> {
    let (from, to) = (frame.section(start[0], start[1]), frame.section(target[0], target[1]));
    let (low, high) = (from.min(to) + NEAREST, from.max(to) - NEAREST);
    let inside = (0..frame.count()).filter(|section| (low..=high).contains(&(*section as f64)));
    if from <= to { inside.collect() } else { inside.rev().collect() }
}

/// Fails unless a point is finite, within the domain's margin, and in 2-D at the depth of the plane.
pub(crate) fn check_place(world: &World, name: &str, point: Vec3) -> Result<(), PlanError> {
    let domain = &world.scenario().domain;
    for axis in 0..3 {
        let margin = if axis == 2 && world.scenario().dimensions == 2 { 0.0 } else { domain.margin_m };
        let (low, high) = (domain.min_m[axis] - margin, domain.max_m[axis] + margin);
        if !(low..=high).contains(&point[axis]) {
            let rule = format!("{} must lie in {low} .. {high} m", ["x", "y", "z"][axis]);
            return Err(PlanError::parameter(name, format!("{point:?}"), rule));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    fn problem(start: Vec3, target: Vec3) -> SectionProblem {
        let world = testing::paper_world("lfhh-3d-1", 0);
        SectionProblem::new(&world, start, target, Cost::Lfhh, &CostOptions::default()).unwrap()
    }

    #[test]
    fn waypoints_lie_on_the_sections_ahead() {
        let on_sections = problem([5e3, 3e3, 5e3], [5e3, 8e3, 5e3]);
        assert_eq!(on_sections.sections(), [4, 5, 6, 7]);
        assert_eq!(on_sections.genes(), 8);
        assert_eq!(problem([5e3, 3.71e3, 5e3], [5e3, 8e3, 5e3]).sections(), [5, 6, 7]);
        assert_eq!(problem([5e3, 3.69e3, 5e3], [5e3, 8e3, 5e3]).sections(), [4, 5, 6, 7]);
        assert_eq!(problem([5e3, 8e3, 5e3], [5e3, 3e3, 5e3]).sections(), [7, 6, 5, 4]);
        assert_eq!(problem([5e3, 8e3, 5e3], [6e3, 8.5e3, 5e3]).inner(), 0);
    }

    #[test]
    fn places_outside_are_refused() {
        let world = testing::paper_world("lfhh-3d-1", 0);
        let inside = [5e3, 3e3, 5e3];
        for wrong in [[f64::NAN, 0.0, 0.0], [-600.0, 0.0, 0.0], [0.0, 0.0, 21e3]] {
            let error = SectionProblem::new(&world, inside, wrong, Cost::Lfhh, &CostOptions::default()).unwrap_err();
            assert!(error.to_string().starts_with("goal = ["), "{error}");
        }
    }

    #[test]
    fn a_path_is_made_of_start_waypoints_and_target() {
        let mut problem = problem([5e3, 0.0, 5e3], [6e3, 3e3, 7e3]);
        let genes = [5.5e3, 5.6e3, 5.1e3, 6.2e3];
        let path = problem.path(&genes);
        assert_eq!(path, [[5e3, 0.0, 5e3], [5.5e3, 1e3, 5.1e3], [5.6e3, 2e3, 6.2e3], [6e3, 3e3, 7e3]]);
        let terms = problem.evaluate(&genes);
        assert_eq!(terms, problem.evaluator.terms_of(&path));
    }
}
