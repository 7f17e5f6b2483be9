//! The shortest path of all: over corners of zones that see each other, by A*.

use auv_world::math::Vec2;

use super::chart::Chart;
use super::error::MapError;
use super::route::distance;

/// The shortest path from start to goal that enters no zone; `None` if interrupted.
///
/// # Errors
/// [`MapError`] if start or goal lies outside the area or in a zone, or there is no way.
pub fn shortest(
    chart: &Chart,
    start: Vec2,
    goal: Vec2,
    interrupted: &mut dyn FnMut() -> bool,
) -> Result<Option<Vec<Vec2>>, MapError> {
    chart.check("start", start)?;
    chart.check("goal", goal)?;
    let corners = chart.zones().iter().flat_map(|zone| zone.corners().iter().copied());
    let points: Vec<Vec2> = [start, goal].into_iter().chain(corners).collect();
    let mut length = vec![f64::INFINITY; points.len()];
    let mut before = vec![usize::MAX; points.len()];
    let mut settled = vec![false; points.len()];
    length[0] = 0.0;
    loop {
        let promise = |i: usize| length[i] + distance(points[i], goal);
        let open = (0..points.len()).filter(|&i| !settled[i] && length[i].is_finite());
        let Some(here) = open.min_by(|&a, &b| promise(a).total_cmp(&promise(b))) else {
            return Err(MapError::NoWay { polygons: chart.barriers(start) });
        };
        if here == 1 {
            break;
        }
        if interrupted() {
            return Ok(None);
        }
        settled[here] = true;
        for there in 1..points.len() {
            let onward = length[here] + distance(points[here], points[there]);
            if !settled[there] && onward < length[there] && chart.is_free(points[here], points[there]) {
                (length[there], before[there]) = (onward, here);
            }
        }
    }
    let mut path = Vec::new();
    let mut at = 1;
    while at != usize::MAX {
        path.push(points[at]);
        at = before[at];
    }
    path.reverse();
    path.dedup();
    Ok(Some(path))
}
