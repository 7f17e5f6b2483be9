//! Sampling of new candidates (LFHH section IV-C): a random bin for each gene and a uniform place in it;
//! bins in which nothing is free are drawn again.

use auv_world::rng::Stream;

use super::model::Histograms;
use super::settings::Settings;
use super::sorted::SortedGenes;
use crate::population::Population;
use crate::sections::{CellMap, SectionProblem};

/// The histograms, and what is known of the safety of their bins.
#[derive(Debug)]
pub struct Sampler {
    histograms: Histograms,
    safe: bool,
    draws: u32,
    /// In 3-D: the cell, across or down, that holds each bound.
    cells: Vec<u32>,
    /// In 2-D: whether each bin is free somewhere.
    free: Vec<bool>,
}

impl Sampler {
    /// Room for the histograms of a problem.
    pub fn new(problem: &SectionProblem, settings: &Settings) -> Self {
        let genes = problem.genes();
        let histograms = Histograms::new(genes, settings.bins());
        let safe = settings.safe_bins.unwrap_or(problem.has_depth());
        let (cells, free) = if problem.has_depth() { (settings.bins() + 1, 0) } else { (0, settings.bins()) };
        let draws = settings.safe_draws;
        Self { histograms, safe, draws, cells: vec![0; cells * genes], free: vec![true; free * genes] }
    }

    /// Builds the histograms from the best of a population, whose genes are given sorted.
    pub fn learn(
        &mut self,
        problem: &SectionProblem,
        settings: &Settings,
        sorted: &SortedGenes,
        population: &Population,
    ) {
        let learning = if settings.learning { settings.learning_rate } else { 0.0 };
        for (gene, best) in population.member(0).iter().enumerate() {
            self.histograms.build(gene, sorted, *best, learning, problem.low()[gene], problem.high()[gene]);
        }
        if self.safe {
            match problem.cells() {
                Some(map) if problem.has_depth() => self.locate_bounds(map, problem.inner()),
                _ => self.find_free_bins(problem),
            }
        }
    }

    fn locate_bounds(&mut self, map: &CellMap, inner: usize) {
        let count = self.histograms.bins() + 1;
        for (gene, cells) in self.cells.chunks_exact_mut(count).enumerate() {
            for (cell, bound) in cells.iter_mut().zip(self.histograms.bounds(gene)) {
                *cell = if gene < inner { map.across_of(*bound) } else { map.down_of(*bound) } as u32;
            }
        }
    }

    /// A bin on a line counts as blocked if both its ends and its middle are.
    fn find_free_bins(&mut self, problem: &SectionProblem) {
        let (world, level) = (problem.world(), problem.frame().depth_bounds()[0]);
        for (gene, free) in self.free.chunks_exact_mut(self.histograms.bins()).enumerate() {
            let section = problem.sections()[gene];
            let blocked = |lateral: f64| world.clearance(problem.frame().point(section, lateral, level)) < 0.0;
            let bounds = self.histograms.bounds(gene);
            let mut low_blocked = blocked(bounds[0]);
            for (free, bound) in free.iter_mut().zip(bounds.windows(2)) {
                let high_blocked = blocked(bound[1]);
                *free = !(low_blocked && high_blocked && blocked((bound[0] + bound[1]) / 2.0));
                low_blocked = high_blocked;
            }
        }
    }

    /// Draws a candidate.
    #[inline]
    pub fn sample(&self, problem: &SectionProblem, stream: &mut Stream, genes: &mut [f64]) {
        match problem.cells() {
            _ if !self.safe => self.histograms.sample(stream, genes),
            Some(map) if problem.has_depth() => self.sample_pairs(problem, map, stream, genes),
            _ => self.sample_lines(stream, genes),
        }
    }

    fn sample_lines(&self, stream: &mut Stream, genes: &mut [f64]) {
        for (gene, value) in genes.iter_mut().enumerate() {
            let free = &self.free[gene * self.histograms.bins()..];
            let mut draw = self.histograms.draw(stream);
            for _ in 1..self.draws {
                if free[draw.0] {
                    break;
                }
                draw = self.histograms.draw(stream);
            }
            *value = self.histograms.value(gene, draw);
        }
    }

    fn sample_pairs(&self, problem: &SectionProblem, map: &CellMap, stream: &mut Stream, genes: &mut [f64]) {
        let inner = problem.inner();
        for (i, &section) in problem.sections().iter().enumerate() {
            let mut pair = [self.histograms.draw(stream), self.histograms.draw(stream)];
            for _ in 1..self.draws {
                if map.has_free(section, self.span(i, pair[0].0), self.span(inner + i, pair[1].0)) {
                    break;
                }
                pair = [self.histograms.draw(stream), self.histograms.draw(stream)];
            }
            genes[i] = self.histograms.value(i, pair[0]);
            genes[inner + i] = self.histograms.value(inner + i, pair[1]);
        }
    }

    /// The cells that a bin reaches into, first and last.
    #[inline]
    fn span(&self, gene: usize, bin: usize) -> [usize; 2] {
        let first = gene * (self.histograms.bins() + 1) + bin;
        [self.cells[first] as usize, self.cells[first + 1] as usize]
    }
}
