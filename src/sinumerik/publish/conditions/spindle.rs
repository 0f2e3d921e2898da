//! Conditions of the signals of a spindle: 60.0, 82.3, 83.x, 84.x, 85.5, and its traverse commands.

use crate::control::{Condition, Fact, fact, yes};
use crate::image::{axis_from_nck, axis_to_nck};
use crate::sinumerik::jog::keys::key_signal;
use crate::sinumerik::parameters::dynamics::StopLimit;
use crate::sinumerik::parameters::spindle::{REVOLUTION_PER_MINUTE, SpindleParameters};
use crate::sinumerik::publish::conditions::look::{Look, Row};
use crate::sinumerik::publish::conditions::motion::sign;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::spindle::state::{Mode, Phase, Spindle, SpindlePositioning};
use crate::sinumerik::state::Unit;
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{Input, Place, six_decimals};

/// The signals.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::with(
        axis_from_nck::spindle_no_axis,
        |look, axis| {
            let words = "one with M3, M4, M5 or SPOS";
            look.of_spindle(axis, |_, spindle| {
                vec![look.spindle_operation(axis, spindle, true).after(|| look.by_program(axis, words))]
            })
        },
        |look, axis| match look.spindle(axis) {
            Some((_, spindle)) => {
                look.spindle_operation(axis, spindle, false).after(|| look.by_program(axis, "one with M70"))
            }
            None => Condition::from(look.is_spindle(axis)).opposite(),
        },
    ),
    Row::with(
        axis_from_nck::change_gear_stage,
        |look, axis| look.of_spindle(axis, |_, spindle| vec![look.gear_change_begins(axis, spindle)]),
        |look, axis| look.no_gear_change(axis),
    ),
    Row::new(axis_from_nck::speed_limit_exceeded, |look, axis| {
        look.of_spindle(axis, |own, spindle| vec![look.too_fast(axis, own, spindle)])
    }),
    Row::new(axis_from_nck::setpoint_speed_limited, |look, axis| {
        look.of_spindle(axis, |_, spindle| {
            vec![look.bounded(
                axis,
                spindle,
                "above a limit (MD35100, MD35130, SD43220, MD35160 with 3.6)",
                spindle.limited,
            )]
        })
    }),
    Row::new(axis_from_nck::setpoint_speed_increased, |look, axis| {
        look.of_spindle(axis, |_, spindle| {
            vec![look.bounded(axis, spindle, "below its minimum (MD35140, SD43210)", spindle.raised)]
        })
    }),
    Row::new(axis_from_nck::spindle_in_setpoint_range, |look, axis| {
        look.of_spindle(axis, |own, spindle| {
            vec![look.speed_control(axis, spindle).into(), look.at_its_speed(axis, own, spindle)]
        })
    }),
    Row::new(axis_from_nck::actual_direction_of_rotation_clockwise, |look, axis| {
        look.of_spindle(axis, |_, _| {
            let (velocity, limit) = (look.state.axes[axis].velocity, look.parameters.axes[axis].standstill_velocity);
            let what = format!("speed of {} clockwise", look.axis_name(axis));
            let wanted = format!("at least {} (MD36060)", speed(limit));
            vec![Fact::new(what, speed(velocity), wanted, velocity >= limit).into()]
        })
    }),
    Row::with(
        axis_from_nck::positioning_mode,
        |look, axis| {
            look.of_spindle(axis, |_, spindle| {
                let by_program = || look.by_program(axis, "one with SPOS, SPOSA or M19");
                let starts = || Condition::Any(vec![by_program(), look.start_by_plc(axis)]);
                vec![look.positioning_spindle(axis, spindle, true).after(starts)]
            })
        },
        |look, axis| match look.spindle(axis) {
            Some((_, spindle)) => look.positioning_spindle(axis, spindle, false).after(|| {
                if look.state.single.axes[axis].spindle.is_some() {
                    return Condition::Any(look.ends_of_spindle_function(axis));
                }
                look.by_program(axis, "one with M3, M4, M5 or M70, or the end of the program")
            }),
            None => Condition::from(look.is_spindle(axis)).opposite(),
        },
    ),
    Row::with(
        axis_from_nck::oscillation_mode,
        |look, axis| look.of_spindle(axis, |_, spindle| vec![look.oscillates(axis, spindle)]),
        |look, axis| look.oscillates_no_more(axis),
    ),
    Row::new(axis_from_nck::control_mode, |look, axis| {
        Condition::All(vec![
            look.axis(axis, axis_from_nck::spindle_no_axis, true),
            look.axis(axis, axis_from_nck::positioning_mode, false),
            look.axis(axis, axis_from_nck::oscillation_mode, false),
        ])
    }),
    Row::new(axis_from_nck::spindle_in_position, |look, axis| {
        look.of_spindle(axis, |_, spindle| {
            vec![look.axis(axis, axis_from_nck::positioning_mode, true), look.in_position(axis, spindle)]
        })
    }),
];

/// A speed in rev/min.
fn speed(increments: f64) -> String {
    format!("{} rev/min", six_decimals(increments / REVOLUTION_PER_MINUTE))
}

impl<'a> Look<'a> {
    /// The spindle on an axis, with its data.
    pub(super) fn spindle(self, axis: AxisNumber) -> Option<(&'a SpindleParameters, &'a Spindle)> {
        Some((self.parameters.axes[axis].spindle.as_deref()?, self.state.spindles[axis].as_deref()?))
    }

    fn is_spindle(self, axis: AxisNumber) -> Fact {
        fact(format!("{} is a spindle (MD35000)", self.axis_name(axis)), self.spindle(axis).is_some())
    }

    /// What must hold of a spindle; an axis that is none has none of these signals.
    fn of_spindle(
        self,
        axis: AxisNumber,
        all: impl FnOnce(&SpindleParameters, &Spindle) -> Vec<Condition>,
    ) -> Condition {
        match self.spindle(axis) {
            Some((own, spindle)) => Condition::All(all(own, spindle)),
            None => self.is_spindle(axis).into(),
        }
    }

    fn spindle_operation(self, axis: AxisNumber, spindle: &Spindle, wanted: bool) -> Fact {
        let is_spindle = spindle.mode != Mode::Axis || self.state.axes[axis].speed_controlled;
        let word = |is: bool| if is { "spindle operation" } else { "axis operation (M70)" };
        Fact::new(
            format!("operation of {}", self.axis_name(axis)),
            word(is_spindle),
            word(wanted),
            is_spindle == wanted,
        )
    }

    fn positioning_spindle(self, axis: AxisNumber, spindle: &Spindle, wanted: bool) -> Fact {
        let positions = matches!(spindle.mode, Mode::Positioning(_));
        let what = format!("a program or the PLC positions {}", self.axis_name(axis));
        Fact::new(what, yes(positions), yes(wanted), positions == wanted)
    }

    /// The speed that a program or a key wants, against its limits.
    fn bounded(self, axis: AxisNumber, spindle: &Spindle, wanted: &str, holds: bool) -> Condition {
        let found = if spindle.is_programmed() {
            format!("S{} at {}", spindle.speed, speed(spindle.commanded.abs()))
        } else {
            speed(spindle.commanded.abs())
        };
        Fact::new(format!("commanded speed of {}", self.axis_name(axis)), found, wanted, holds).into()
    }

    fn gear_change_begins(self, axis: AxisNumber, spindle: &Spindle) -> Condition {
        self.gear_change(axis, spindle, true)
            .after(|| self.by_program(axis, "one with M41 to M45, or M40 with S, of another gear stage"))
    }

    fn gear_change(self, axis: AxisNumber, spindle: &Spindle, wanted: bool) -> Fact {
        let changes = spindle.change.is_some();
        let what =
            format!("a program has ordered another gear stage of {}, and it is not there yet", self.axis_name(axis));
        Fact::new(what, yes(changes), yes(wanted), changes == wanted)
    }

    fn no_gear_change(self, axis: AxisNumber) -> Condition {
        let Some((own, spindle)) = self.spindle(axis) else {
            return Condition::from(self.is_spindle(axis)).opposite();
        };
        self.gear_change(axis, spindle, false).after(|| {
            let mut any = vec![self.axis(axis, axis_to_nck::gear_stage_changed, true)];
            any.extend(own.simulates_change.then(|| self.stands(axis)));
            Condition::Any(any)
        })
    }

    fn too_fast(self, axis: AxisNumber, own: &SpindleParameters, spindle: &Spindle) -> Condition {
        let stage = own.stage(spindle.gear_stage).maximum_speed;
        let limit = own.speed_limit.min(stage);
        let datum = if own.speed_limit < stage { "MD35100" } else { "MD35130" };
        let velocity = self.state.axes[axis].velocity.abs();
        let wanted = format!("above {} ({datum}) by more than {} % (MD35150)", speed(limit), own.tolerance * 100.0);
        let exceeded = velocity > limit * (1.0 + own.tolerance);
        Fact::new(format!("speed of {}", self.axis_name(axis)), speed(velocity), wanted, exceeded).into()
    }

    fn speed_control(self, axis: AxisNumber, spindle: &Spindle) -> Fact {
        fact(
            format!("{} is in speed control, not positioned and not an axis", self.axis_name(axis)),
            spindle.mode == Mode::Control,
        )
    }

    fn at_its_speed(self, axis: AxisNumber, own: &SpindleParameters, spindle: &Spindle) -> Condition {
        let found = self.state.axes[axis].turning_speed();
        let held = spindle.commanded == 0.0 && spindle.holder != Input::None;
        let wanted = if held {
            "its commanded speed: it is held (S-10)".to_owned()
        } else if spindle.commanded == 0.0 {
            format!(
                "below {} (MD36060): its commanded speed is 0",
                speed(self.parameters.axes[axis].standstill_velocity)
            )
        } else {
            format!("within {} % (MD35150) of {}", own.tolerance * 100.0, speed(spindle.commanded))
        };
        let holds = self.state.is_in_speed_range(axis, self.parameters);
        let fact = Fact::new(format!("speed of {}", self.axis_name(axis)), speed(found), wanted, holds);
        if held { fact.after(|| Condition::All(self.turns_freely(axis, spindle))) } else { fact.into() }
    }

    fn oscillation(self, axis: AxisNumber, spindle: &Spindle, wanted: bool) -> Fact {
        let oscillates = spindle.oscillates();
        Fact::new(format!("{} oscillates", self.axis_name(axis)), yes(oscillates), yes(wanted), oscillates == wanted)
    }

    /// What holds and ends an oscillation: its enable, the spindle stop, and the enables of the drive.
    fn may_oscillate(self, axis: AxisNumber) -> Vec<Condition> {
        let on = self.state.axes[axis].enabling.is_on();
        vec![
            self.axis(axis, axis_from_nck::change_gear_stage, true),
            self.axis(axis, axis_to_nck::oscillation_enable, true),
            self.axis(axis, axis_to_nck::feed_stop, false),
            fact(format!("the drive of {} is switched on", self.axis_name(axis)), on)
                .after(|| self.enables(&self.unit(axis))),
        ]
    }

    fn oscillates(self, axis: AxisNumber, spindle: &Spindle) -> Condition {
        self.oscillation(axis, spindle, true).after(|| {
            let mut all = vec![self.speed_control(axis, spindle).into()];
            if self.state.plc_oscillates(axis) {
                all.extend(self.turns_freely(axis, spindle));
            } else {
                all.extend(self.may_oscillate(axis));
            }
            all.push(self.stands(axis));
            Condition::All(all)
        })
    }

    fn oscillates_no_more(self, axis: AxisNumber) -> Condition {
        let Some((_, spindle)) = self.spindle(axis) else {
            return Condition::from(self.is_spindle(axis)).opposite();
        };
        self.oscillation(axis, spindle, false).after(|| {
            if self.state.plc_oscillates(axis) {
                let held = self.turns_freely(axis, spindle).into_iter().map(Condition::opposite);
                return Condition::Any(self.ends_of_spindle_function(axis).into_iter().chain(held).collect());
            }
            let mut any: Vec<_> = self.may_oscillate(axis).into_iter().skip(1).map(Condition::opposite).collect();
            any.push(self.no_gear_change(axis));
            Condition::Any(any)
        })
    }

    fn in_position(self, axis: AxisNumber, spindle: &Spindle) -> Condition {
        let what = format!("{} has reached the target of its positioning", self.axis_name(axis));
        fact(what, spindle.is_in_position()).after(|| {
            let target = match spindle.mode {
                Mode::Positioning(SpindlePositioning { phase: Phase::Going { target }, .. }) => Some(target),
                Mode::Positioning(_) | Mode::Control | Mode::Axis => None,
            };
            let Some(target) = target else {
                let what = format!("the target of {} is known: its zero mark was passed", self.axis_name(axis));
                return fact(what, false).into();
            };
            let setpoint = &self.state.axes[axis].setpoint;
            let there =
                fact(format!("the setpoint of {} is at the target", self.axis_name(axis)), target == setpoint.position);
            // On its way it needs nothing more.
            let there: Condition = if setpoint.is_at_rest() {
                there.after(|| Condition::All(self.turns_freely(axis, spindle)))
            } else {
                there.into()
            };
            Condition::All(vec![there, self.setpoint_rests(axis), self.deviation(axis, StopLimit::Fine)])
        })
    }

    /// Nothing holds the turning of a spindle.
    fn turns_freely(self, axis: AxisNumber, spindle: &Spindle) -> Vec<Condition> {
        let name = self.axis_name(axis);
        let on = self.state.axes[axis].enabling.is_on();
        let mut all = vec![
            self.axis(axis, axis_to_nck::feed_stop, false),
            fact(format!("NC stop axes plus spindles does not hold {name} until NC start"), !spindle.stopped).into(),
            fact(format!("the drive of {name} is switched on"), on).after(|| self.enables(&self.unit(axis))),
        ];
        if let Some((own, _)) = self.spindle(axis) {
            let factor = self.state.spindle_factor(axis, own, &self.to_nck.axes[axis]);
            all.push(self.override_of(axis, factor));
        }
        all
    }

    /// What the path of a channel waits for: the spindles, at the beginning of a block (MD35500, gear change) and with G95.
    pub(super) fn no_spindle_awaited(self, channel: ChannelNumber) -> Vec<Condition> {
        let run = self.state.programs[channel].run.as_deref();
        let (Some(run), Some(stage)) = (run, self.stage(channel)) else { return Vec::new() };
        let awaited = if run.awaits_spindles { self.state.awaited_spindle(&stage) } else { None };
        let Some((rule, _)) = awaited.or_else(|| self.state.spindle_stands(run, &stage)) else { return Vec::new() };
        let found = match rule {
            Rule::SpindleAcknowledgementAwaited => "the acknowledgement of functions of spindles",
            Rule::GearChangeAwaited => "the change of a gear stage",
            _ => "the speed of its spindles",
        };
        let what = format!("what the path of {} waits for", self.channel_name(channel));
        let mut all: Vec<Condition> = vec![Fact::new(what, found, "nothing", false).into()];
        for axis in stage.own.spindles.iter().map(|(_, axis)| *axis) {
            if let Some((data, spindle)) = self.spindle(axis).filter(|(_, spindle)| spindle.is_programmed()) {
                all.push(self.axis(axis, axis_from_nck::change_gear_stage, false));
                all.push(self.at_its_speed(axis, data, spindle));
            }
        }
        all
    }

    /// What must hold so that a spindle is to turn in a direction (request), or turns (command). `None` for an axis, also for a spindle
    /// that M70 has made one.
    pub(super) fn spindle_movement(self, unit: &Unit, direction: i8, command: bool) -> Option<Condition> {
        let axis = unit.leader();
        let (_, spindle) = self.spindle(axis)?;
        let is_free = spindle.mode == Mode::Control && !spindle.is_programmed() && spindle.jog == 0;
        if is_free && self.state.mode_groups[unit.mode_group].is_referencing() {
            // A key would begin a reference point approach, which a spindle does not have.
            return None;
        }
        let name = self.axis_name(axis);
        let oscillates = self.state.plc_oscillates(axis);
        let goes = match spindle.mode {
            Mode::Axis if !self.state.axes[axis].speed_controlled => return None,
            Mode::Axis => 0,
            Mode::Positioning(_) => self.state.axes[axis].travel.request(),
            Mode::Control if spindle.change.is_some() || oscillates => self.state.axes[axis].travel.request(),
            Mode::Control => spindle.direction_of_turning(&self.to_nck.axes[axis]),
        };
        let found = match spindle.mode {
            Mode::Axis => "M70: it becomes an axis".to_owned(),
            Mode::Positioning(_) => format!("positioned, direction {}", sign(goes)),
            Mode::Control if spindle.change.is_some() => {
                format!("its gear stage is being changed, direction {}", sign(goes))
            }
            Mode::Control if oscillates => format!("oscillates for the PLC, direction {}", sign(goes)),
            Mode::Control if spindle.jog != 0 => format!("turned by a key, direction {}", sign(goes)),
            Mode::Control => format!("M{} S{}, direction {}", spindle.direction_in_words(), spindle.speed, sign(goes)),
        };
        let wanted = format!("direction {}", sign(direction));
        let function = Fact::new(format!("function of {name}"), found, wanted, goes == direction);
        let is_busy = spindle.change.is_some() || oscillates || spindle.is_programmed();
        let may_jog = spindle.mode == Mode::Control && !is_busy;
        let mut all: Vec<Condition> = Vec::new();
        if may_jog && spindle.jog == 0 && self.state.is_jogging(unit) {
            // Only a rising edge starts it.
            let rises = self.rises(Place::Axis(axis), key_signal(direction), spindle.key_was == direction);
            let by_key = Condition::All(vec![self.not_stopped(unit.channel), rises, self.key(axis, direction)]);
            all.push(Condition::Any(vec![function.into(), by_key]));
        } else {
            all.push(function.into());
        }
        if spindle.jog != 0 {
            all.extend([self.only_jog(unit.mode_group), self.not_stopped(unit.channel), self.key(axis, direction)]);
        }
        if command && self.parameters.command_only_in_motion {
            all.extend(self.turns_freely(axis, spindle));
        }
        Some(Condition::All(all))
    }
}
