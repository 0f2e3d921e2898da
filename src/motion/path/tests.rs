//! Tests of the path alone. Lengths are in nanometres, as everywhere.

#![expect(clippy::float_cmp, reason = "a block ends exactly on its end")]

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;

use super::*;

const CYCLE: f64 = 0.002;
/// 10 m/min and 1 m/s² for every axis.
const VELOCITY: f64 = 10e9 / 60.0;
const ACCELERATION: f64 = 1e9;
const OVERLOAD: f64 = 1.2;
const ALL: [bool; PATH_AXES] = [true; PATH_AXES];
const FULL: Overrides = Overrides { feed: 1.0, rapid: 1.0 };
const HELD: Overrides = Overrides { feed: 0.0, rapid: 0.0 };

fn limits() -> PathLimits {
    PathLimits {
        velocity: [VELOCITY; PATH_AXES],
        acceleration: [ACCELERATION; PATH_AXES],
        overload: [OVERLOAD; PATH_AXES],
    }
}

/// A point of the first three axes, in millimetres.
fn point(x: f64, y: f64, z: f64) -> PerPathAxis {
    let mut point = PerPathAxis::default();
    (point[0], point[1], point[2]) = (x * 1e6, y * 1e6, z * 1e6);
    point
}

fn line(from: PerPathAxis, to: PerPathAxis) -> Way {
    Way::line(from, to, ALL)
}

fn block(way: Way, feed_mm_per_min: f64) -> PathBlock {
    PathBlock { number: 0, way, feed: Feed::Programmed(feed_mm_per_min * 1e6 / 60.0), exact_stop: false }
}

fn path(blocks: &[PathBlock]) -> Path {
    let mut path = Path::new(blocks[0].way.at(0.0), limits());
    for block in blocks {
        path.append(*block, CYCLE).unwrap();
    }
    path
}

/// The positions of every cycle until the path is empty; exact stops go on at once.
fn run(path: &mut Path) -> Vec<PerPathAxis> {
    let mut positions = vec![path.position];
    while !path.is_empty() {
        positions.push(path.step(FULL, CYCLE).position);
        if path.stands() {
            path.go_on();
        }
        assert!(positions.len() < 1_000_000, "the path does not end");
    }
    positions
}

fn velocities(positions: &[PerPathAxis]) -> Vec<PerPathAxis> {
    let of = |pair: &[PerPathAxis]| std::array::from_fn(|axis| (pair[1][axis] - pair[0][axis]) / CYCLE);
    positions.windows(2).map(of).collect()
}

#[test]
fn a_line_ends_exactly_on_its_end_with_one_velocity_along_the_way() {
    // 300 mm along X, 400 mm along Y: the way is 500 mm, 6 m/min are 100 mm/s along it, so 60 and 80 mm/s of the axes.
    let end = point(300.0, 400.0, 0.0);
    let positions = run(&mut path(&[block(line(point(0.0, 0.0, 0.0), end), 6_000.0)]));
    assert_eq!(*positions.last().unwrap(), end);
    let fastest = |axis: usize| velocities(&positions).iter().map(|velocity| velocity[axis]).fold(0.0, f64::max);
    assert!((fastest(0) - 60e6).abs() < 10.0 && (fastest(1) - 80e6).abs() < 10.0);
    // 100 mm/s at 1.25 m/s² along the way (the limit of Y: 1 / 0.8) are 80 ms of ramp each; 5 s + 80 ms in all.
    let seconds = (positions.len() - 1) as f64 * CYCLE;
    assert!((seconds - 5.08).abs() <= 2.0 * CYCLE, "{seconds}");
}

#[test]
fn rapid_traverse_is_as_fast_as_the_slowest_axis_permits() {
    let way = line(point(0.0, 0.0, 0.0), point(1_000.0, 500.0, 0.0));
    let rapid = PathBlock { number: 1, way, feed: Feed::Rapid, exact_stop: true };
    let positions = run(&mut path(&[rapid]));
    let fastest = velocities(&positions).iter().map(|velocity| velocity[0]).fold(0.0, f64::max);
    assert!((fastest - VELOCITY).abs() < 10.0, "{fastest}");
}

#[test]
fn many_short_lines_take_as_long_as_one() {
    let one = run(&mut path(&[block(line(point(0.0, 0.0, 0.0), point(50.0, 0.0, 0.0)), 6_000.0)])).len();
    // 0.1 mm in a cycle of 2 ms are 3 m/min: at 6 m/min every cycle passes two lines.
    let short: Vec<_> = (0..500)
        .map(|index| {
            let x = |index: i32| point(f64::from(index) * 0.1, 0.0, 0.0);
            block(line(x(index), x(index + 1)), 6_000.0)
        })
        .collect();
    let mut path = Path::new(point(0.0, 0.0, 0.0), limits());
    let (mut next, mut cycles, mut ended) = (0, 1_usize, 0);
    while ended < short.len() {
        while next < short.len() && path.append(short[next], CYCLE).is_ok() {
            next += 1;
        }
        ended += path.step(FULL, CYCLE).ended;
        cycles += 1;
    }
    assert!(cycles.abs_diff(one) <= 1, "{cycles} and {one} cycles");
}

#[test]
fn at_a_corner_no_axis_changes_its_velocity_by_more_than_the_overload_permits() {
    let (a, b, c) = (point(0.0, 0.0, 0.0), point(20.0, 0.0, 0.0), point(20.0, 20.0, 0.0));
    let positions = run(&mut path(&[block(line(a, b), 6_000.0), block(line(b, c), 6_000.0)]));
    // 1 m/s² in 2 ms, times 1.2: 2.4 mm/s along X before the corner, and along Y after it.
    let permitted = ACCELERATION * CYCLE * OVERLOAD;
    let velocities = velocities(&positions);
    for pair in velocities.windows(2) {
        for (before, after) in pair[0].iter().zip(&pair[1]) {
            // The ramp before or after the corner may fall into the same cycle.
            let change = (after - before).abs();
            assert!(change <= permitted + ACCELERATION * CYCLE + 1.0, "{change}");
        }
    }
    let slowest = velocities.iter().skip(5).map(|v| (v[0] * v[0] + v[1] * v[1]).sqrt()).fold(f64::INFINITY, f64::min);
    assert!(slowest > 0.5 * permitted, "it does not stand at the corner: {slowest}");
}

#[test]
fn a_reversal_stops_nearly_and_comes_back() {
    let (a, b) = (point(0.0, 0.0, 0.0), point(20.0, 0.0, 0.0));
    let positions = run(&mut path(&[block(line(a, b), 6_000.0), block(line(b, a), 6_000.0)]));
    assert_eq!(*positions.last().unwrap(), a);
    let farthest = positions.iter().map(|position| position[0]).fold(0.0, f64::max);
    // At most half of 2.4 mm/s in each direction: 2.4 um in a cycle.
    assert!(farthest <= b[0] && farthest > b[0] - 3e3, "{farthest}");
}

#[test]
fn an_exact_stop_waits_for_the_control() {
    let (a, b, c) = (point(0.0, 0.0, 0.0), point(5.0, 0.0, 0.0), point(9.0, 0.0, 0.0));
    let stop = PathBlock { exact_stop: true, ..block(line(a, b), 1_000.0) };
    let mut path = path(&[stop, block(line(b, c), 1_000.0)]);
    while !path.stands() {
        path.step(FULL, CYCLE);
    }
    for _ in 0..100 {
        assert_eq!(path.step(FULL, CYCLE), Moved { position: b, ended: 0 });
    }
    path.go_on();
    assert_eq!(*run(&mut path).last().unwrap(), c);
}

#[test]
fn a_full_circle_keeps_its_radius_and_comes_back_to_its_start() {
    // Radius 10 mm around (10, 0), counterclockwise from the origin.
    let start = point(0.0, 0.0, 0.0);
    let circle = Circle { plane: [0, 1], centre: [10e6, 0.0], turn: Turn::Counterclockwise, turns: 0 };
    let way = Way::arc(start, start, circle, 1_000.0, ALL).unwrap();
    assert!((way.length() - TAU * 10e6).abs() < 1.0, "{}", way.length());
    let positions = run(&mut path(&[block(way, 3_000.0)]));
    assert_eq!(*positions.last().unwrap(), start);
    for position in &positions {
        let radius = ((position[0] - 10e6).powi(2) + position[1].powi(2)).sqrt();
        assert!((radius - 10e6).abs() < 0.01, "{radius}");
    }
    // Counterclockwise from the left of the centre: down first.
    assert!(positions[20][1] < 0.0);
}

#[test]
fn a_small_circle_is_slower_because_of_the_acceleration_towards_its_centre() {
    // 0.7071 m/s² towards the centre on a radius of 1 mm: 26.6 mm/s, whatever the feed.
    let start = point(1.0, 0.0, 0.0);
    let circle = Circle { plane: [0, 1], centre: [0.0, 0.0], turn: Turn::Clockwise, turns: 20 };
    let way = Way::arc(start, start, circle, 1.0, ALL).unwrap();
    let mut path = path(&[block(way, 10_000.0)]);
    let mut fastest = 0.0_f64;
    while !path.is_empty() {
        path.step(FULL, CYCLE);
        fastest = fastest.max(path.velocity());
    }
    let expected = (ACCELERATION * 0.5_f64.sqrt() * 1e6).sqrt();
    assert!((expected - 26.59e6).abs() < 0.01e6);
    assert!((fastest - expected).abs() < 1.0, "{fastest}");
}

#[test]
fn a_helix_turns_as_often_as_programmed_and_moves_the_third_axis_along() {
    let (start, end) = (point(10.0, 0.0, 0.0), point(0.0, 10.0, -6.0));
    let circle = Circle { plane: [0, 1], centre: [0.0, 0.0], turn: Turn::Counterclockwise, turns: 2 };
    let way = Way::arc(start, end, circle, 1.0, ALL).unwrap();
    // Two turns and a quarter: 4.5 π · 10 mm in the plane, 6 mm along Z.
    let expected = ((4.5 * PI * 10e6).powi(2) + 6e6_f64.powi(2)).sqrt();
    assert!((way.length() - expected).abs() < 1.0, "{}", way.length());
    let half = way.at(way.length() / 2.0);
    assert!((half[2] + 3e6).abs() < 1.0);
    assert_eq!(*run(&mut path(&[block(way, 3_000.0)])).last().unwrap(), end);
}

#[test]
fn an_arc_whose_radii_differ_is_refused() {
    let circle = Circle { plane: [0, 1], centre: [0.0, 0.0], turn: Turn::Clockwise, turns: 0 };
    let refused = Way::arc(point(10.0, 0.0, 0.0), point(0.0, 10.1, 0.0), circle, 10_000.0, ALL).unwrap_err();
    assert_eq!((refused.start, refused.end.round()), (10e6, 10.1e6));
    assert!(Way::arc(point(10.0, 0.0, 0.0), point(0.0, 10.005, 0.0), circle, 10_000.0, ALL).is_ok());
}

#[test]
fn an_override_of_zero_brakes_and_holds_and_the_path_goes_on_afterwards() {
    let end = point(100.0, 0.0, 0.0);
    let mut path = path(&[block(line(point(0.0, 0.0, 0.0), end), 6_000.0)]);
    for _ in 0..100 {
        path.step(FULL, CYCLE);
    }
    assert!((path.velocity() - 100e6).abs() < 1.0);
    // 100 mm/s at 1 m/s²: 50 cycles.
    for _ in 0..50 {
        path.step(HELD, CYCLE);
    }
    assert!(path.velocity().abs() < 1.0, "{}", path.velocity());
    let held = path.step(HELD, CYCLE).position;
    assert_eq!(path.step(HELD, CYCLE).position, held);
    assert_eq!(*run(&mut path).last().unwrap(), end);
}

#[test]
fn a_full_path_and_a_block_without_a_way_are_refused() {
    let (a, b) = (point(0.0, 0.0, 0.0), point(1.0, 0.0, 0.0));
    let mut path = path(&[block(line(a, b), 100.0); BLOCKS]);
    assert_eq!(path.append(block(line(a, b), 100.0), CYCLE), Err(Refused::Full));
    path.clear();
    assert_eq!(path.append(block(line(a, a), 100.0), CYCLE), Err(Refused::NoWay));
}

/// The corners of a random path, in millimetres, with the bend of each block: 0 is a line.
fn blocks() -> impl Strategy<Value = Vec<PathBlock>> {
    let one = (-20.0..20.0_f64, -20.0..20.0_f64, -5.0..5.0_f64, 0..3_u8, 50.0..20_000.0_f64, any::<bool>());
    proptest::collection::vec(one, 1..30).prop_map(|points| {
        let mut at = point(0.0, 0.0, 0.0);
        let mut blocks = Vec::new();
        for (number, (x, y, z, shape, feed, exact_stop)) in points.into_iter().enumerate() {
            let to = point(x, y, z);
            let middle = [0.5 * (at[0] + to[0]), 0.5 * (at[1] + to[1])];
            let turn = if shape == 1 { Turn::Clockwise } else { Turn::Counterclockwise };
            let circle = Circle { plane: [0, 1], centre: middle, turn, turns: 0 };
            let way = if shape == 0 { line(at, to) } else { Way::arc(at, to, circle, 10.0, ALL).unwrap() };
            let feed = if feed > 15_000.0 { Feed::Rapid } else { Feed::Programmed(feed * 1e6 / 60.0) };
            blocks.push(PathBlock { number: number as u64, way, feed, exact_stop });
            at = to;
        }
        blocks.retain(|block| block.way.length() > 1.0);
        blocks
    })
}

proptest! {
    #[test]
    fn no_axis_exceeds_its_limits_and_every_path_ends_on_its_end(
        blocks in blocks(),
        overrides in proptest::collection::vec(0.0..1.5_f64, 1..20),
    ) {
        prop_assume!(!blocks.is_empty());
        let mut path = Path::new(blocks[0].way.at(0.0), limits());
        let (mut next, mut cycle, mut before, mut velocity) = (0, 0_usize, path.position, PerPathAxis::default());
        let mut numbers = Vec::new();
        while next < blocks.len() || !path.is_empty() {
            while next < blocks.len() && path.append(blocks[next], CYCLE).is_ok() {
                next += 1;
            }
            if let Some((block, rest)) = path.current() {
                prop_assert!(rest > -1.0);
                if numbers.last() != Some(&block.number) {
                    numbers.push(block.number);
                }
            }
            // An override that stays at 0 for ever would hold for ever.
            let factor = if cycle < 4_000 { overrides[cycle / 200 % overrides.len()] } else { 1.0 };
            let moved = path.step(Overrides { feed: factor, rapid: factor }, CYCLE);
            for axis in 0..3 {
                let now = (moved.position[axis] - before[axis]) / CYCLE;
                prop_assert!(now.abs() <= VELOCITY * 1.001, "axis {axis} moves with {now} in cycle {cycle}");
                let change = (now - velocity[axis]).abs() / (ACCELERATION * CYCLE);
                // A corner and a ramp may fall into one cycle, and a ramp ends on a whole cycle.
                prop_assert!(change <= OVERLOAD + 1.5, "axis {axis} changes by {change} accelerations in cycle {cycle}");
                velocity[axis] = now;
            }
            before = moved.position;
            if path.stands() {
                path.go_on();
            }
            cycle += 1;
            prop_assert!(cycle < 200_000, "the path does not end");
        }
        prop_assert_eq!(before, blocks.last().unwrap().way.end());
    }
}

/// SOFT: 100 mm at 100 mm/s and 1 m/s². A window of 50 cycles takes 49 cycles longer, keeps the acceleration, and makes ramps of it: the jerk is the
/// acceleration over 50 cycles.
#[test]
fn a_jerk_window_spreads_each_change_of_the_acceleration() {
    const CYCLE: f64 = 0.002;
    let limits = PathLimits { velocity: [1e9; PATH_AXES], acceleration: [1e9; PATH_AXES], overload: [1.0; PATH_AXES] };
    let run = |window: usize| {
        let mut path = Path::new([0.0; PATH_AXES], limits);
        path.set_jerk_window(window);
        let mut counted = [false; PATH_AXES];
        counted[0] = true;
        let mut start = [0.0; PATH_AXES];
        for (number, x) in [40e6, 100e6].into_iter().enumerate() {
            let mut end = [0.0; PATH_AXES];
            end[0] = x;
            let way = Way::line(start, end, counted);
            let feed = Feed::Programmed(100e6);
            path.append(PathBlock { number: number as u64, way, feed, exact_stop: number == 1 }, CYCLE).unwrap();
            start = end;
        }
        let (mut cycles, mut ended) = (0, 0);
        let (mut before, mut velocity, mut acceleration) = (0.0, 0.0, 0.0);
        let (mut most, mut jerk) = (0.0_f64, 0.0_f64);
        while !path.stands() {
            let moved = path.step(Overrides { feed: 1.0, rapid: 1.0 }, CYCLE);
            ended += moved.ended;
            cycles += 1;
            let now = (moved.position[0] - before) / CYCLE;
            let rate = (now - velocity) / CYCLE;
            (most, jerk) = (most.max(rate.abs()), jerk.max((rate - acceleration).abs() / CYCLE));
            (before, velocity, acceleration) = (moved.position[0], now, rate);
            assert!(cycles < 10_000);
        }
        path.go_on();
        assert!(path.is_empty() && ended == 1 && path.velocity() <= 0.0);
        assert_eq!(path.position()[0], 100e6);
        (cycles, most, jerk)
    };
    let (plain, acceleration, _) = run(1);
    let (soft, gentle, jerk) = run(50);
    assert_eq!(soft, plain + 49);
    // The last step of the plan ends between two cycles: its part of a cycle is smaller.
    assert!(gentle <= acceleration * 1.001, "{gentle} {acceleration}");
    assert!(jerk <= 1e9 / (50.0 * CYCLE) * 1.1, "{jerk}");
}
