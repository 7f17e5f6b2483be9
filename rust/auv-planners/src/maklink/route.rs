//! Routes: which links to cross, one after the other. The shortest by way of the links' middles, as in the
//! MAKLINK graph (Dijkstra), and the next shortest (Yen).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use auv_world::math::Vec2;

use super::chart::Chart;
use super::error::MapError;

/// A way through the cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// The crossings, from start to goal.
    pub crossings: Vec<usize>,
    /// Length by way of the links' middles (m).
    pub length: f64,
}

impl Route {
    /// From start to goal by way of the links' middles (m).
    pub fn by_middles(&self, chart: &Chart, start: Vec2, goal: Vec2) -> Vec<Vec2> {
        let middles = self.crossings.iter().map(|crossing| chart.links()[crossing / 2].middle());
        std::iter::once(start).chain(middles).chain([goal]).collect()
    }
}

/// The question: from where to where on which chart.
pub struct Routes<'a> {
    chart: &'a Chart,
    start: Vec2,
    goal: Vec2,
    starts: Vec<usize>,
    goals: Vec<usize>,
}

/// A crossing to be looked at.
struct Open {
    length: f64,
    crossing: usize,
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Open {}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Open {
    // The heap gives the greatest: that of least length, and of lowest number among equals.
    fn cmp(&self, other: &Self) -> Ordering {
        other.length.total_cmp(&self.length).then(other.crossing.cmp(&self.crossing))
    }
}

impl<'a> Routes<'a> {
    /// The question.
    ///
    /// # Errors
    /// [`MapError`] if start or goal lies outside the area or in a zone.
    pub fn new(chart: &'a Chart, start: Vec2, goal: Vec2) -> Result<Self, MapError> {
        chart.check("start", start)?;
        chart.check("goal", goal)?;
        Ok(Self { chart, start, goal, starts: chart.cells_at(start), goals: chart.cells_at(goal) })
    }

    /// The shortest route; without crossings if start and goal share a cell.
    ///
    /// # Errors
    /// [`MapError::NoWay`] if there is none.
    pub fn shortest(&self) -> Result<Route, MapError> {
        self.search(&[], &[], &[]).ok_or_else(|| MapError::NoWay { polygons: self.chart.barriers(self.start) })
    }

    /// The shortest routes, at most so many, that enter no cell twice, shortest first.
    ///
    /// # Errors
    /// [`MapError::NoWay`] if there is none.
    pub fn shortest_few(&self, count: usize) -> Result<Vec<Route>, MapError> {
        let mut found = vec![self.shortest()?];
        let mut others: Vec<Route> = Vec::new();
        while found.len() < count {
            let last = &found[found.len() - 1].crossings;
            for place in 0..last.len() {
                let root = &last[..place];
                // The next step of every route so far that begins in the same way.
                let tried = found.iter().map(|route| &route.crossings);
                let closed: Vec<usize> =
                    tried.filter(|way| way.starts_with(root)).filter_map(|way| way.get(place).copied()).collect();
                let entered = root.iter().map(|&crossing| self.chart.enters(crossing));
                let entered: Vec<usize> = entered.chain(self.starts.iter().copied()).collect();
                let next = self.search(root, &closed, &entered);
                others.extend(next.filter(|route| !others.contains(route) && !found.contains(route)));
            }
            let best = (0..others.len()).min_by(|&a, &b| {
                others[a].length.total_cmp(&others[b].length).then(others[a].crossings.cmp(&others[b].crossings))
            });
            match best {
                Some(best) => found.push(others.swap_remove(best)),
                None => break,
            }
        }
        Ok(found)
    }

    /// The shortest route that begins with `root`, goes on with none of `closed`, and enters none of the cells
    /// `entered` again.
    fn search(&self, root: &[usize], closed: &[usize], entered: &[usize]) -> Option<Route> {
        let chart = self.chart;
        let middle = |crossing: usize| chart.links()[crossing / 2].middle();
        let (mut from, mut begun) = (self.start, 0.0);
        for &crossing in root {
            begun += distance(from, middle(crossing));
            from = middle(crossing);
        }
        let here = root.last().map(|&last| vec![chart.enters(last)]);
        let first = here.as_ref().unwrap_or(&self.starts);
        let ends = |cell: usize| self.goals.contains(&cell);
        if closed.is_empty() && first.iter().any(|&cell| ends(cell)) {
            return Some(Route { crossings: root.to_vec(), length: begun + distance(from, self.goal) });
        }
        let mut length = vec![f64::INFINITY; 2 * chart.links().len()];
        let mut before = vec![usize::MAX; length.len()];
        let mut heap = BinaryHeap::new();
        // A route does not come back to where it began, nor to the cells of its root.
        let barred = |crossing: usize| {
            let cell = chart.enters(crossing);
            first.contains(&cell) || entered.contains(&cell)
        };
        for &side in first.iter().flat_map(|&cell| &chart.cells()[cell].sides) {
            let so_far = begun + distance(from, middle(side));
            if Some(side ^ 1) != root.last().copied() && !closed.contains(&side) && !barred(side) {
                length[side] = so_far;
                heap.push(Open { length: so_far, crossing: side });
            }
        }
        let mut best: Option<(f64, usize)> = None;
        while let Some(Open { length: so_far, crossing }) = heap.pop() {
            if best.is_some_and(|best| best.0 <= so_far) {
                break;
            }
            if so_far > length[crossing] {
                continue;
            }
            let (cell, here) = (chart.enters(crossing), middle(crossing));
            if ends(cell) {
                let whole = so_far + distance(here, self.goal);
                if best.is_none_or(|best| whole < best.0) {
                    best = Some((whole, crossing));
                }
                continue;
            }
            for &side in &chart.cells()[cell].sides {
                let onward = so_far + distance(here, middle(side));
                if side ^ 1 != crossing && onward < length[side] && !barred(side) {
                    (length[side], before[side]) = (onward, crossing);
                    heap.push(Open { length: onward, crossing: side });
                }
            }
        }
        let (whole, mut crossing) = best?;
        let mut tail = Vec::new();
        while crossing != usize::MAX {
            tail.push(crossing);
            crossing = before[crossing];
        }
        let crossings = root.iter().copied().chain(tail.into_iter().rev()).collect();
        Some(Route { crossings, length: whole })
    }
}

/// Distance of two points (m).
#[inline]
pub fn distance(a: Vec2, b: Vec2) -> f64 {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    (dx * dx + dy * dy).sqrt()
}

/// Length of a path (m).
pub fn length(path: &[Vec2]) -> f64 {
    path.windows(2).map(|leg| distance(leg[0], leg[1])).sum()
}
