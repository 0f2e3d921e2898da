//! Conditions of the signals of a channel: its program, and its error state.

use super::look::{Look, Row, of_axis, of_channel};
use crate::control::{Condition, Fact, fact, yes};
use crate::isg::channel::{Channel, Task, Wait};
use crate::isg::hli::{axis_from_cnc, channel_from_cnc, channel_to_cnc};
use crate::units::AxisNumber;
use crate::variables::{Place, place_name};

/// The signals of a channel, by its place in the list of channels.
pub(super) const ROWS: &[Row<usize>] = &[
    Row::with(
        channel_from_cnc::program_active,
        |look, index| look.program_starts(&look.state.channels[index]),
        |look, index| look.program_ends(&look.state.channels[index]),
    ),
    Row::with(
        channel_from_cnc::program_completed,
        |look, index| look.completed(&look.state.channels[index]),
        |look, index| look.completed_no_more(&look.state.channels[index]),
    ),
    Row::with(
        channel_from_cnc::error,
        |look, index| look.channel_error(&look.state.channels[index]),
        |look, index| look.no_channel_error(&look.state.channels[index]),
    ),
];

impl Look<'_> {
    fn channel(self, channel: &Channel) -> String {
        place_name(Place::Channel(channel.number), self.names)
    }

    fn program_runs(self, channel: &Channel, wanted: bool) -> Fact {
        let runs = channel.is_active();
        Fact::new(format!("a program runs in {}", self.channel(channel)), yes(runs), yes(wanted), runs == wanted)
    }

    /// NC start: a rising edge, a selected program, no error.
    fn program_starts(self, channel: &Channel) -> Condition {
        self.program_runs(channel, true).after(|| {
            let selected = channel.selected.clone();
            let what = format!("program selected in {}", self.channel(channel));
            let is_selected = selected.is_some();
            Condition::All(vec![
                Fact::new(what, selected.unwrap_or_else(|| "none".to_owned()), "one", is_selected).into(),
                of_channel(channel.number, channel_from_cnc::error, false),
                of_channel(channel.number, channel_to_cnc::start, true),
                fact(format!("{}.start was 0 before", self.channel(channel)), !channel.inputs.start).into(),
            ])
        })
    }

    fn program_ends(self, channel: &Channel) -> Condition {
        self.program_runs(channel, false).after(|| self.reaches_end(channel))
    }

    /// What a program waits for.
    fn reaches_end(self, channel: &Channel) -> Condition {
        let name = self.channel(channel);
        let mut all = vec![of_channel(channel.number, channel_to_cnc::feed_hold, false)];
        if channel.inputs.feed_override == 0 {
            all.push(Fact::new(format!("feed override of {name}"), "0", "above 0", false).into());
        }
        if channel.task == Task::Stands {
            all.push(of_channel(channel.number, channel_to_cnc::start, true));
            all.push(fact(format!("{name}.start was 0 before"), !channel.inputs.start).into());
        }
        let homing: Vec<AxisNumber> = match &channel.wait {
            Wait::Homing(job) => self.state.homing_now(job),
            Wait::Nothing | Wait::Dwell(_) => Vec::new(),
        };
        let moving = channel.path_axes.iter().filter(|axis| channel.moves(**axis));
        let mut axes: Vec<AxisNumber> = moving.flat_map(|axis| self.state.coupled_with(*axis)).chain(homing).collect();
        axes.sort_unstable();
        axes.dedup();
        for axis in axes {
            all.push(of_axis(axis, axis_from_cnc::feed_enable_state, true));
            all.push(of_axis(axis, axis_from_cnc::drive_ready, true));
            if self.state.is_clearing(axis) {
                let what = format!("gantry difference of {}", self.axis(axis));
                all.push(Fact::new(what, "is being cleared", "cleared", false).into());
            }
        }
        let what = format!("block of the program in {name}");
        all.push(Fact::new(what, format!("N{}", channel.block()), "its end", false).into());
        Condition::All(all)
    }

    fn completed(self, channel: &Channel) -> Condition {
        let what = format!("the last program in {} has reached its end", self.channel(channel));
        fact(what, channel.completed).after(|| {
            if channel.is_active() {
                self.reaches_end(channel)
            } else {
                of_channel(channel.number, channel_from_cnc::program_active, true)
            }
        })
    }

    fn completed_no_more(self, channel: &Channel) -> Condition {
        let what = format!("the last program in {} has reached its end", self.channel(channel));
        let over = Fact::new(what, yes(channel.completed), "no", !channel.completed);
        over.after(|| self.program_starts(channel))
    }

    fn error_state(self, channel: &Channel, wanted: bool) -> Fact {
        let words = |is| if is { "one" } else { "none" };
        let what = format!("error of {}", self.channel(channel));
        Fact::new(what, words(channel.error), words(wanted), channel.error == wanted)
    }

    fn channel_error(self, channel: &Channel) -> Condition {
        self.error_state(channel, true).after(|| {
            let what = format!("message that ends a program of {}, or error of one of its axes", self.channel(channel));
            Fact::new(what, "none new", "a new one", false).into()
        })
    }

    fn no_channel_error(self, channel: &Channel) -> Condition {
        self.error_state(channel, false).after(|| {
            let members = channel.axes.iter().filter(|member| self.state.axes[member.axis].error.is_some());
            let mut all: Vec<Condition> = members.flat_map(|member| self.cleared_by_reset(member.axis)).collect();
            all.push(self.reset(channel));
            Condition::All(all)
        })
    }

    /// A reset clears when the axes stand.
    pub(super) fn reset(self, channel: &Channel) -> Condition {
        if channel.resets {
            let mut all: Vec<Condition> = channel.axes.iter().map(|member| self.rests(member.axis)).collect();
            all.push(self.program_runs(channel, false).into());
            return Condition::All(all);
        }
        Condition::All(vec![
            of_channel(channel.number, channel_to_cnc::reset, true),
            fact(format!("{}.reset was 0 before", self.channel(channel)), !channel.inputs.reset).into(),
        ])
    }
}
