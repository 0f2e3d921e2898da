//! The state of the simulated mechanics: slides moved by drives, bridges that pull them together, and faults.
//!
//! A bridge between 0 and rigid removes its stiffness as a share of a difference per second: (1 − stiffness) of it is left after one second,
//! and the power of this share with the cycle after one cycle. This approaches the rigid bridge, which removes all of it at once. The slide
//! and its motor move together: the velocity of the motor includes the pull of the bridge. Drives that hold a misalignment therefore stand
//! still, with a deviation that grows with the stiffness up to half of the misalignment each.

use serde::{Deserialize, Serialize};

use super::hold::{GRAVITY, Hold};
use super::{AxisMechanics, Fault, FaultKind, HoldingBrake, Layout, Leadscrew, Switch};
use crate::motion::{Brake, Drive, Encoder, EncoderSignal, Feedback, within_reach};
use crate::units::{AxisNumber, AxisSet, PerAxis, Position, Time};

/// One slide.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Slide {
    position: Position,
    /// Its position at the last [`Plant::feedback`].
    reported: Position,
    /// The encoder counts at that position, kept because most slides rest most of the time.
    counts: [Position; 2],
    drive: Drive,
    /// Its holding brake, and the weight of the slide.
    hold: Hold,
    /// How far the slide is on the other side of the play of its leadscrew.
    play: Position,
    /// Velocity by the pull of a bridge, in addition to that of the drive.
    pulled: f64,
    encoders: [Encoder; 2],
    ready_in: Time,
    blocked: bool,
    zero_mark_missing: bool,
    drive_fault: bool,
    /// Part of the position that its drive does not see.
    held: Position,
    drive_not_ready: bool,
    /// The constant signal of an encoder with a fault.
    dead: [Option<Position>; 2],
    /// Remaining share of the velocity.
    grip: f64,
    /// Velocity without power.
    drift: f64,
    /// Cam, limit plus, limit minus.
    stuck: [Option<bool>; 3],
}

/// The simulated mechanics of a machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plant {
    slides: PerAxis<Option<Slide>>,
    /// Axes that changed since the last call of [`Plant::restless`].
    #[serde(skip, default = "all")]
    changed: AxisSet,
    /// Axes that changed in the cycle before that: a reported zero mark has been passed.
    #[serde(skip, default = "all")]
    changed_before: AxisSet,
    /// Axes whose drives may not have started up yet.
    #[serde(skip, default = "all")]
    running_up: AxisSet,
    /// The axes with pressed cam, plus switch and minus switch; derived from the slides.
    #[serde(skip)]
    pressed: [AxisSet; 3],
}

/// After restoring, every axis counts as changed.
const fn all() -> AxisSet {
    AxisSet::ALL
}

impl Plant {
    /// A plant at its start positions, switched on.
    #[must_use]
    pub fn new(layout: &Layout) -> Self {
        let slides = PerAxis::from_fn(|axis| layout.axes[axis].as_ref().map(Slide::new));
        Self { slides, changed: all(), changed_before: all(), running_up: all(), pressed: [AxisSet::NONE; 3] }
    }

    /// Power off and on: slides and faults stay, drives start up again, encoders count from the present positions.
    pub fn power_on(&mut self, layout: &Layout) {
        (self.changed, self.running_up) = (all(), all());
        for (axis, slide) in self.slides.iter_mut() {
            if let (Some(slide), Some(mechanics)) = (slide, &layout.axes[axis]) {
                slide.drive = Drive::default();
                slide.pulled = 0.0;
                slide.hold.power_off();
                slide.ready_in = mechanics.ready_after;
                for (encoder, dead) in slide.encoders.iter_mut().zip(&mut slide.dead) {
                    encoder.restart(slide.position);
                    *dead = dead.map(|_| encoder.value(slide.position));
                }
                slide.count();
            }
        }
    }

    /// A fault begins; `active` is the measuring system that the control uses.
    pub fn fault(&mut self, fault: Fault, active: Option<u8>) {
        let Some(slide) = &mut self.slides[fault.axis] else {
            return;
        };
        self.changed.set(fault.axis, true);
        match fault.kind {
            FaultKind::Block => slide.blocked = true,
            FaultKind::Push { by } => slide.push(by),
            FaultKind::EncoderSlip { by } => {
                slide.encoders[usize::from(active.unwrap_or(0))].slip(by);
                slide.count();
            }
            FaultKind::ZeroMarkMissing => slide.zero_mark_missing = true,
            FaultKind::DriveFault => slide.drive_fault = true,
            FaultKind::EncoderFault { encoder } => slide.kill(usize::from(encoder.or(active).unwrap_or(0))),
            FaultKind::Friction { by } => slide.grip = 1.0 - by,
            FaultKind::Drift { by } => slide.drift = by,
            FaultKind::SwitchStuck { which, at } => slide.stuck[which as usize] = Some(at),
            FaultKind::Hold { by } => slide.hold_away(by),
            FaultKind::MovedByHand { by } => slide.push(by),
            FaultKind::DriveNotReady => slide.drive_not_ready = true,
        }
    }

    /// A fault ends. A single displacement stays. Returns whether this changes the slide: not if the fault did not act.
    pub fn clear_fault(&mut self, fault: Fault) -> bool {
        let Some(slide) = &mut self.slides[fault.axis] else {
            return false;
        };
        let before = *slide;
        self.changed.set(fault.axis, true);
        match fault.kind {
            FaultKind::Block => slide.blocked = false,
            FaultKind::Push { .. } | FaultKind::EncoderSlip { .. } | FaultKind::MovedByHand { .. } => {}
            FaultKind::Hold { .. } => slide.hold_away(Position::ZERO),
            FaultKind::DriveNotReady => slide.drive_not_ready = false,
            FaultKind::ZeroMarkMissing => slide.zero_mark_missing = false,
            FaultKind::DriveFault => slide.drive_fault = false,
            FaultKind::EncoderFault { encoder: None } => {
                slide.revive(0);
                slide.revive(1);
            }
            FaultKind::EncoderFault { encoder: Some(encoder) } => slide.revive(usize::from(encoder)),
            FaultKind::Friction { .. } => slide.grip = 1.0,
            FaultKind::Drift { .. } => slide.drift = 0.0,
            FaultKind::SwitchStuck { which, .. } => slide.stuck[which as usize] = None,
        }
        *slide != before
    }

    /// One position-control cycle: each drive responds to its command, slides move, bridges pull.
    ///
    /// A command of `None` is a drive without power: its motor brakes as fast as its speed loop would. Only these axes are moved;
    /// axes that share a bridge with one of them must be included. Returns the axes that changed.
    pub fn advance(
        &mut self,
        layout: &Layout,
        axes: AxisSet,
        cycle: f64,
        mut command: impl FnMut(AxisNumber, [Position; 2]) -> Option<f64>,
    ) -> AxisSet {
        let mut changed = AxisSet::NONE;
        for axis in axes.iter() {
            if let (Some(slide), Some(mechanics)) = (&mut self.slides[axis], &layout.axes[axis]) {
                let has_power = !slide.drive_not_ready && (!slide.drive_fault || mechanics.intelligent);
                let command = command(axis, slide.values()).filter(|_| has_power);
                changed.set(axis, slide.advance(command, mechanics, cycle));
            }
        }
        for bridge in layout.bridges.iter().filter(|bridge| axes.contains(bridge.first)) {
            for &(other, offset) in &bridge.others {
                if self.pull(bridge.first, other, offset, bridge.stiffness, cycle) {
                    changed = changed.with(AxisSet::of(bridge.first)).with(AxisSet::of(other));
                }
            }
        }
        self.changed = self.changed.with(changed);
        changed
    }

    /// A bridge removes its share of a difference, half of it on each slide, or all of it on the only slide that can move.
    /// Returns whether a slide moved.
    fn pull(&mut self, first: AxisNumber, other: AxisNumber, offset: Position, stiffness: f64, cycle: f64) -> bool {
        let (Some(a), Some(b)) = (self.slides[first], self.slides[other]) else {
            return false;
        };
        let strain = (b.position - a.position - offset).increments() as f64;
        if strain == 0.0 || stiffness <= 0.0 {
            return false;
        }
        let share = share_per_cycle(stiffness, cycle);
        let (to_a, to_b) = match (a.blocked, b.blocked) {
            (false, false) => (0.5, 0.5),
            (false, true) => (1.0, 0.0),
            (true, false) => (0.0, 1.0),
            (true, true) => return false,
        };
        #[expect(clippy::cast_possible_truncation, reason = "a strain fits by far; the cast saturates")]
        let whole = |movement: f64| Position::new(movement.round() as i64);
        let taken = whole(strain * share);
        let moved_a = whole(strain * share * to_a);
        let moved_b = if to_b > 0.0 { taken - moved_a } else { Position::ZERO };
        if taken == Position::ZERO && moved_a == Position::ZERO {
            return false;
        }
        let rigid = stiffness >= 1.0;
        let by = |moved: Position| if rigid { 0.0 } else { moved.increments() as f64 / cycle };
        let velocity = 0.5 * (a.drive.velocity() + b.drive.velocity());
        if let Some(slide) = &mut self.slides[first] {
            slide.position += moved_a;
            slide.pulled += by(moved_a);
            if rigid {
                slide.drive.force(if b.blocked { 0.0 } else { velocity });
            }
        }
        if let Some(slide) = &mut self.slides[other] {
            slide.position -= moved_b;
            slide.pulled -= by(moved_b);
            if rigid {
                slide.drive.force(if a.blocked { 0.0 } else { velocity });
            }
        }
        true
    }

    /// Those of these axes that changed since the last call, which is made once per cycle.
    pub fn restless(&mut self, axes: AxisSet) -> AxisSet {
        self.changed_before = self.changed;
        self.changed = self.changed.without(axes);
        self.changed_before.and(axes)
    }

    /// Those of these axes whose drive or encoder signals differ from the previous cycle.
    #[must_use]
    pub fn news(&self, axes: AxisSet) -> AxisSet {
        self.changed.with(self.changed_before).and(axes)
    }

    /// The signals of drive and encoders of an axis since the last call.
    pub fn feedback(&mut self, layout: &Layout, axis: AxisNumber) -> Feedback {
        match (&mut self.slides[axis], &layout.axes[axis]) {
            (Some(slide), Some(mechanics)) => slide.feedback(&mechanics.leadscrew, mechanics.brake),
            (Some(_) | None, _) => Feedback::default(),
        }
    }

    /// One cycle of the holding brakes; those of the axes `open` are to be open.
    pub fn move_brakes(&mut self, layout: &Layout, open: AxisSet, cycle: Time) {
        for axis in layout.vertical.iter() {
            if let (Some(slide), Some(mechanics)) = (&mut self.slides[axis], &layout.axes[axis])
                && let Some(brake) = mechanics.brake
                && slide.hold.step(open.contains(axis), brake, cycle)
            {
                self.changed.set(axis, true);
            }
        }
    }

    /// Start-up of the drives.
    pub fn run_up(&mut self, axes: AxisSet, cycle: Time) {
        for axis in axes.and(self.running_up).iter() {
            match &mut self.slides[axis] {
                Some(slide) if slide.ready_in > Time::ZERO => {
                    slide.ready_in = (slide.ready_in - cycle).max(Time::ZERO);
                    self.changed.set(axis, true);
                }
                Some(_) | None => self.running_up.set(axis, false),
            }
        }
    }

    /// The axes with this switch pressed, as of the last [`Plant::press_switches`].
    #[must_use]
    pub fn pressed(&self, switch: Switch) -> AxisSet {
        self.pressed[switch as usize]
    }

    /// Slides press the switches at their positions; these axes may have moved.
    pub fn press_switches(&mut self, layout: &Layout, axes: AxisSet) {
        for axis in axes.iter() {
            for switch in [Switch::Cam, Switch::LimitPlus, Switch::LimitMinus] {
                let pressed = self.is_pressed(layout, axis, switch);
                self.pressed[switch as usize].set(axis, pressed);
            }
        }
    }

    fn is_pressed(&self, layout: &Layout, axis: AxisNumber, switch: Switch) -> bool {
        let (Some(slide), Some(mechanics)) = (&self.slides[axis], &layout.axes[axis]) else {
            return false;
        };
        if let Some(stuck) = slide.stuck[switch as usize] {
            return stuck;
        }
        let position = slide.position;
        match switch {
            Switch::Cam => mechanics.cam.as_ref().is_some_and(|cam| cam.from <= position && position <= cam.to),
            Switch::LimitPlus => mechanics.limit_plus.as_ref().is_some_and(|limit| position >= limit.at),
            Switch::LimitMinus => mechanics.limit_minus.as_ref().is_some_and(|limit| position <= limit.at),
        }
    }
}

/// The share of a difference that a bridge removes in a cycle: 1 − (1 − stiffness)^cycle, with the cycle in seconds. The power is the
/// product of the square roots that belong to the binary digits of the cycle.
fn share_per_cycle(stiffness: f64, cycle: f64) -> f64 {
    let (mut left, mut root, mut part, mut rest) = (1.0, 1.0 - stiffness, 1.0, cycle.min(1.0));
    for _ in 0..DIGITS {
        (root, part) = (root.sqrt(), 0.5 * part);
        if rest >= part {
            (left, rest) = (left * root, rest - part);
        }
    }
    1.0 - left
}

/// Binary digits of a cycle in seconds: better than a billionth of a second.
const DIGITS: u32 = 32;

impl Slide {
    fn new(mechanics: &AxisMechanics) -> Self {
        Self {
            position: mechanics.start,
            reported: mechanics.start,
            counts: mechanics.encoders.map(|encoder| encoder.value(mechanics.start)),
            drive: Drive::default(),
            hold: Hold::default(),
            play: Position::ZERO,
            pulled: 0.0,
            encoders: mechanics.encoders,
            ready_in: mechanics.ready_after,
            blocked: false,
            zero_mark_missing: false,
            drive_fault: false,
            held: Position::ZERO,
            drive_not_ready: false,
            dead: [None; 2],
            grip: 1.0,
            drift: 0.0,
            stuck: [None; 3],
        }
    }

    /// The present counts of both encoders.
    fn values(&self) -> [Position; 2] {
        if self.position == self.reported && self.held == Position::ZERO {
            return self.counts;
        }
        let seen = self.position - self.held;
        [0, 1].map(|index| self.dead[index].unwrap_or_else(|| self.encoders[index].value(seen)))
    }

    /// The signals of drive and encoders since the last call.
    fn feedback(&mut self, leadscrew: &Leadscrew, brake: Option<HoldingBrake>) -> Feedback {
        self.play = leadscrew.play(self.play, self.position - self.reported);
        Feedback {
            encoders: self.signals(),
            half_count: [self.encoders[0].half_count(), self.encoders[1].half_count()],
            velocity: self.drive.velocity() + self.pulled,
            brake: brake.map_or(Brake::None, |_| self.hold.state()),
            drive_ready: self.ready_in == Time::ZERO && !self.drive_fault && !self.drive_not_ready,
            drive_fault: self.drive_fault,
            absolute: self.encoders.map(|encoder| encoder.is_absolute()),
            encoder_faults: self.dead.map(|dead| dead.is_some()),
            cam: false,
            slide: self.position + leadscrew.error(self.position) + self.play,
        }
    }

    fn signals(&mut self) -> [EncoderSignal; 2] {
        if self.position == self.reported {
            return self.counts.map(|value| EncoderSignal { value, zero_mark: None });
        }
        let signals = [0, 1].map(|index| {
            let mut signal = self.encoders[index].signal(self.reported, self.position);
            signal.value = self.dead[index].unwrap_or(signal.value);
            if self.zero_mark_missing || self.dead[index].is_some() {
                signal.zero_mark = None;
            }
            signal
        });
        self.reported = self.position;
        self.counts = signals.map(|signal| signal.value);
        signals
    }

    /// Displaces the slide, within its permitted range.
    fn push(&mut self, by: Position) {
        self.position = within_reach(self.position.increments().saturating_add(by.increments()));
    }

    /// Holds the slide this far from where its drive wants it.
    fn hold_away(&mut self, by: Position) {
        self.push(by - self.held);
        self.held = by;
    }

    /// Updates the encoder counts after a displacement.
    fn count(&mut self) {
        self.counts = [0, 1].map(|index| self.dead[index].unwrap_or_else(|| self.encoders[index].value(self.reported)));
    }

    /// An encoder sends no new values from now on.
    fn kill(&mut self, encoder: usize) {
        self.dead[encoder] = self.dead[encoder].or(Some(self.counts[encoder]));
    }

    /// An incremental encoder counts on from its last value: movement in the meantime is lost.
    fn revive(&mut self, encoder: usize) {
        if let Some(value) = self.dead[encoder].take() {
            if self.encoders[encoder].is_absolute() {
                self.count();
                return;
            }
            let lost = value - self.encoders[encoder].value(self.reported);
            self.encoders[encoder].slip(lost);
            self.count();
        }
    }

    /// A command of `None` is a drive without power. Returns whether anything changed.
    fn advance(&mut self, command: Option<f64>, mechanics: &AxisMechanics, cycle: f64) -> bool {
        let time_constant = mechanics.time_constant;
        let before = (self.position, self.drive, self.pulled);
        self.pulled = 0.0;
        match command {
            None if mechanics.gravity && self.hold.falls() => {
                self.drive.force(self.drive.velocity() - GRAVITY * cycle);
            }
            None if self.drift != 0.0 => self.drive.force(self.drift),
            None => self.drive.answer(0.0, time_constant, cycle),
            Some(velocity) => self.drive.answer(velocity * self.grip, time_constant, cycle),
        }
        self.hold.carried |= command.is_some();
        if self.blocked || mechanics.brake.is_some() && self.hold.holds() {
            self.drive.force(0.0);
        } else {
            self.position = self.drive.moved(self.position, cycle);
        }
        before != (self.position, self.drive, self.pulled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::{Hints, PlantDefinition};

    const CYCLE: f64 = 0.002;

    fn mm(value: f64) -> Position {
        Position::from_user(value)
    }

    /// One axis at 5 mm with zero marks every 10 mm, started up.
    fn plant() -> (Layout, Plant, AxisNumber) {
        let axis = AxisNumber::new(1).unwrap();
        let names = PerAxis::from_fn(|number| (number == axis).then(|| "X".to_owned()));
        let hints = PerAxis::from_fn(|number| Hints {
            exists: number == axis,
            zero_mark_spacing: [mm(10.0); 2],
            ..Hints::default()
        });
        let definition = PlantDefinition::parse("[X]\nstart = 5.0\n", "plant.toml").unwrap();
        let layout = Layout::new(&definition, &names, &hints, &[]);
        let mut plant = Plant::new(&layout);
        plant.run_up([axis].into_iter().collect(), Time::from_millis(20));
        (layout, plant, axis)
    }

    fn advance(plant: &mut Plant, layout: &Layout, axis: AxisNumber, command: Option<f64>, cycles: u32) {
        for _ in 0..cycles {
            plant.advance(layout, [axis].into_iter().collect(), CYCLE, |_, _| command);
        }
    }

    #[test]
    fn a_drive_with_a_fault_is_not_ready_and_does_not_respond() {
        let (layout, mut plant, axis) = plant();
        assert!(plant.feedback(&layout, axis).drive_ready && !plant.feedback(&layout, axis).drive_fault);
        plant.fault(Fault { axis, kind: FaultKind::DriveFault }, Some(0));
        advance(&mut plant, &layout, axis, Some(1e9), 10);
        assert!(
            !plant.feedback(&layout, axis).drive_ready
                && plant.feedback(&layout, axis).drive_fault
                && plant.feedback(&layout, axis).slide == mm(5.0)
        );
        plant.clear_fault(Fault { axis, kind: FaultKind::DriveFault });
        assert!(plant.feedback(&layout, axis).drive_ready && !plant.feedback(&layout, axis).drive_fault);
    }

    #[test]
    fn a_bridge_leaves_the_rest_of_a_difference_after_a_second_and_all_of_it_at_once_if_it_is_rigid() {
        for stiffness in [0.1, 0.5, 0.9, 0.999, 1.0 - 1e-12] {
            for cycle in [0.001, 0.002, 0.008, 0.0125] {
                let mut left = 1.0;
                let mut time = 0.0;
                while time < 1.0 - 1e-9 {
                    left *= 1.0 - share_per_cycle(stiffness, cycle);
                    time += cycle;
                }
                assert!((left - (1.0 - stiffness)).abs() < 1e-6, "{stiffness} {cycle} {left}");
            }
        }
        assert!((share_per_cycle(1.0, 0.002) - 1.0).abs() < 1e-15);
        let shares = [0.9, 0.999, 1.0 - 1e-12, 1.0].map(|stiffness| share_per_cycle(stiffness, 0.002));
        assert!(shares.windows(2).all(|pair| pair[0] < pair[1]), "{shares:?}");
    }

    #[test]
    fn friction_takes_its_share_of_the_velocity() {
        let (layout, mut plant, axis) = plant();
        plant.fault(Fault { axis, kind: FaultKind::Friction { by: 0.25 } }, Some(0));
        advance(&mut plant, &layout, axis, Some(8e6), 200);
        assert!(
            (plant.feedback(&layout, axis).velocity - 6e6).abs() < 1.0,
            "{}",
            plant.feedback(&layout, axis).velocity
        );
        plant.clear_fault(Fault { axis, kind: FaultKind::Friction { by: 0.0 } });
        advance(&mut plant, &layout, axis, Some(8e6), 200);
        assert!(
            (plant.feedback(&layout, axis).velocity - 8e6).abs() < 1.0,
            "{}",
            plant.feedback(&layout, axis).velocity
        );
    }

    #[test]
    fn drift_moves_a_slide_without_power_only() {
        let (layout, mut plant, axis) = plant();
        plant.fault(Fault { axis, kind: FaultKind::Drift { by: -1e6 } }, Some(0));
        advance(&mut plant, &layout, axis, Some(0.0), 500);
        assert_eq!(plant.feedback(&layout, axis).slide, mm(5.0));
        // 1 mm/s for 500 cycles of 2 ms.
        advance(&mut plant, &layout, axis, None, 500);
        assert_eq!(plant.feedback(&layout, axis).slide, mm(4.0));
    }

    #[test]
    fn an_encoder_with_a_fault_keeps_its_value_and_counts_on_from_there() {
        let (layout, mut plant, axis) = plant();
        let dead = Fault { axis, kind: FaultKind::EncoderFault { encoder: None } };
        plant.fault(dead, Some(0));
        assert_eq!(plant.feedback(&layout, axis).encoder_faults, [true, false]);
        plant.fault(Fault { axis, kind: FaultKind::Push { by: mm(6.0) } }, Some(0));
        // Past the zero mark at 10 mm: only encoder 2 reports it.
        let [first, second] = plant.feedback(&layout, axis).encoders;
        assert_eq!((first.value, first.zero_mark), (mm(0.0), None));
        assert_eq!((second.value, second.zero_mark), (mm(6.0), Some(mm(5.0))));
        plant.clear_fault(dead);
        plant.fault(Fault { axis, kind: FaultKind::Push { by: mm(1.0) } }, Some(0));
        assert_eq!(plant.feedback(&layout, axis).encoders.map(|signal| signal.value), [mm(1.0), mm(7.0)]);
        assert_eq!(plant.feedback(&layout, axis).encoder_faults, [false; 2]);
    }
}
