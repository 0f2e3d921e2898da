//! Tests of the engine alone: properties that hold for any number of followers, any factors, and any order of events.

use proptest::collection::vec;
use proptest::prelude::{Just, Strategy, any, prop_oneof};
use proptest::sample::Index;
use proptest::{prop_assert, prop_assert_eq, prop_assume, proptest};

use super::state::MEMBERS;
use super::{
    Axes, BeforeReference, Coupling, CouplingEvent, Events, Follower, GroupStop, Halt, Moves, OffsetSource, Policy,
    Progress, Reaction, Realign, Release, Sign, Stage, Target, TwoStage, What,
};
use crate::motion::{Limits, Motion, Setpoint};
use crate::units::{AxisNumber, AxisSet, PerAxis, Position};

const CYCLE: f64 = 0.002;

const POLICY: Policy = Policy {
    first: Reaction::Report,
    second: Reaction::Report,
    before_reference: BeforeReference::Relative,
    release: Release::CountAnew,
    stop: GroupStop::AllAtTheSlowest,
};

/// A minimal set of axes for the engine.
#[derive(Clone, Debug, Default)]
struct Bench {
    setpoints: PerAxis<Setpoint>,
    actual: PerAxis<Position>,
    referenced: AxisSet,
}

impl Axes for Bench {
    fn actual(&self, axis: AxisNumber) -> Position {
        self.actual[axis]
    }

    fn setpoint(&self, axis: AxisNumber) -> &Setpoint {
        &self.setpoints[axis]
    }

    fn is_referenced(&self, axis: AxisNumber) -> bool {
        self.referenced.contains(axis)
    }
}

impl Bench {
    fn at(positions: &[i64]) -> Self {
        let mut bench = Self::default();
        for (number, &position) in AxisNumber::all().zip(positions) {
            bench.actual[number] = Position::new(position);
            bench.setpoints[number] = Setpoint::at(Position::new(position));
        }
        bench
    }

    /// One cycle in which the leading member moves at a velocity.
    fn lead(&mut self, coupling: &Coupling, velocity: f64) {
        let leads = coupling.leads_now();
        let before = self.setpoints[leads].position;
        self.setpoints[leads].run(velocity, 1e9, CYCLE);
        let movement = self.setpoints[leads].moved_from(before);
        for (axis, movement) in coupling.lead(movement) {
            self.setpoints[axis].follow(movement);
        }
    }

    fn position(&self, axis: AxisNumber) -> i64 {
        self.setpoints[axis].position.increments()
    }
}

fn axis(number: usize) -> AxisNumber {
    AxisNumber::new(u8::try_from(number).unwrap()).unwrap()
}

fn mm(value: f64) -> Position {
    Position::from_user(value)
}

fn sign(sign: Sign) -> i64 {
    (sign * Position::new(1)).increments()
}

/// A coupling in which axis 1 leads the given axes.
fn led_by_axis_1(policy: Policy, followers: &[Follower]) -> Coupling {
    <Coupling>::new(axis(1), policy, followers.iter().copied()).unwrap()
}

/// A coupling of two axes whose difference is monitored.
fn pair(policy: Policy, limits: TwoStage) -> Coupling {
    led_by_axis_1(policy, &[Follower { limits: Some(limits), ..Follower::new(axis(2)) }])
}

fn factors() -> impl Strategy<Value = Vec<Sign>> {
    vec(prop_oneof![Just(Sign::Plus), Just(Sign::Minus)], 1..MEMBERS)
}

fn followers(factors: &[Sign], offset: OffsetSource) -> Vec<Follower> {
    let follower = |(place, &factor)| Follower { factor, offset, ..Follower::new(axis(place + 2)) };
    factors.iter().enumerate().map(follower).collect()
}

fn positions() -> impl Strategy<Value = Vec<i64>> {
    vec(-5_000_000_i64..5_000_000, MEMBERS)
}

fn compare(coupling: &mut Coupling, bench: &Bench) -> Events {
    let mut events = Events::new();
    coupling.compare(bench, &mut events);
    events
}

fn events(coupling: &mut Coupling, bench: &Bench) -> Vec<What> {
    compare(coupling, bench).iter().map(|event| event.what).collect()
}

proptest! {
    #[test]
    fn a_follower_is_where_factor_times_leader_plus_offset_is_whichever_member_led(
        factors in factors(),
        start in positions(),
        movements in vec((any::<Index>(), -3e8_f64..3e8, 1_usize..9), 1..30),
    ) {
        let mut coupling = led_by_axis_1(POLICY, &followers(&factors, OffsetSource::AtActivation));
        let mut bench = Bench::at(&start);
        let offset = |bench: &Bench, place: usize| {
            bench.position(axis(place + 2)) - sign(factors[place]) * bench.position(axis(1))
        };
        let offsets: Vec<_> = (0..factors.len()).map(|place| offset(&bench, place)).collect();
        for (leads, velocity, cycles) in movements {
            coupling.lead_with(axis(leads.index(factors.len() + 1) + 1));
            for _ in 0..cycles {
                bench.lead(&coupling, velocity);
            }
            for (place, &expected) in offsets.iter().enumerate() {
                prop_assert_eq!(offset(&bench, place), expected, "axis {}", place + 2);
                let leader = bench.setpoints[axis(1)].velocity();
                let ratio = sign(factors[place]) as f64 * leader;
                prop_assert!((bench.setpoints[axis(place + 2)].velocity() - ratio).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn a_reference_makes_no_jump_but_the_one_that_makes_the_difference_absolute(
        factors in factors(),
        start in positions(),
        configured in -1_000_000_i64..1_000_000,
        captured in any::<bool>(),
        order in vec((any::<Index>(), -5_000_000_i64..5_000_000), 1..60),
    ) {
        let configured = Position::new(configured);
        let offset = if captured { OffsetSource::AtStartUp } else { OffsetSource::Configured(configured) };
        let mut coupling = led_by_axis_1(POLICY, &followers(&factors, offset));
        let mut bench = Bench::at(&start);
        coupling.start_up(&bench);
        for (which, by) in order {
            let (member, by) = (axis(which.index(factors.len() + 1) + 1), Position::new(by));
            let before = bench.clone();
            bench.referenced.set(member, true);
            bench.actual[member] += by;
            let differences: Vec<_> =
                coupling.followers().map(|follower| coupling.difference(follower, &before).unwrap()).collect();
            coupling.value_shifted(member, by, &bench);
            for (place, &before) in differences.iter().enumerate() {
                let follower = axis(place + 2);
                let after = coupling.difference(follower, &bench).unwrap();
                let both = bench.referenced.contains(axis(1)) && bench.referenced.contains(follower);
                if both && !captured {
                    let apart = bench.actual[follower] - factors[place] * bench.actual[axis(1)];
                    prop_assert_eq!(after, apart - configured, "absolute");
                } else {
                    prop_assert_eq!(after, before, "no jump");
                }
            }
        }
    }

    #[test]
    fn an_event_comes_exactly_where_a_limit_is_crossed_and_never_twice(
        first in prop_oneof![Just(None), (1_i64..50).prop_map(Some)],
        second in 1_i64..100,
        differences in vec(-120_i64..120, 1..200),
    ) {
        let limits = TwoStage::new(first.map(Position::new), Position::new(second));
        let mut coupling = pair(POLICY, limits);
        let mut before = Stage::default();
        for difference in differences {
            let bench = Bench::at(&[0, difference]);
            let beyond = |limit: i64| difference.abs() > limit;
            let stage = Stage { first: first.is_some_and(beyond), second: beyond(second) };
            let found = compare(&mut coupling, &bench);
            let kinds: Vec<_> = found.iter().map(|event| match event.what {
                What::FirstExceeded(_) => (1, true),
                What::FirstBack(_) => (1, false),
                What::SecondExceeded(_) => (2, true),
                What::SecondBack(_) => (2, false),
                What::Realigned | What::Released | What::Closed => (0, false),
            }).collect();
            let mut expected = Vec::new();
            if stage.first != before.first {
                expected.push((1, stage.first));
            }
            if stage.second != before.second {
                expected.push((2, stage.second));
            }
            prop_assert_eq!(kinds, expected, "at {}", difference);
            let told = |event: &CouplingEvent| {
                (event.follower, event.difference) == (axis(2), Position::new(difference))
            };
            prop_assert!(found.iter().all(told));
            prop_assert_eq!(coupling.differences().next(), Some((axis(2), Position::new(difference), stage)));
            prop_assert!(compare(&mut coupling, &bench).is_empty(), "twice");
            before = stage;
        }
    }

    #[test]
    fn a_realignment_ends_on_its_target_without_overshoot_and_within_its_limits(
        factors in factors(),
        start in positions(),
        configured in -1_000_000_i64..1_000_000,
        velocity in 1e6_f64..2e8,
        acceleration in 1e8_f64..2e9,
        all in any::<bool>(),
        given in prop_oneof![Just(None), (-5_000_000_i64..5_000_000).prop_map(Some)],
    ) {
        let offset = Position::new(configured);
        let mut coupling = led_by_axis_1(POLICY, &followers(&factors, OffsetSource::Configured(offset)));
        let mut bench = Bench::at(&start);
        bench.referenced = AxisSet::ALL;
        let moves = if all { Moves::All } else { Moves::Followers };
        let how = Realign { moves, target: given.filter(|_| all).map_or(Target::LeaderSetpoint, |at| Target::Given(Position::new(at))) };
        let target = given.filter(|_| all).map_or_else(|| bench.setpoints[axis(1)].position, Position::new);
        let (from, limits) = (bench.clone(), Limits { velocity, acceleration });
        coupling.begin_realignment(how, &bench);
        prop_assert!(!coupling.is_closed());
        let mut cycles = 0;
        loop {
            let realigning = coupling.realign(&bench, |_| limits, |_| true, true).unwrap();
            if let Progress::Done(at) = realigning.progress {
                prop_assert_eq!(at, target);
                prop_assert_eq!(realigning.events.len(), factors.len());
                break;
            }
            prop_assert_eq!(realigning.commands.iter().any(|&(number, _)| number == axis(1)), all);
            for (number, motion) in realigning.commands {
                let before = bench.setpoints[number];
                motion.execute(&mut bench.setpoints[number], before.position, acceleration, CYCLE);
                let now = bench.setpoints[number];
                // The last cycle ends on a whole increment.
                prop_assert!(now.velocity().abs() <= velocity + 0.6 / CYCLE, "velocity {}", now.velocity());
                let change = (now.velocity() - before.velocity()).abs();
                prop_assert!(change <= acceleration * CYCLE + 1.1 / CYCLE, "acceleration {change}");
                let Motion::GoTo { target, .. } = motion else { panic!("{motion:?}") };
                let way = (target - from.setpoints[number].position).increments();
                let rest = (target - now.position).increments();
                prop_assert!(rest == 0 || rest.signum() == way.signum(), "overshoot {rest}");
            }
            cycles += 1;
            prop_assert!(cycles < 100_000);
        }
        prop_assert!(coupling.is_closed());
        prop_assert_eq!(bench.setpoints[axis(1)].position, target);
        bench.actual = bench.setpoints.map(|setpoint| setpoint.position);
        prop_assert!(coupling.followers().all(|axis| coupling.misalignment(axis, &bench) == Some(Position::ZERO)));
        coupling.count_anew(&bench);
        for (place, &factor) in factors.iter().enumerate() {
            prop_assert_eq!(bench.setpoints[axis(place + 2)].position, factor * target + offset);
            prop_assert_eq!(coupling.difference(axis(place + 2), &bench), Some(Position::ZERO));
        }
    }

    #[test]
    fn what_arises_while_it_is_open_counts_as_the_policy_says(
        factors in factors(),
        start in positions(),
        apart in positions(),
        keep in any::<bool>(),
        referenced in any::<bool>(),
    ) {
        let release = if keep { Release::Keep } else { Release::CountAnew };
        let mut coupling = led_by_axis_1(Policy { release, ..POLICY }, &followers(&factors, OffsetSource::Zero));
        let mut bench = Bench::at(&start);
        if referenced {
            bench.referenced = AxisSet::ALL;
        }
        coupling.start_up(&bench);
        coupling.lead_with(axis(2));
        let released = coupling.release(&bench);
        prop_assert!(released.iter().all(|event| event.what == What::Released));
        prop_assert_eq!(coupling.leads_now(), axis(1));
        bench.lead(&coupling, 1e8);
        prop_assert!(coupling.lead(bench.setpoints[axis(1)].moved_from(Position::ZERO)).next().is_none());
        let before: Vec<_> = coupling.followers().map(|axis| coupling.difference(axis, &bench).unwrap()).collect();
        for (number, &by) in AxisNumber::all().zip(&apart) {
            bench.actual[number] += Position::new(by);
        }
        let closed = coupling.close(&bench);
        prop_assert_eq!(closed.len(), factors.len());
        for (place, event) in closed.iter().enumerate() {
            let more = Position::new(apart[place + 1]) - factors[place] * Position::new(apart[0]);
            let expected = if keep || referenced { before[place] + more } else { Position::ZERO };
            prop_assert_eq!((event.what, event.difference), (What::Closed, expected));
        }
        coupling.settle(false);
        prop_assert!(!coupling.is_closed());
        coupling.settle(true);
        prop_assert!(coupling.is_closed());
    }

    #[test]
    fn an_offset_of_activation_is_of_setpoints_and_the_difference_of_actual_values(
        factors in factors(),
        start in positions(),
        deviation in positions(),
    ) {
        let mut coupling = led_by_axis_1(POLICY, &followers(&factors, OffsetSource::AtActivation));
        let mut bench = Bench::at(&start);
        for (number, &by) in AxisNumber::all().zip(&deviation) {
            bench.actual[number] += Position::new(by);
        }
        coupling.release(&bench);
        coupling.close(&bench);
        for (place, &factor) in factors.iter().enumerate() {
            let expected = Position::new(deviation[place + 1]) - factor * Position::new(deviation[0]);
            prop_assert_eq!(coupling.difference(axis(place + 2), &bench), Some(expected));
        }
    }

    #[test]
    fn a_group_stops_as_its_policy_says(factors in factors(), own in vec(1e8_f64..1e9, MEMBERS), leads in any::<Index>()) {
        let leads = axis(leads.index(factors.len() + 1) + 1);
        let stops = |stop: GroupStop| {
            let mut coupling = led_by_axis_1(Policy { stop, ..POLICY }, &followers(&factors, OffsetSource::Zero));
            coupling.lead_with(leads);
            coupling.stop(|axis| own[axis.index()]).collect::<Vec<_>>()
        };
        let members = factors.len() + 1;
        let slowest = own[..members].iter().copied().fold(f64::INFINITY, f64::min);
        let each: Vec<_> = (1..=members).map(|number| (axis(number), own[number - 1])).collect();
        let together: Vec<_> = (1..=members).map(|number| (axis(number), slowest)).collect();
        prop_assert_eq!(stops(GroupStop::AllAtTheSlowest), together);
        prop_assert_eq!(stops(GroupStop::EachAtItsOwn), each);
        prop_assert_eq!(stops(GroupStop::Leading), vec![(leads, own[leads.index()])]);
    }

    #[test]
    fn a_coupling_is_plain_data(factors in factors(), start in positions(), difference in 1_i64..1_000) {
        let mut coupling = led_by_axis_1(POLICY, &followers(&factors, OffsetSource::AtStartUp));
        let mut bench = Bench::at(&start);
        coupling.start_up(&bench);
        coupling.set_limits(|number| (number == axis(2)).then(|| TwoStage::new(None, Position::ZERO)));
        bench.actual[axis(2)] += Position::new(difference);
        prop_assume!(!compare(&mut coupling, &bench).is_empty());
        coupling.keep_bases(&bench);
        coupling.begin_realignment(Realign { moves: Moves::All, target: Target::LeaderActual }, &bench);
        let bytes = postcard::to_stdvec(&coupling).unwrap();
        prop_assert_eq!(postcard::from_bytes::<Coupling>(&bytes).unwrap(), coupling);
    }
}

#[test]
fn exactly_at_a_limit_is_not_beyond_it() {
    let limit = mm(37.7) - mm(37.5);
    let mut coupling = pair(POLICY, TwoStage::new(Some(limit), limit));
    assert_eq!(events(&mut coupling, &Bench::at(&[0, 200_000])), []);
    assert_eq!(events(&mut coupling, &Bench::at(&[0, -200_001])).len(), 2);
}

#[test]
fn an_open_coupling_has_nothing_beyond_a_limit() {
    let mut coupling = pair(POLICY, TwoStage::new(Some(mm(0.1)), mm(0.5)));
    let apart = Bench::at(&[0, 1_000_000]);
    assert_eq!(events(&mut coupling, &apart).len(), 2);
    coupling.release(&apart);
    assert!(matches!(events(&mut coupling, &apart)[..], [What::FirstBack(None), What::SecondBack(None)]));
    coupling.close(&apart);
    assert_eq!(coupling.difference(axis(2), &apart), Some(Position::ZERO), "it counts from where it closed");
    assert_eq!(events(&mut coupling, &Bench::at(&[0, 2_000_000])).len(), 2);
}

#[test]
fn before_reference_nothing_is_monitored_where_the_policy_is_off_but_for_a_captured_offset() {
    let policy = Policy { before_reference: BeforeReference::Off, ..POLICY };
    for (offset, before) in
        [(OffsetSource::Zero, 0), (OffsetSource::Configured(mm(1.0)), 0), (OffsetSource::AtStartUp, 1)]
    {
        let limits = Some(TwoStage::new(None, mm(0.5)));
        let mut coupling = led_by_axis_1(policy, &[Follower { offset, limits, ..Follower::new(axis(2)) }]);
        let mut bench = Bench::at(&[0, 3_000_000]);
        assert_eq!(events(&mut coupling, &bench).len(), before, "{offset:?}");
        bench.referenced = AxisSet::of(axis(1)).with(AxisSet::of(axis(2)));
        coupling.value_shifted(axis(2), Position::ZERO, &bench);
        assert_eq!(events(&mut coupling, &bench).len(), 1 - before, "{offset:?}");
    }
}

#[test]
fn a_halt_lasts_until_its_reset_or_for_good_and_persisting_differences_do_not_repeat_it() {
    let policy = Policy { first: Reaction::Stop, second: Reaction::Lock, ..POLICY };
    let mut coupling = pair(policy, TwoStage::new(Some(mm(0.1)), mm(0.5)));
    compare(&mut coupling, &Bench::at(&[0, 200_000]));
    assert_eq!(coupling.halt(), Some(Halt::UntilReset));
    coupling.reset();
    compare(&mut coupling, &Bench::at(&[0, 200_000]));
    assert_eq!(coupling.halt(), None, "still above the limit, no second halt");
    compare(&mut coupling, &Bench::at(&[0, 600_000]));
    compare(&mut coupling, &Bench::at(&[0, 0]));
    coupling.reset();
    assert_eq!(coupling.halt(), Some(Halt::Locked));
}

#[test]
fn limits_count_from_the_base_in_both_directions_and_the_smaller_second_one_acts() {
    let limits = |second| TwoStage { second_beyond_base: Some(mm(1.0)), ..TwoStage::new(Some(mm(0.1)), second) };
    let mut coupling = pair(POLICY, limits(mm(10.0)));
    coupling.keep_bases(&Bench::at(&[0, -2_000_000]));
    assert_eq!(events(&mut coupling, &Bench::at(&[0, -2_100_000])), []);
    assert_eq!(events(&mut coupling, &Bench::at(&[0, -1_900_000])), []);
    let limit = |what: &What| match *what {
        What::FirstExceeded(limit) | What::SecondExceeded(limit) => Some((limit.at, limit.base)),
        What::FirstBack(_) | What::SecondBack(_) | What::Realigned | What::Released | What::Closed => None,
    };
    let found = events(&mut coupling, &Bench::at(&[0, -900_000]));
    let base = Some(mm(-2.0));
    assert_eq!(found.iter().filter_map(limit).collect::<Vec<_>>(), [(mm(0.1), base), (mm(1.0), base)]);
    coupling.set_limits(|_| Some(limits(mm(0.5))));
    assert_eq!(events(&mut coupling, &Bench::at(&[0, -2_000_000])).len(), 2);
    let found = events(&mut coupling, &Bench::at(&[0, -2_600_000]));
    assert_eq!(found.iter().filter_map(limit).next_back(), Some((mm(0.5), base)), "the other limit is smaller");
    coupling.set_limits(|_| Some(TwoStage::new(Some(mm(3.0)), mm(2.6))));
    assert_eq!(events(&mut coupling, &Bench::at(&[0, -2_600_000])).len(), 2, "limits from zero: within both");
    coupling.set_limits(|_| Some(limits(mm(0.5))));
    assert_eq!(events(&mut coupling, &Bench::at(&[0, -2_000_000])), []);
    coupling.clear_bases();
    assert_eq!(events(&mut coupling, &Bench::at(&[0, -2_000_000])).len(), 2, "from zero again");
}

#[test]
fn the_base_follows_the_difference_towards_zero_while_members_realign_and_never_back() {
    let limits = TwoStage { second_beyond_base: Some(mm(0.2)), ..TwoStage::new(Some(mm(0.1)), mm(10.0)) };
    let mut coupling = pair(POLICY, limits);
    let at = |difference: i64| Bench::at(&[0, difference]);
    coupling.keep_bases(&at(2_000_000));
    coupling.begin_realignment(Realign { moves: Moves::All, target: Target::LeaderActual }, &at(2_000_000));
    assert_eq!(events(&mut coupling, &at(2_100_000)), [], "not beyond, and no higher base");
    assert_eq!(events(&mut coupling, &at(1_000_000)), []);
    coupling.abort_realignment();
    assert_eq!(events(&mut coupling, &at(900_000)), [], "still braking");
    coupling.settle(true);
    assert_eq!(events(&mut coupling, &at(1_000_000)), []);
    assert_eq!(events(&mut coupling, &at(1_000_001)).len(), 1, "0.9 is the base now");
    assert_eq!(events(&mut coupling, &at(699_999)).len(), 1);
}

#[test]
fn a_member_that_rests_on_its_target_and_is_not_in_position_is_waited_for() {
    let mut coupling = led_by_axis_1(POLICY, &[Follower::new(axis(2)), Follower::new(axis(3))]);
    let bench = Bench::at(&[0, 0, 0]);
    coupling.begin_realignment(Realign { moves: Moves::Followers, target: Target::LeaderActual }, &bench);
    let limits = Limits { velocity: 1e6, acceleration: 1e9 };
    for cycle in 1..=3 {
        let progress = coupling.realign(&bench, |_| limits, |number| number != axis(3), true).unwrap().progress;
        assert_eq!(progress, Progress::Waiting(axis(3), cycle));
    }
    let progress = coupling.realign(&bench, |_| limits, |_| true, false).unwrap().progress;
    assert_eq!(progress, Progress::Running, "all in position, and it must not end yet");
    coupling.abort_realignment();
    assert!(coupling.realign(&bench, |_| limits, |_| true, true).is_none());
    coupling.settle(true);
    assert!(coupling.is_closed());
}

#[test]
fn every_axis_can_be_a_member_and_none_can_be_one_twice() {
    let all = || AxisNumber::all().skip(1).map(Follower::new);
    assert_eq!(<Coupling>::new(axis(1), POLICY, all()).map(|coupling| coupling.members().count()), Some(MEMBERS));
    assert_eq!(Coupling::<2>::new(axis(1), POLICY, all().take(2)).map(|pair| pair.followers().len()), Some(2));
    assert_eq!(Coupling::<2>::new(axis(1), POLICY, all()), None, "more followers than the control allows");
    assert_eq!(<Coupling>::new(axis(5), POLICY, all()), None, "the leader follows itself");
    assert_eq!(<Coupling>::new(axis(1), POLICY, all().chain([Follower::new(axis(2))])), None);
}
