//! The shortest path through a corridor of links: the taut string, by the funnel of Lee and Preparata (1984).

use auv_world::math::Vec2;

use super::chart::Chart;
use super::links::turn;
use super::route::Route;

/// The shortest path from start to goal that crosses the links of a route in their order, without points
/// that come twice.
pub fn taut(chart: &Chart, route: &Route, start: Vec2, goal: Vec2) -> Vec<Vec2> {
    let hands: Vec<[Vec2; 2]> =
        route.crossings.iter().map(|&crossing| chart.hands(crossing)).chain([[goal; 2]]).collect();
    let mut path = vec![start];
    let mut apex = start;
    // The two sides of the funnel, and the links at which they touch.
    let ([mut left, mut right], [mut left_at, mut right_at]) = ([start; 2], [0; 2]);
    let mut at = 0;
    while at < hands.len() {
        let [new_left, new_right] = hands[at];
        if turn(apex, right, new_right) >= 0.0 {
            if apex == right || turn(apex, left, new_right) < 0.0 {
                (right, right_at) = (new_right, at);
            } else {
                // The right side has come over the left one: the string bends there.
                path.push(left);
                (apex, right) = (left, left);
                (at, right_at) = (left_at + 1, left_at);
                continue;
            }
        }
        if turn(apex, left, new_left) <= 0.0 {
            if apex == left || turn(apex, right, new_left) > 0.0 {
                (left, left_at) = (new_left, at);
            } else {
                path.push(right);
                (apex, left) = (right, right);
                (at, left_at) = (right_at + 1, right_at);
                continue;
            }
        }
        at += 1;
    }
    path.push(goal);
    path.dedup();
    path
}
