//! `#GANTRY`, `#CALL AX` and `#PUT AX`: combinations that a program opens, and axes that it takes and returns (HG-14 to HG-16, SG-25).

use super::channel::Member;
use super::language::{AxisReference, AxisRequest, Conflicts, GantryTargets, PutTargets};
use super::messages;
use super::pending::Detail;
use super::refused::Refused;
use super::refused::value;
use super::rules::Why;
use super::state::{AxesView, State};
use crate::units::AxisNumber;
use crate::variables::{EventId, Place};

impl State {
    /// `#GANTRY ON` and `#GANTRY OFF`.
    pub(super) fn switch_gantry(
        &mut self,
        index: usize,
        on: bool,
        targets: &GantryTargets,
        cause: EventId,
    ) -> Result<(), Refused> {
        let combinations: Vec<usize> = match targets {
            GantryTargets::All => (0..self.combinations.len()).collect(),
            GantryTargets::Masters(masters) => {
                masters.iter().map(|master| self.combination_named(index, master)).collect::<Result<_, _>>()?
            }
        };
        for combination in &combinations {
            let one = &self.combinations[*combination];
            if !self.is_config(*combination) {
                return Err(Refused::axis(messages::NOT_CONFIG, one.coupling.leader()));
            }
            if let Some(axis) = one.coupling.members().find(|axis| self.is_moving(*axis)) {
                return Err(Refused::axis(messages::NOT_AT_STANDSTILL, axis));
            }
            let in_group = |axis: &AxisNumber| self.channels.iter().any(|channel| channel.is_in_group(*axis));
            if on && let Some(axis) = one.coupling.followers().find(in_group) {
                return Err(self.coupled(axis));
            }
        }
        for combination in combinations {
            if self.combinations[combination].coupling.is_open() == on {
                self.switch_combination(combination, on, cause);
            }
        }
        Ok(())
    }

    /// An axis of an active coupling group cannot be taken or given away.
    fn coupled(&self, axis: AxisNumber) -> Refused {
        let number = self.axes[axis].parameters.number;
        value(&format!("axis {number} is coupled in an active coupling group"))
    }

    /// Whether an axis moves, or has a movement that is held.
    fn is_moving(&self, axis: AxisNumber) -> bool {
        !self.axes[axis].setpoint.is_at_rest() || self.channels.iter().any(|channel| channel.moves(axis))
    }

    fn switch_combination(&mut self, combination: usize, on: bool, cause: EventId) {
        let why = if on { Why::CombinationOn } else { Why::CombinationOff };
        let leader = self.combinations[combination].coupling.leader();
        let event = self.log.note_plain(Place::Axis(leader), why, cause);
        let slaves: Vec<AxisNumber> = self.combinations[combination].coupling.followers().collect();
        for member in slaves.iter().chain([&leader]) {
            self.axes[*member].causes.coupled = event;
        }
        if on {
            // HG-16: slaves that are still in a channel are released.
            for channel in &mut self.channels {
                channel.axes.retain(|member| !slaves.contains(&member.axis));
            }
        }
        let view = AxesView(&self.axes);
        let one = &mut self.combinations[combination];
        one.cause = event;
        if on {
            one.coupling.close(&view);
            one.coupling.settle(true);
        } else {
            one.coupling.release(&view);
        }
    }

    /// The combination of a master: by name if the master is in this channel, by number wherever it is (HG-19).
    fn combination_named(&self, index: usize, master: &AxisReference) -> Result<usize, Refused> {
        let axis = match master {
            AxisReference::Name(name) => self.channels[index].axis_named(name),
            AxisReference::Number(number) => u16::try_from(*number).ok().and_then(|number| self.axis_of(number)),
        };
        let found = axis.and_then(|axis| self.combinations.iter().position(|one| one.coupling.leader() == axis));
        found.ok_or_else(|| Refused(messages::GANTRY_UNKNOWN, Detail::Text(master.bare()), Detail::None))
    }

    /// `#CALL AX`: all requests are checked before one acts.
    pub(super) fn call_axes(&mut self, index: usize, _: Conflicts, requests: &[AxisRequest]) -> Result<(), Refused> {
        let mut wanted: Vec<Member> = Vec::new();
        for (place, request) in requests.iter().enumerate() {
            let before = &requests[..place];
            if before.iter().any(|other| other.name == request.name) {
                return Err(value(&format!("the name {} is given twice", request.name)));
            }
            if before.iter().any(|other| other.number == request.number) {
                return Err(value(&format!("axis {} is given twice", request.number)));
            }
            if before.iter().any(|other| other.index == request.index) {
                return Err(Refused::group(messages::INDEX_TWICE, request.index.into()));
            }
            let number = u16::try_from(request.number).ok();
            let axis = number.and_then(|number| self.axis_of(number));
            let axis = axis.ok_or_else(|| {
                let text = format!("no axis has the logical number {}", request.number);
                Refused(messages::AXIS_UNKNOWN, Detail::Text(text), Detail::None)
            })?;
            let channel = &self.channels[index];
            if channel.axes.iter().any(|member| member.axis == axis) {
                continue;
            }
            if self.is_coupled_slave(axis) {
                let text = format!("#CALL AX or #AX REQUEST of axis {}", request.number);
                return Err(Refused(messages::SLAVE_IN_CHANNEL, Detail::Axis(axis), Detail::Text(text)));
            }
            if self.channels.iter().any(|other| other.axes.iter().any(|member| member.axis == axis)) {
                return Err(value(&format!("axis {} is an axis of another channel", request.number)));
            }
            if channel.axis_named(&request.name).is_some() {
                return Err(value(&format!("the channel has an axis {} already", request.name)));
            }
            let place = u16::try_from(request.index).ok().filter(|place| *place < INDICES);
            let place = place
                .ok_or_else(|| value(&format!("a channel index is 0 to {}, found {}", INDICES - 1, request.index)))?;
            if channel.axes.iter().any(|member| member.index == place) {
                return Err(Refused::group(messages::INDEX_OCCUPIED, place.into()));
            }
            wanted.push(Member { index: place, name: request.name.clone(), axis });
        }
        let channel = &mut self.channels[index];
        channel.axes.extend(wanted);
        channel.axes.sort_by_key(|member| member.index);
        Ok(())
    }

    /// `#PUT AX`: axes that are not there are no error.
    pub(super) fn put_axes(&mut self, index: usize, targets: &PutTargets) -> Result<(), Refused> {
        let channel = &self.channels[index];
        let put: Vec<AxisNumber> = match targets {
            PutTargets::All => channel.axes.iter().map(|member| member.axis).collect(),
            PutTargets::Names(names) => names.iter().filter_map(|name| channel.axis_named(name)).collect(),
            PutTargets::Numbers(numbers) => numbers
                .iter()
                .filter_map(|number| self.axis_of(u16::try_from(*number).ok()?))
                .filter(|axis| channel.index_of(*axis).is_some())
                .collect(),
        };
        if let Some(axis) = put.iter().copied().find(|axis| channel.is_in_group(*axis)) {
            return Err(self.coupled(axis));
        }
        self.channels[index].axes.retain(|member| !put.contains(&member.axis));
        Ok(())
    }
}

/// Axes of a channel: indices 0 to 31.
const INDICES: u16 = 32;
