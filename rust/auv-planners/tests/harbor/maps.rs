//! The reference maps: a 200 x 200 m area with closed walls, safety distance 1.875 m.

use auv_planners::maklink::{Area, Chart};

/// From where to where (m).
pub const START: [f64; 2] = [20.0, 180.0];
pub const GOAL: [f64; 2] = [160.0, 90.0];
/// Safety distance (m).
pub const DISTANCE: f64 = 1.875;

/// A map and what is known of it.
pub struct Map {
    pub name: &'static str,
    pub polygons: &'static [&'static [[f64; 2]]],
    pub zones: usize,
    pub links: usize,
    pub cells: usize,
    pub route_links: usize,
    pub dijkstra_m: f64,
    pub optimum_m: f64,
}

impl Map {
    pub fn polygons(&self) -> Vec<Vec<[f64; 2]>> {
        self.polygons.iter().map(|ring| ring.to_vec()).collect()
    }

    pub fn chart(&self) -> Chart {
        chart(&self.polygons())
    }
}

pub fn area() -> Area {
    Area::new([0.0, 0.0], [200.0, 200.0]).unwrap()
}

pub fn chart(polygons: &[Vec<[f64; 2]>]) -> Chart {
    Chart::new(area(), polygons, DISTANCE, f64::INFINITY).unwrap()
}

pub const MAPS: [Map; 4] = [
    Map {
        name: "P",
        polygons: &[
            &[[175.0, 80.0], [192.0, 72.0], [191.0, 85.0], [180.0, 86.0], [173.0, 102.0], [163.0, 99.0]],
            &[[36.0, 140.0], [51.0, 144.0], [40.0, 149.0], [45.0, 155.0], [26.0, 158.0], [20.0, 149.0]],
            &[[157.0, 109.0], [146.0, 112.0], [136.0, 59.0], [147.0, 56.0]],
            &[[193.0, 187.0], [175.0, 188.0], [195.0, 159.0]],
            &[[156.0, 42.0], [158.0, 12.0], [189.0, 24.0], [187.0, 55.0]],
        ],
        zones: 5,
        links: 23,
        cells: 19,
        route_links: 8,
        dijkstra_m: 252.262,
        optimum_m: 175.989,
    },
    Map {
        name: "A",
        polygons: &[
            &[[25.0, 78.0], [47.0, 79.0], [43.0, 110.0]],
            &[[183.0, 32.0], [188.0, 50.0], [176.0, 45.0], [164.0, 25.0], [168.0, 17.0]],
            &[[127.0, 115.0], [123.0, 94.0], [148.0, 88.0], [167.0, 105.0], [154.0, 121.0]],
            &[[50.0, 121.0], [39.0, 132.0], [27.0, 136.0], [30.0, 127.0], [44.0, 117.0]],
            &[[49.0, 144.0], [58.0, 157.0], [25.0, 184.0]],
        ],
        zones: 4,
        links: 21,
        cells: 18,
        route_links: 8,
        dijkstra_m: 252.259,
        optimum_m: 176.010,
    },
    Map {
        name: "B",
        polygons: &[
            &[[105.0, 58.0], [87.0, 44.0], [119.0, 22.0], [138.0, 36.0]],
            &[[72.0, 83.0], [85.0, 95.0], [81.0, 119.0], [64.0, 123.0], [59.0, 101.0]],
            &[[29.0, 156.0], [52.0, 136.0], [91.0, 152.0], [92.0, 181.0], [54.0, 183.0]],
            &[[106.0, 74.0], [120.0, 64.0], [133.0, 72.0], [126.0, 87.0], [109.0, 88.0]],
            &[[78.0, 52.0], [10.0, 66.0], [64.0, 32.0]],
            &[[174.0, 163.0], [165.0, 156.0], [156.0, 96.0], [165.0, 104.0]],
        ],
        zones: 6,
        links: 26,
        cells: 21,
        route_links: 8,
        dijkstra_m: 252.237,
        optimum_m: 175.570,
    },
    Map {
        name: "book",
        polygons: &[
            &[[40.0, 140.0], [60.0, 160.0], [100.0, 140.0], [60.0, 120.0]],
            &[[50.0, 30.0], [30.0, 40.0], [80.0, 80.0], [100.0, 40.0]],
            &[[120.0, 160.0], [140.0, 100.0], [180.0, 170.0], [165.0, 180.0]],
            &[[120.0, 40.0], [170.0, 40.0], [140.0, 80.0]],
        ],
        zones: 4,
        links: 15,
        cells: 12,
        route_links: 4,
        dijkstra_m: 187.703,
        optimum_m: 171.285,
    },
];
