//! A population with room for as many children.

/// Members, their children, their costs, and who is who.
#[derive(Debug, Clone)]
pub struct Population {
    genes: usize,
    size: usize,
    /// Twice `size` candidates, one after the other.
    values: Vec<f64>,
    cost: Vec<f64>,
    /// Places of the candidates: first the members, then the children.
    order: Vec<u32>,
    /// Cost, number and place, while selecting.
    keys: Vec<(f64, u32, u32)>,
    /// Places, while selecting.
    scratch: Vec<u32>,
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
            scratch: Vec::with_capacity(places),
        }
    }

    /// Number of members.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Number of genes.
    pub fn genes(&self) -> usize {
        self.genes
    }

    /// The candidate at a place.
    #[inline]
    pub fn at(&self, place: u32) -> &[f64] {
        &self.values[place as usize * self.genes..][..self.genes]
    }

    /// The places of all members; what lies at the place of one who died stays until children are bred.
    #[inline]
    pub fn places(&self) -> &[u32] {
        &self.order[..self.size]
    }

    /// A member: after [`Population::select`] the better, the lower its number.
    #[inline]
    pub fn member(&self, number: usize) -> &[f64] {
        self.at(self.order[number])
    }

    /// Cost of a member.
    #[inline]
    pub fn cost(&self, number: usize) -> f64 {
        self.cost[self.order[number] as usize]
    }

    /// The number of the best member, the lowest among equals.
    pub fn best(&self) -> usize {
        (1..self.size).fold(0, |best, number| if self.cost(number) < self.cost(best) { number } else { best })
    }

    /// A child, to be written.
    #[inline]
    pub fn child(&mut self, number: usize) -> &mut [f64] {
        let place = self.order[self.size + number] as usize;
        &mut self.values[place * self.genes..][..self.genes]
    }

    /// Members, and a child to be written.
    #[inline]
    pub fn members_and_child<const N: usize>(
        &mut self,
        members: [usize; N],
        child: usize,
    ) -> ([&[f64]; N], &mut [f64]) {
        let genes = self.genes;
        let place = self.order[self.size + child] as usize;
        let (before, rest) = self.values.split_at_mut(place * genes);
        let (new, after) = rest.split_at_mut(genes);
        let (before, after): (&[f64], &[f64]) = (before, after);
        let members = members.map(|number| {
            let member = self.order[number] as usize;
            if member < place {
                &before[member * genes..][..genes]
            } else {
                &after[(member - place - 1) * genes..][..genes]
            }
        });
        (members, new)
    }

    /// Sets the cost of a child.
    pub fn set_child_cost(&mut self, number: usize, cost: f64) {
        let place = self.order[self.size + number] as usize;
        self.cost[place] = cost;
    }

    /// Lets the best of members and children live, in order of cost; among equals members come first, then
    /// lower numbers. Members are in order already.
    pub fn select(&mut self) {
        let (size, cost) = (self.size, &self.cost);
        let worst = cost[self.order[size - 1] as usize];
        self.keys.clear();
        let children = self.order[size..].iter().enumerate();
        self.keys.extend(
            children.map(|(number, &place)| (cost[place as usize], number as u32, place)).filter(|key| key.0 < worst),
        );
        // Numbers keep equals apart, so the order is one only, and an unstable sort needs no memory.
        self.keys.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let newcomers = &self.keys[..self.keys.len().min(size)];
        self.scratch.clear();
        let (mut old, mut new) = (0, 0);
        while self.scratch.len() < size {
            let place = self.order[old];
            if new < newcomers.len() && newcomers[new].0 < cost[place as usize] {
                self.scratch.push(newcomers[new].2);
                new += 1;
            } else {
                self.scratch.push(place);
                old += 1;
            }
        }
        // The dead take the places of the children that live.
        for (&(_, number, _), dead) in newcomers[..new].iter().zip(old..) {
            self.order[size + number as usize] = self.order[dead];
        }
        self.order[..size].copy_from_slice(&self.scratch);
    }

    /// Lets each child take its member's place unless that is better.
    pub fn duel(&mut self) {
        for number in 0..self.size {
            let (member, child) = (self.order[number], self.order[self.size + number]);
            if self.cost[child as usize] <= self.cost[member as usize] {
                self.order.swap(number, self.size + number);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use auv_world::rng::{Purpose, Stream};

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
        assert_eq!([0, 1, 2].map(|rank| population.member(rank)[0]), [1.0, 2.0, 3.0]);
        population.child(0).fill(-1.0);
        population.set_child_cost(0, 2.0);
        population.set_child_cost(1, 9.0);
        population.set_child_cost(2, 9.0);
        population.select();
        assert_eq!([0, 1, 2].map(|rank| population.member(rank)[0]), [1.0, 2.0, -1.0]);
        assert_eq!([0, 1, 2].map(|rank| population.cost(rank)), [1.0, 2.0, 2.0]);
    }

    #[test]
    fn selection_is_a_sort_of_all() {
        let mut population = Population::new(7, 1);
        let mut stream = Stream::new(5, Purpose::Planner, 0);
        let mut living: Vec<f64> = vec![f64::INFINITY; 7];
        for _ in 0..200 {
            for child in 0..7 {
                let cost = (20.0 * stream.unit()).floor();
                population.child(child).fill(cost);
                population.set_child_cost(child, cost);
                living.push(cost);
            }
            population.select();
            living.sort_by(f64::total_cmp);
            living.truncate(7);
            assert_eq!((0..7).map(|number| population.cost(number)).collect::<Vec<_>>(), living);
            assert_eq!((0..7).map(|number| population.member(number)[0]).collect::<Vec<_>>(), living);
            let mut places = population.order.clone();
            places.sort_unstable();
            assert_eq!(places, (0..14).collect::<Vec<u32>>());
        }
    }

    #[test]
    fn a_child_wins_its_duel_unless_it_is_worse() {
        let mut population = Population::new(3, 1);
        for costs in [[3.0, 1.0, 2.0], [3.0, 2.0, 1.0]] {
            for (child, cost) in costs.into_iter().enumerate() {
                let value = 10.0 * cost + population.cost(child).min(5.0);
                population.child(child).fill(value);
                population.set_child_cost(child, cost);
            }
            population.duel();
        }
        assert_eq!([0, 1, 2].map(|number| population.cost(number)), [3.0, 1.0, 1.0]);
        assert_eq!([0, 1, 2].map(|number| population.member(number)[0]), [33.0, 15.0, 12.0]);
        assert_eq!(population.best(), 1);
    }

    #[test]
    fn members_and_children_are_apart() {
        let mut population = Population::new(3, 2);
        with_children([3.0, 1.0, 2.0], &mut population);
        for member in 0..3 {
            for child in 0..3 {
                let ([old, best], new) = population.members_and_child([member, 0], child);
                new.fill(7.0);
                assert_eq!((old[0], best[0]), (1.0 + member as f64, 1.0));
            }
        }
    }
}
