//! Preparation: reads blocks ahead of the movement, and turns each into what is executed.

use crate::image::ToNck;
use crate::motion::path::{Feed, PathBlock, PerPathAxis, Way};
use crate::nc_program::{Action, AxisIndex, Block, Prepared, ProgramAlarm, g, groups};
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::exchange::programs::{Availability, availability, exchanges};
use crate::sinumerik::exchange::state::Owners;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::environment::Channel;
use crate::sinumerik::program::executable::{Criterion, Executable, ReadBlock, StateBehind};
use crate::sinumerik::program::geometry::{self, BadCircle};
use crate::sinumerik::program::state::{BlockAlarm, Preparation, Run, block_name};
use crate::units::{AxisNumber, AxisSet, ChannelNumber, PerAxis, Position};
use crate::variables::{AlarmNumber, Parameter, short_text};

/// The blocks that are prepared ahead.
const AHEAD: usize = 80;

/// Blocks that only calculate in one call of the preparation.
const CALCULATIONS: usize = 100;

/// The farthest position of an axis, in increments: 1,000 km. Positions beyond it have no meaning, and their sums would not fit.
const FARTHEST: f64 = 1e9 * Position::PER_USER_UNIT;

/// A function of the control that OpenNCK does not have.
pub(super) const NOT_ACTIVE: AlarmNumber = AlarmNumber(12553);
/// A spindle that the channel does not have.
pub(super) const NO_SPINDLE: AlarmNumber = AlarmNumber(16100);

/// What the preparation of a block reads.
pub(in crate::sinumerik) struct Preparing<'a> {
    pub parameters: &'a Parameters,
    pub own: &'a ProgramParameters,
    pub axes: &'a PerAxis<Axis>,
    pub owners: &'a Owners,
    pub channel: ChannelNumber,
    pub to_nck: &'a ToNck,
    /// The axes of open gantry groupings.
    pub open: AxisSet,
    /// What takes effect when preparation has waited until everything was executed: skip levels (MD10706 = 2), dry run (MD10704 = 2).
    pub at_stop: (Option<u16>, Option<bool>),
    /// DB21.DBX0.4 with type 2 (SBL2): calculation blocks are blocks, and nothing is prepared behind a stop.
    pub stops_after_calculations: bool,
}

impl Run {
    /// Reads blocks until the buffer is full, or the next one waits, ends or fails.
    pub(in crate::sinumerik) fn prepare(&mut self, preparing: &Preparing<'_>, channel: &mut Channel<'_>) {
        let mut calculations = 0;
        while self.queue.len() < AHEAD && !self.pauses {
            if matches!(self.preparation, Preparation::Failed { .. }) {
                return;
            }
            if self.is_executed() && !self.search.as_ref().is_some_and(|search| search.calculates()) {
                self.begin_where_axes_are(preparing);
            }
            self.holds_preparation &= !self.is_executed();
            if self.holds_preparation {
                return;
            }
            if self.stops_preparation(preparing.stops_after_calculations) {
                return;
            }
            if let Some(read) = self.again.pop_front() {
                self.take_block(read, preparing, channel);
                continue;
            }
            match &self.preparation {
                Preparation::Reads => {}
                Preparation::Waits if self.is_executed() => {
                    self.preparation = Preparation::Reads;
                    self.skips = preparing.at_stop.0.unwrap_or(self.skips);
                    self.dry_run = preparing.at_stop.1.unwrap_or(self.dry_run);
                    channel.skips = self.skips;
                }
                Preparation::Waits | Preparation::Ended | Preparation::Failed { .. } => return,
            }
            channel.take_run(self);
            let written = channel.written.len() + channel.tables.len();
            let next = self.executed + self.queue.len() as u64;
            if self.interpreter.modal().agrees(&preparing.own.modal, groups::FEED) {
                // SD42110 takes effect at once.
                self.interpreter.assume_feed(preparing.own.initial_feed());
            }
            let before = self.interpreter.clone();
            let prepared = self.interpreter.step(channel);
            self.r_log.extend(channel.r_written.drain(..).map(|(index, before)| (next, index, before)));
            // Written data act on the next block: they become effective at the end of the stage.
            self.pauses |= channel.written.len() + channel.tables.len() > written;
            match prepared {
                Ok(Prepared::Block(block)) => {
                    let behind = self.behind_now();
                    self.take_block(Box::new(ReadBlock { block: *block, before, behind }), preparing, channel);
                }
                Ok(Prepared::Calculated(origin)) if preparing.stops_after_calculations => {
                    let modal = self.interpreter.modal();
                    let calculation = Some(Box::new(self.behind_now()));
                    let done = Executable { is_executable: true, calculation, ..Executable::new(origin, modal) };
                    self.queue.push_back(done);
                }
                Ok(Prepared::Calculated(_)) => {
                    // An endless calculation does not hold the channel: it goes on in the next cycle.
                    calculations += 1;
                    self.pauses |= calculations >= CALCULATIONS;
                }
                Ok(Prepared::Before(origin)) if self.search.is_some() => {
                    let modal = self.interpreter.modal();
                    self.queue.push_back(Executable { stands_before: true, ..Executable::new(origin, modal) });
                }
                // A search that is over.
                Ok(Prepared::Before(_)) => {}
                Ok(Prepared::Waits(_)) => {
                    self.preparation = Preparation::Waits;
                    // It waits for POSA.
                    self.pauses |= self.is_executed();
                }
                Ok(Prepared::Ended) => self.preparation = Preparation::Ended,
                Err(alarm) => self.fail(&alarm),
            }
        }
    }

    /// The state of preparation now.
    pub(in crate::sinumerik) fn behind_now(&self) -> StateBehind {
        StateBehind {
            interpreter: self.interpreter.clone(),
            axis_feeds: self.axis_feeds.clone(),
            path_override: self.path_override,
            programmed_on_path: self.programmed_on_path,
            offsets: self.offsets,
            counted: self.counted,
            end: self.end,
        }
    }

    /// Whether nothing is prepared behind the last block yet: it is the target of a search, or single block type 2 stops behind it.
    fn stops_preparation(&self, is_single: bool) -> bool {
        let Some(last) = self.queue.back() else { return false };
        let is_target = self.search.as_ref().is_some_and(|search| search.is_target(&last.origin));
        is_target || is_single && !last.origin.is_single_block_off
    }

    fn fail(&mut self, alarm: &ProgramAlarm) {
        let place = (alarm.program.clone(), alarm.line);
        let reason = alarm.reason.clone();
        self.preparation = Preparation::Failed { alarm: BlockAlarm::of(alarm), reason, place, block: None };
    }

    /// A block with an alarm is prepared again as it was read.
    fn put_back_failed(&mut self) {
        if let Preparation::Failed { block, .. } = &mut self.preparation {
            if let Some(block) = block.take() {
                self.again.push_front(block);
            }
            self.preparation = Preparation::Reads;
        }
    }

    /// The blocks behind the first one are prepared again, from where its axes are now.
    pub(in crate::sinumerik) fn reorganise(&mut self, position: PerPathAxis) {
        self.reorganise_behind(1, position);
    }

    /// The blocks behind these are prepared again, from these positions.
    pub(in crate::sinumerik) fn reorganise_behind(&mut self, count: usize, position: PerPathAxis) {
        self.put_back_failed();
        while self.queue.len() > count {
            if let Some(block) = self.queue.pop_back().and_then(|one| one.block) {
                self.again.push_front(block);
            }
        }
        let behind = self.queue.back().and_then(Executable::behind).unwrap_or(&self.behind);
        (self.programmed_on_path, self.offsets, self.counted) =
            (behind.programmed_on_path, behind.offsets, behind.counted);
        self.end = position;
    }

    fn take_block(&mut self, mut read: Box<ReadBlock>, preparing: &Preparing<'_>, channel: &mut Channel<'_>) {
        // A search only calculates: it takes no axes.
        let calculates = self.search.as_ref().is_some_and(|search| search.calculates());
        let available =
            availability(&read.block, preparing.channel, preparing.own, preparing.owners, preparing.parameters);
        match available {
            Availability::Claims(claim) if !calculates => {
                // Once everything before it has been executed, the channel gets them.
                self.again.push_front(read);
                (self.claim, self.pauses) = (Some(claim), true);
                return;
            }
            Availability::Refused(alarm) if !calculates => {
                self.preparation = Preparation::failed(alarm, read);
                return;
            }
            Availability::All | Availability::Claims(_) | Availability::Refused(_) => {}
        }
        // Blocks behind it may find other axes, or find them elsewhere.
        let activates = read.block.actions.iter().any(|action| matches!(action, Action::NewConfiguration));
        let waits = exchanges(&read.block) || preparing.own.waits_behind(&read.block) || activates;
        self.holds_preparation = waits && !calculates;
        let (mut end, offsets) = (self.end, self.offsets);
        match preparing.executable(&read.block, self, &mut end, channel) {
            Ok(executable) => {
                self.end = end;
                (read.behind.end, read.behind.axis_feeds) = (end, self.axis_feeds.clone());
                (read.behind.path_override, read.behind.programmed_on_path) =
                    (self.path_override, self.programmed_on_path);
                (read.behind.offsets, read.behind.counted) = (self.offsets, self.counted);
                self.queue.push_back(Executable { block: Some(read), ..executable });
            }
            Err(alarm) => {
                // What is prepared again behind it stays for later.
                self.preparation = Preparation::failed(alarm, read);
                self.offsets = offsets;
            }
        }
    }
}

impl Preparing<'_> {
    fn executable(
        &self,
        block: &Block,
        run: &mut Run,
        end: &mut PerPathAxis,
        channel: &mut Channel<'_>,
    ) -> Result<Executable, BlockAlarm> {
        let mut done = Executable::new(block.origin.clone(), block.modal);
        done.is_executable = block.is_executable();
        done.end = block.end;
        done.criterion = Criterion::of(block.modal);
        if geometry::is_per_revolution(block) && !block.axes.is_empty() {
            self.known_spindle(block, 0)?;
        }
        if let Some(number) = self.unknown_spindle(block) {
            return Err(alarm(block, NO_SPINDLE, Parameter::Text(short_text(&number.to_string()))));
        }
        self.take_actions(block, run, end, &mut done, channel)?;
        let start = *end;
        for word in &block.axes {
            let (axis, place) = self.path_axis(block, word.axis)?;
            end[place] = self.target(block, word, (axis, place), start[place], run, channel);
            self.check_position(block, word.axis, end[place])?;
            run.programmed_on_path.set(axis, true);
        }
        let turns =
            (block.modal.is(g::G2) || block.modal.is(g::G3)) && (!block.axes.is_empty() || !block.circle.is_empty());
        let way = if turns {
            let offset = |place: usize| self.offset(block, self.own.axes.path[place], channel);
            let way = geometry::arc(block, (self.own, run.counted), start, *end, offset)
                .map_err(|bad| bad_circle(block, bad))?;
            *end = way.end();
            Some(way)
        } else if block.axes.is_empty() {
            None
        } else {
            Some(Way::line(start, *end, run.counted))
        };
        if let Some(way) = &way {
            self.check_limits(block, way, &start, end)?;
        }
        for function in &block.auxiliary {
            run.note_spindle_function(function, self.own);
        }
        self.take_outputs(block, way.is_some_and(|way| way.length() >= 0.5), &mut done)?;
        let exact_stop = geometry::is_exact_stop(block) || !done.outputs[2].is_empty();
        if exact_stop && geometry::is_rapid(block) && !self.own.rapid_is_linear {
            self.go_separately(&start, end, &mut done);
        } else if let Some(way) = way.filter(|way| way.length() >= 0.5) {
            run.numbers += 1;
            let feed = self.feed(block, run.path_override);
            done.way = Some(PathBlock { number: run.numbers, way, feed, exact_stop });
        }
        Ok(done)
    }

    fn feed(&self, block: &Block, path_override: f64) -> Feed {
        // The feed of one revolution in a second.
        let per_minute = if geometry::is_per_revolution(block) { 60.0 } else { 1.0 };
        let own = block.actions.iter().find_map(|action| match action {
            Action::PathHandwheelFeed(feed) => Some(*feed),
            _ => None,
        });
        let feed = own.or(block.feed).map(|feed| geometry::feed(feed * per_minute, block, self.parameters.is_inch));
        match feed {
            Some(feed) if !geometry::is_rapid(block) => Feed::Programmed(feed * path_override),
            Some(_) | None => Feed::Rapid,
        }
    }

    /// The machine axis of a name, which must be one of the path.
    pub(super) fn path_axis(&self, block: &Block, name: AxisIndex) -> Result<(AxisNumber, usize), BlockAlarm> {
        let axes = &self.own.axes;
        let axis = axes.machine_axes.get(usize::from(name.0)).copied();
        let found = axis.and_then(|axis| Some((axis, axes.place(axis)?)));
        // A synchronous axis moves only with its leading axis (O-06, E-15).
        found.ok_or_else(|| alarm(block, alarms::WRONG_AXIS_TYPE, self.name(name)))
    }

    /// 14088: a position that is too far away to be one.
    pub(super) fn check_position(&self, block: &Block, name: AxisIndex, position: f64) -> Result<(), BlockAlarm> {
        if position.abs() <= FARTHEST {
            return Ok(());
        }
        Err(alarm(block, alarms::POSITION_TOO_LARGE, self.name(name)))
    }

    pub(super) fn name(&self, name: AxisIndex) -> Parameter {
        Parameter::Text(short_text(self.own.axes.names.name(name)))
    }
}

/// `%2`: the block.
pub(super) fn block_parameter(block: &Block) -> Parameter {
    Parameter::Text(short_text(&block.origin.name))
}

/// An alarm with `%2` the block and `%3` what is wrong.
pub(super) fn alarm(block: &Block, number: AlarmNumber, third: Parameter) -> BlockAlarm {
    let parameters = [block_parameter(block), third, Parameter::None];
    BlockAlarm { number, parameters, block: block_name(&block.origin.name) }
}

fn bad_circle(block: &Block, bad: BadCircle) -> BlockAlarm {
    match bad {
        BadCircle::EndPoint => alarm(block, alarms::CIRCLE_END, Parameter::None),
        BadCircle::Radius => alarm(block, alarms::CIRCLE_RADIUS, Parameter::None),
        BadCircle::NoPlane => alarm(block, AlarmNumber(12110), Parameter::None),
    }
}
