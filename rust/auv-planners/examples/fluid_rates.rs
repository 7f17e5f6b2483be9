//! How often the flow arrives, and how often it meets a surface: 400 dense fields of superquadrics.
//!
//! `cargo run --release -p auv-planners --example fluid_rates [fields]`

#[path = "rates/fields.rs"]
mod fields;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let count: u64 = std::env::args().nth(1).map_or(Ok(400), |text| text.parse())?;
    let worlds = fields::fields(count)?;
    println!("{count} fields of 12 superquadrics, rho and sigma 1 .. 3, theta 0 .. pi");
    println!("step  set                  met a surface  arrived  arrived clear  lines");
    for seconds in [6.0, 30.0] {
        for (name, flow, retry) in [
            ("literal", r#""options": "literal""#, false),
            ("recommended, no guard", r#""guard": false"#, false),
            ("the same, union 6", r#""guard": false, "union_exponent": 6"#, false),
            ("recommended", "", false),
            ("with other tries", "", true),
        ] {
            let (mut met, mut arrived, mut clear, mut lines) = (0, 0, 0, 0);
            for world in &worlds {
                let line = fields::line(world, seconds, flow, retry)?;
                met += usize::from(line.met);
                arrived += usize::from(line.arrived);
                clear += usize::from(line.arrived && !line.met);
                lines += line.lines;
            }
            println!("{seconds:>4}  {name:<21}  {met:>11}  {arrived:>7}  {clear:>13}  {lines:>5}");
        }
    }
    Ok(())
}
