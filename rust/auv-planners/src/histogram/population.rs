//! A population with room for as many children: the best of both live on (LFHH Algorithm 2, lines 23-24).

/// Candidates, their costs, and who is best.
#[derive(Debug, Clone)]
pub struct Population {
    genes: usize,
    size: usize,
    /// Twice `size` candidates, one after the other.
    values: Vec<f64>,
    cost: Vec<f64>,
    /// Places of the candidates: first the living from best to worst, then places for children.
    order: Vec<u32>,
    /// Cost, rank and place of everyone, while sorting.
    keys: Vec<(f64, u32, u32)>,
}

impl Population {
    /// Room for `size` candidates and as many children.
    pub fn new(size: usize, genes: usize) -> Self {
        let places = 2 * size;
        Self {
            genes,
            size,
            values: vec![0.0; places * genes],
            cost: vec![f64::INFINITY; places],
            order: (0..places as u32).collect(),
            keys: Vec::with_capacity(places),
        }
    }

    /// Number of the living.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The living candidate of a rank, 0 being the best.
    #[inline]
    pub fn ranked(&self, rank: usize) -> &[f64] {
        let place = self.order[rank] as usize;
        &self.values[place * self.genes..][..self.genes]
    }

    /// Cost of the living candidate of a rank.
    pub fn cost(&self, rank: usize) -> f64 {
        self.cost[self.order[rank] as usize]
    }

    /// Child number `child`, to be written.
    #[inline]
    pub fn child(&mut self, child: usize) -> &mut [f64] {
        let place = self.order[self.size + child] as usize;
        &mut self.values[place * self.genes..][..self.genes]
    }

    /// The living candidate of a rank, and child number `child`, to be written.
    pub fn ranked_and_child(&mut self, rank: usize, child: usize) -> (&[f64], &mut [f64]) {
        let (old, new) = (self.order[rank] as usize, self.order[self.size + child] as usize);
        let genes = self.genes;
        if old < new {
            let (before, after) = self.values.split_at_mut(new * genes);
            (&before[old * genes..][..genes], &mut after[..genes])
        } else {
            let (before, after) = self.values.split_at_mut(old * genes);
            (&after[..genes], &mut before[new * genes..][..genes])
        }
    }

    /// Sets the cost of child number `child`.
    pub fn set_child_cost(&mut self, child: usize, cost: f64) {
        let place = self.order[self.size + child] as usize;
        self.cost[place] = cost;
    }

    /// Lets the best of the living and their children live; among equals the living come first.
    pub fn select(&mut self) {
        let cost = &self.cost;
        let ranks = self.order.iter().enumerate().map(|(rank, &place)| (cost[place as usize], rank as u32, place));
        self.keys.clear();
        self.keys.extend(ranks);
        // Ranks keep equals apart, so the order is one only, and an unstable sort needs no memory.
        self.keys.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for (place, key) in self.order.iter_mut().zip(&self.keys) {
            *place = key.2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_children(costs: [f64; 3], population: &mut Population) {
        for (child, cost) in costs.into_iter().enumerate() {
            population.child(child).fill(cost);
            population.set_child_cost(child, cost);
        }
        population.select();
    }

    #[test]
    fn the_best_live_and_elders_win_ties() {
        let mut population = Population::new(3, 2);
        with_children([3.0, 1.0, 2.0], &mut population);
        assert_eq!([0, 1, 2].map(|rank| population.ranked(rank)[0]), [1.0, 2.0, 3.0]);
        population.child(0).fill(-1.0);
        population.set_child_cost(0, 2.0);
        population.set_child_cost(1, 9.0);
        population.set_child_cost(2, 9.0);
        population.select();
        assert_eq!([0, 1, 2].map(|rank| population.ranked(rank)[0]), [1.0, 2.0, -1.0]);
        assert_eq!([0, 1, 2].map(|rank| population.cost(rank)), [1.0, 2.0, 2.0]);
    }

    #[test]
    fn elders_and_children_are_apart() {
        let mut population = Population::new(3, 2);
        with_children([3.0, 1.0, 2.0], &mut population);
        for rank in 0..3 {
            for child in 0..3 {
                let (old, new) = population.ranked_and_child(rank, child);
                new.fill(7.0);
                assert_eq!(old[0], 1.0 + rank as f64);
            }
        }
    }
}
