//! What a check of causes compares and no row of a trace shows: the bytes that the control read, where these are older than those that the
//! PLC wrote (O-28), and the values of the axes that causes name. The owner of a trace asks for it, because it costs time in every cycle.

use crate::image::{Format, Location, Memory, Part, PartBytes};
use crate::units::{AxisNumber, PerAxis, Position, Time};
use crate::variables::{AxisValues, Event, EventId, Input, Quantity, Variables};

/// The measured data of a trace.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    /// The values of the axes after the last cycle.
    last: PerAxis<AxisValues>,
    /// The number of events that were looked at.
    events: usize,
    axes: Vec<AxisRow>,
    /// Present if the control reads the PLC's half later than it is written.
    late: Option<Late>,
}

/// The values of an axis that a cause names.
#[derive(Clone, Copy, Debug)]
struct AxisRow {
    event: EventId,
    cycle: u64,
    axis: AxisNumber,
    /// After the cycle before, and after this cycle.
    values: [AxisValues; 2],
}

/// The PLC's half as the control reads it.
#[derive(Clone, Debug)]
struct Late {
    start: PartBytes,
    last: PartBytes,
    /// The changed bytes in order of time: cycle, byte and value.
    rows: Vec<(u64, u32, u8)>,
}

impl Late {
    fn note(&mut self, cycle: u64, read: &PartBytes) {
        let changed = self.last.iter().zip(read.iter()).enumerate().filter(|(_, (old, new))| old != new);
        self.rows.extend(changed.map(|(offset, (_, new))| (cycle, u32::try_from(offset).unwrap_or(u32::MAX), *new)));
        self.last.copy_from_slice(read);
    }
}

impl Measured {
    /// Nothing yet; `events` are in the trace already, and `read` is the PLC's half as the control reads it, if it reads it later than it is
    /// written.
    pub(super) fn begin(events: usize, variables: &Variables, read: Option<&PartBytes>) -> Self {
        let late = read.map(|read| Late { start: read.clone(), last: read.clone(), rows: Vec::new() });
        Self { last: variables.axes, events, axes: Vec::new(), late }
    }

    /// Measures after a cycle; its events are in the trace.
    pub(super) fn measure(&mut self, cycle: u64, events: &[Event], variables: &Variables, read: Option<&PartBytes>) {
        if let (Some(late), Some(read)) = (&mut self.late, read) {
            late.note(cycle, read);
        }
        for event in &events[self.events..] {
            for input in event.inputs {
                if let Input::Length(_, axis, _) = input
                    && event.cycle == cycle
                {
                    let values = [self.last[axis], variables.axes[axis]];
                    self.axes.push(AxisRow { event: event.id, cycle, axis, values });
                }
            }
        }
        self.events = events.len();
        self.last = variables.axes;
    }

    /// Follows the PLC's half as the control reads it, from the start of the trace with this memory.
    pub(super) fn read_late(&self, start: &Memory) -> Option<ReadLate<'_>> {
        let late = self.late.as_ref()?;
        let mut memory = start.clone();
        memory.to_nck.copy_from_slice(&late.start);
        Some(ReadLate { memory, rows: &late.rows })
    }

    /// The values of an axis that an event of this cycle names: after the cycle before, and after the cycle. `None` if they were not
    /// measured.
    pub(super) fn values(&self, event: EventId, cycle: u64, axis: AxisNumber) -> Option<[AxisValues; 2]> {
        let first = self.axes.partition_point(|row| row.cycle < cycle);
        let mut of_cycle = self.axes[first..].iter().take_while(|row| row.cycle == cycle);
        of_cycle.find(|row| (row.event, row.axis) == (event, axis)).map(|row| row.values)
    }
}

/// The location of a whole byte.
pub(super) const fn byte(part: Part, offset: u32) -> Location {
    Location { part, offset, bit: 0, width: 8, format: Format::Unsigned }
}

/// The memory with the PLC's half as the control reads it.
pub(super) struct ReadLate<'a> {
    memory: Memory,
    rows: &'a [(u64, u32, u8)],
}

impl ReadLate<'_> {
    /// The memory in this cycle. Cycles must be asked for in their order.
    pub(super) fn at(&mut self, cycle: u64) -> &Memory {
        let count = self.rows.partition_point(|row| row.0 <= cycle);
        let (now, later) = self.rows.split_at(count);
        for &(_, offset, value) in now {
            self.memory.write(byte(Part::ToNck, offset), value.into());
        }
        self.rows = later;
        &self.memory
    }
}

/// A value that a cause may name, and how far from it the cause may be, in the unit of the cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Possible {
    pub(super) value: f64,
    tolerance: f64,
}

impl Possible {
    /// Whether a cause may name this value.
    pub(super) fn is(self, named: f64) -> bool {
        (self.value - named).abs() <= self.tolerance
    }
}

/// The values that a cause of a cycle may name for a quantity, the likeliest first: the control decides with the values of the cycle before,
/// and monitors and publishes with those of the cycle. `None` if no value of the axis shows the quantity. `per_turn` is the distance that a
/// unit of the displayed velocity stands for (rev/min: 360 degrees), `half_count` that of the coarsest encoder, `cycle` the length of the cycle.
pub(super) fn possible(
    quantity: Quantity,
    values: [AxisValues; 2],
    per_turn: f64,
    half_count: Position,
    cycle: Time,
) -> Option<Vec<Possible>> {
    // Lengths are whole increments, and causes show each of them.
    let length = |value: f64| Possible { value, tolerance: INCREMENT / 2.0 };
    let [before, now] = values;
    let both = [now, before];
    Some(match quantity {
        Quantity::SynchronismDifference => both.map(|values| length(values.synchronism_difference.user())).to_vec(),
        Quantity::Position => both.map(|values| length(values.position.user())).to_vec(),
        Quantity::Setpoint => both.map(|values| length(values.setpoint.user())).to_vec(),
        Quantity::Target => both.map(|values| length((values.setpoint + values.distance_to_go).user())).to_vec(),
        Quantity::ZeroMark => {
            // On the way of the cycle, of the one before, or of the next one. The mark is not a whole count, and each end of the way is off by
            // up to half a count: the way by two halves, so 1.5 ways by three, and their middle by one.
            let (from, to) = (before.position.user(), now.position.user());
            let tolerance = 1.5 * (to - from).abs() + 4.0 * half_count.user() + INCREMENT;
            vec![Possible { value: f64::midpoint(from, to), tolerance }]
        }
        Quantity::Deviation => {
            let of = |values: AxisValues| {
                let [first, second] = values.encoders;
                let deviation = values.following_error.user();
                [deviation, -deviation, (first - second).abs().user()].map(length)
            };
            both.into_iter().flat_map(of).collect()
        }
        Quantity::Velocity => {
            // Events contain whole increments per second.
            let measured =
                |values: AxisValues| Possible { value: values.velocity, tolerance: INCREMENT * 60.0 / per_turn };
            // The velocity of the setpoint, whose ends are each rounded to half an increment.
            let moved = (now.setpoint - before.setpoint).user() * 60.0 / cycle.seconds() / per_turn;
            let setpoint =
                Possible { value: moved, tolerance: INCREMENT * 60.0 * (1.0 + 1.0 / cycle.seconds()) / per_turn };
            both.map(measured).into_iter().chain([setpoint]).collect()
        }
        Quantity::SetpointCompensation => both.map(|values| length(values.setpoint_compensation.user())).to_vec(),
        Quantity::Base
        | Quantity::Sag
        | Quantity::Distance
        | Quantity::VelocityCommand
        | Quantity::ModelDeviation
        | Quantity::ZeroMarkDeviation => return None,
    })
}

/// One increment, in mm or degrees.
const INCREMENT: f64 = 1e-6;
