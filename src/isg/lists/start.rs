//! THE START-UP CHECKS in their order: ranges of each axis, masters and slaves, values that slaves take from masters, P-AXIS-00704 with
//! P-AXIS-00261, channels, names (isg.md 2.2).
//!
//! The control calls [`Lists::start`] at power on and after each restart, and [`Lists::update`] after changes at run time. Both compute
//! from the entries that the control adopted, so that an update gives the same values as a start, except of those entries that wait for a
//! start (HG-02).

use std::collections::{BTreeMap, BTreeSet};

use crate::source::Problem;

use super::channels::{self, Known};
use super::coupling::{Drafts, adopt, masters};
use super::draft::Draft;
use super::list::{AXIS_NUMBER, Lists};
use super::message::{Code, ERROR, Message};
use super::names::{self, DEFAULT_NAME};
use super::parameter::Key;
use super::ranges::{
    self, A_EMERGENCY, A_MAX, A_REF, CORRECTION_VELOCITY, FIRST_LIMIT, HOMING, HOMINGS, KIND, LINEAR, LOWER, ON_MODE,
    ON_MODES, ROTARY, SECOND_LIMIT, UPPER, is_master, is_modulo, is_slave, is_spindle,
};
use super::state::{Axis, AxisKind, Homing, Limits, OnMode, Started};

impl Lists {
    /// Starts the controller: all entries are adopted and checked.
    pub fn start(&mut self) -> Started {
        self.adopt_all();
        self.update()
    }

    /// The values in effect now: those of the last start, and the entries that updates at run time changed and that do not wait for a
    /// start. The messages are those of a start with these entries.
    #[must_use]
    pub fn update(&self) -> Started {
        let mut messages = self.numbers();
        let mut axes = self.checked(&mut messages);
        let masters = masters(&mut axes, &mut messages);
        adopt(&mut axes, &masters, &mut messages);
        for axis in axes.values_mut() {
            ranges::edge(axis, &mut messages);
        }
        let mut named = Vec::new();
        let own_names = names::check(&mut axes, &self.aliased(), &mut named);
        let known =
            |axis: &Draft<'_>| Known { is_slave: is_slave(axis), default_name: axis.word(DEFAULT_NAME).to_owned() };
        let known: BTreeMap<u16, Known> = axes.iter().map(|(number, axis)| (*number, known(axis))).collect();
        let mut owners = BTreeMap::new();
        let channels =
            self.channels.iter().map(|list| channels::check(list, &known, &mut owners, &mut messages)).collect();
        messages.append(&mut named);
        let homing_given = |axis: &Draft<'_>| {
            let master = masters.get(&axis.number()).and_then(|master| self.axis(*master));
            master.unwrap_or(axis.list).active.contains_key(&HOMING)
        };
        let axes = axes.iter().map(|(number, axis)| {
            let mut made = made(axis);
            made.master = masters.get(number).copied();
            made.has_own_name = own_names.contains(number);
            made.is_homing_given = homing_given(axis);
            made
        });
        Started { axes: axes.collect(), channels, messages }
    }

    /// The limits of an axis that becomes the slave of a pair with gantry monitoring and without printed limits, and the messages about
    /// its list; `None` if there is no such axis.
    #[must_use]
    pub fn gantry_pair(&self, slave: u16) -> Option<(Limits, Vec<Message>)> {
        let mut draft = Draft::new(self.axis(slave)?);
        ranges::check(&mut draft, &mut Vec::new());
        let mut messages = Vec::new();
        ranges::monitoring(&mut draft, true, &mut messages);
        Some((limits(&draft), messages))
    }

    /// Adopts all entries, as the start of the controller does.
    pub(super) fn adopt_all(&mut self) {
        for list in self.axes.iter_mut().chain(&mut self.channels) {
            list.active = list.stored.clone();
        }
    }

    /// What no control can start with: no axis, two lists of one axis, axes of channels without a list, names that clash. Computed from
    /// the adopted entries.
    pub(super) fn contradictions(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        if self.axis_numbers().next().is_none() {
            let cure = "write `kopf.achs_nr` with the logical number of the axis, from 1, and entries of `kenngr` or `getriebe` in one file";
            problems.push(Problem::new("expected the list of at least one axis, found none", cure));
        }
        for two in self.axes.windows(2) {
            if let [one, other] = two
                && one.number == other.number
                && one.number != 0
            {
                let key = Key::new(AXIS_NUMBER);
                let place = |list| Draft::new(list).place(key);
                let what = format!("expected one list of axis {}, found another one: {}", one.number, place(one));
                problems.push(
                    place(other).problem(what, "give each axis its own logical number, or remove one of the files"),
                );
            }
        }
        for list in &self.channels {
            let missing =
                channels::listed(list).into_iter().filter(|(_, number)| *number != 0 && !self.has_axis(*number));
            problems.extend(missing.map(|(j, number)| {
                let place = Draft::new(list).place(Key::second(100_035, j));
                let numbers: Vec<String> = self.axis_numbers().map(|number| number.to_string()).collect();
                let what = format!("P-CHAN-00035: expected an axis that has a list, found axis {number}");
                place.problem(what, format!("add the list of the axis, or use one of the axes {}", numbers.join(", ")))
            }));
        }
        problems.extend(self.clashes());
        problems
    }

    /// Names of axes that mean two axes: in one channel, or of axes that have only their default name.
    fn clashes(&self) -> Vec<Problem> {
        let started = self.update();
        let mut problems = Vec::new();
        for (list, channel) in self.channels.iter().zip(&started.channels) {
            let mut owners: BTreeMap<&str, u16> = BTreeMap::new();
            for axis in &channel.axes {
                if let Some(other) = owners.insert(&axis.name, axis.number) {
                    let place = Draft::new(list).place(Key::second(100_006, axis.index));
                    let what = format!(
                        "P-CHAN-00006: expected a name that no other axis of channel {} has, found `{}` for axis {} and axis {other}",
                        channel.number, axis.name, axis.number
                    );
                    problems.push(place.problem(what, "give each axis of a channel its own name"));
                }
            }
        }
        let in_channels: BTreeSet<u16> =
            started.channels.iter().flat_map(|of| &of.axes).map(|axis| axis.number).collect();
        let mut owners: BTreeMap<&str, u16> = BTreeMap::new();
        for axis in started.channels.iter().flat_map(|channel| &channel.axes) {
            owners.insert(&axis.name, axis.number);
        }
        let key = DEFAULT_NAME;
        for list in self.axes.iter().filter(|list| list.number != 0 && !in_channels.contains(&list.number)) {
            let draft = Draft::new(list);
            let Some(axis) = started.axis(list.number) else { continue };
            if !draft.is_written(key) || names::fault(draft.word(key)).is_some_and(|(_, nearest)| nearest.is_none()) {
                continue;
            }
            if let Some(other) = owners.insert(&axis.name, axis.number) {
                let what = format!(
                    "P-AXIS-00297: expected a name that no other axis has, found `{}` for axis {} and axis {other}",
                    axis.name, axis.number
                );
                problems.push(draft.place(key).problem(what, "give each axis its own default name"));
            }
        }
        problems
    }

    /// 110076: lists with the number 0, which make no axis.
    fn numbers(&self) -> Vec<Message> {
        let zero = self.axes.iter().filter(|list| list.number == 0);
        let message = |list| {
            let (draft, key) = (Draft::new(list), Key::new(AXIS_NUMBER));
            let text =
                "P-AXIS-00016 kopf.achs_nr: found 0, allowed 1 … 65535; the list is not used, there is no such axis";
            Message::new(Code::Number(110_076), ERROR, &draft.place(key), text)
        };
        zero.map(message).collect()
    }

    /// The axes after the check of each for itself. Of two lists of one axis, which no machine has, the last one.
    fn checked(&self, messages: &mut Vec<Message>) -> Drafts<'_> {
        let lists = self.axes.iter().filter(|list| list.number != 0);
        lists
            .map(|list| {
                let mut draft = Draft::new(list);
                ranges::check(&mut draft, messages);
                (list.number, draft)
            })
            .collect()
    }

    /// HG-25: the axes of channels with P-CHAN-00253, and with one such channel the axes of no channel.
    fn aliased(&self) -> BTreeSet<u16> {
        let axes = |list| channels::listed(list).into_iter().map(|(_, number)| number);
        let has_aliases = |list: &&_| Draft::new(list).whole(Key::new(100_253)) != 0;
        let all: BTreeSet<u16> = self.channels.iter().flat_map(axes).collect();
        let mut aliased: BTreeSet<u16> = self.channels.iter().filter(has_aliases).flat_map(axes).collect();
        if self.channels.iter().any(|list| has_aliases(&list)) {
            aliased.extend(self.axis_numbers().filter(|number| !all.contains(number)));
        }
        aliased
    }
}

fn limits(draft: &Draft<'_>) -> Limits {
    Limits {
        first: unsigned(draft.whole(FIRST_LIMIT)),
        second: unsigned(draft.whole(SECOND_LIMIT)),
        correction_velocity: unsigned(draft.whole(CORRECTION_VELOCITY)),
    }
}

/// The axis of a checked list, without what follows from other axes.
fn made(axis: &Draft<'_>) -> Axis {
    let mut draft = axis.clone();
    if draft.whole(A_EMERGENCY) == 0 {
        draft.set_whole(A_EMERGENCY, draft.whole(A_MAX));
    }
    let number = |number| unsigned(draft.whole(Key::new(number)));
    let is_set = |number| draft.whole(Key::new(number)) != 0;
    Axis {
        number: draft.number(),
        name: draft.word(DEFAULT_NAME).to_owned(),
        has_own_name: false,
        kind: match draft.whole(KIND) {
            LINEAR => AxisKind::Linear,
            ROTARY => AxisKind::Rotary,
            _ => AxisKind::Spindle,
        },
        is_modulo: is_modulo(&draft),
        modulo_range: [signed(draft.whole(LOWER)), signed(draft.whole(UPPER))],
        is_master: is_master(&draft),
        is_slave: is_slave(&draft),
        master: None,
        limits: limits(&draft),
        offset: signed(draft.whole(Key::new(73))),
        slave_no_homing: is_set(74) && !is_spindle(&draft),
        check_without_homing: is_set(249),
        synchronous_homing: is_set(253),
        cnc_controlled_stop: is_set(254),
        on_mode: on_mode(draft.word(ON_MODE)),
        on_edge: is_set(261),
        a_max: number(8),
        a_emergency: number(3),
        a_step: [number(5), number(6)],
        a_ref: unsigned(draft.whole(A_REF)),
        vb_max: number(212),
        vb_ref_fast: number(219),
        vb_ref_slow: number(218),
        reference_position: signed(draft.whole(Key::new(152))),
        is_reference_direction_positive: is_set(158),
        has_no_cam: is_set(156),
        has_no_reversal: is_set(157),
        has_no_zero_pulse: is_set(84),
        homing: homing(draft.word(HOMING)),
        is_homing_given: false,
        max_homing_distance: unsigned(draft.whole(Key::new(284)).abs()),
        watchdog_delay: number(367),
        copies_master_coupling: is_set(486),
        values: draft.into_values(),
    }
}

fn on_mode(word: &str) -> OnMode {
    let modes = [OnMode::Default, OnMode::OnlyControlUnit, OnMode::EdgeTriggered, OnMode::Config];
    ON_MODES.iter().zip(modes).find(|(known, _)| **known == word).map_or(OnMode::Default, |(_, mode)| mode)
}

fn homing(word: &str) -> Homing {
    let kinds = [Homing::CncControlled, Homing::DriveControlled, Homing::Disabled, Homing::IgnoreAbsolutePosition];
    HOMINGS.iter().zip(kinds).find(|(known, _)| **known == word).map_or(Homing::CncControlled, |(_, kind)| kind)
}

/// A checked value of 32 bits without sign.
fn unsigned(value: i64) -> u32 {
    u32::try_from(value.max(0)).unwrap_or(u32::MAX)
}

/// A checked value of 32 bits with sign.
fn signed(value: i64) -> i32 {
    i32::try_from(value).unwrap_or(if value < 0 { i32::MIN } else { i32::MAX })
}
