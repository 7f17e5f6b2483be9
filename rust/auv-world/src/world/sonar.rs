//! What sonar beams meet in a world.

use wide::f64x4;

use super::World;
use crate::lanes::LANES;
use crate::math::{Vec3, sub};
use crate::obstacles::{BeamColumns, Beams, Discs, Echo, Spheres};

/// Memory that a sonar scan reuses.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    spheres: Vec<Echo>,
    discs: Vec<Echo>,
    hulls: Vec<Echo>,
    floor: Vec<u32>,
    beams: Vec<BeamColumns>,
    ranges: Vec<[f64; LANES]>,
}

impl World {
    /// How far sonar beams of unit `directions` run from `origin` before they meet a solid, a wall of
    /// the box or the surface (m), at most `longest`. `scratch` keeps its memory between calls.
    pub fn sonar(&self, origin: Vec3, directions: &[Vec3], longest: f64, scratch: &mut Scratch, ranges: &mut [f64]) {
        scratch.floor.clear();
        scratch.spheres.clear();
        scratch.discs.clear();
        scratch.hulls.clear();
        self.spheres.near(origin, longest, &mut scratch.spheres);
        self.discs.near(origin, longest, &mut scratch.discs);
        self.hulls.near(origin, longest, &mut scratch.hulls);
        self.fixed.floor.near(origin, longest, &mut scratch.floor);
        scratch.beams.clear();
        scratch.ranges.clear();
        for four in directions.chunks(LANES) {
            let lane = |lane: usize| four[lane.min(four.len() - 1)];
            let columns: BeamColumns = std::array::from_fn(|axis| std::array::from_fn(|i| lane(i)[axis]));
            let beams = columns.map(f64x4::new);
            let mut free = self.wall_range(origin, &beams, f64x4::splat(longest));
            free = Spheres::range(&beams, free, &scratch.spheres);
            free = Discs::range(&beams, free, &scratch.discs);
            scratch.beams.push(columns);
            scratch.ranges.push(free.to_array());
        }
        self.fixed.floor.range(origin, &scratch.beams, &scratch.floor, &mut scratch.ranges);
        for (range, free) in ranges.iter_mut().zip(scratch.ranges.as_flattened()) {
            *range = *free;
        }
        self.solids.range(origin, directions, longest, ranges);
    }

    /// The obstacles, in no order, whose extent the last [`World::sonar`] from `origin` with this `scratch` could have
    /// met, and where they lie from there (m): on the map alone if they reach through all depths.
    pub fn within_sonar(&self, scratch: &Scratch, origin: Vec3) -> impl Iterator<Item = (usize, Vec3)> {
        let numbers = &self.fixed.numbers;
        let named = |kind: usize, echo: &Echo| (numbers[kind][echo.index as usize] as usize, echo.offset());
        // On the map of a 2-D world a sphere may be nearer than in space.
        let flat = self.fixed.scenario.dimensions == 2;
        let (all, some) = if flat { (&numbers[0][..], &[][..]) } else { (&[][..], &scratch.spheres[..]) };
        let all = all.iter().map(move |i| (*i as usize, sub(self.obstacle_position(*i as usize), origin)));
        let spheres = some.iter().map(move |echo| named(0, echo));
        let discs = scratch.discs.iter().map(move |echo| named(1, echo));
        let others = scratch.hulls.iter().map(move |echo| {
            let (i, mut offset) = named(2, echo);
            if !self.is_flat(i) {
                offset[2] = self.obstacle_position(i)[2] - origin[2];
            }
            (i, offset)
        });
        all.chain(spheres).chain(discs).chain(others)
    }

    /// The lesser of `nearest` and how far beams run before they meet a wall of the box or the surface (m).
    fn wall_range(&self, origin: Vec3, beams: &Beams, nearest: f64x4) -> f64x4 {
        let domain = &self.fixed.scenario.domain;
        let axes = if self.fixed.scenario.dimensions == 2 { 2 } else { 3 };
        (0..axes).fold(nearest, |nearest, axis| {
            let ahead = f64x4::splat((domain.max_m[axis] - origin[axis]).max(0.0));
            let behind = f64x4::splat((origin[axis] - domain.min_m[axis]).max(0.0));
            let rate = beams[axis];
            let gap = rate.simd_gt(f64x4::ZERO).select(ahead, behind);
            let still = rate.simd_eq(f64x4::ZERO);
            still.select(nearest, nearest.fast_min(gap / still.select(f64x4::ONE, rate.abs())))
        })
    }
}
