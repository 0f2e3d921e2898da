//! The words of a block become what it does: G functions first, then addresses and commands, then what fits together.

use super::alarm::{Fault, Span};
use super::auxiliary::AuxiliaryKind;
use super::composer::{Before, Composed, Composer, UNKNOWN};
use super::evaluate::Scope;
use super::functions::{GFunction, INCH, g, groups, name};
use super::names::{AxisIndex, AxisKind};
use super::prepared::{Action, AxisWord};
use super::syntax::{Address, Word};

/// What the words of a block do.
pub(super) fn compose(words: &[Word], before: Before<'_>, scope: &mut dyn Scope) -> Result<Composed, Fault> {
    let mut composer = Composer::new(scope, before);
    for word in words {
        match word {
            Word::Function { function, at } => composer.function(*function, *at)?,
            Word::Indirect { group, number, at } => {
                let number = composer.whole(number, *at)?;
                let group = match group {
                    Some(group) => Some(composer.whole(group, *at)?),
                    None => None,
                };
                if let Some(function) = indirect(group, number, before, *at)? {
                    composer.function(function, *at)?;
                }
            }
            Word::Address(_) | Word::Command { .. } | Word::Synchronised(_) => {}
        }
    }
    composer.alone(words)?;
    for word in words {
        match word {
            Word::Address(word) => composer.address(word)?,
            Word::Command { command, arguments, at } => composer.command(*command, arguments, *at)?,
            Word::Synchronised(action) => composer.synchronised(action)?,
            Word::Function { .. } | Word::Indirect { .. } => {}
        }
    }
    composer.settle(words)?;
    Ok(composer.done)
}

/// The G function of `G=number` or `G[group]=index`; None in a check, if a number is unknown.
fn indirect(
    group: Option<Option<i32>>,
    number: Option<i32>,
    before: Before<'_>,
    at: Span,
) -> Result<Option<GFunction>, Fault> {
    let Some(number) = number else { return Ok(None) };
    let wrong = || Fault::new(12475, at, "there is no such G function").about(number.to_string());
    let Some(group) = group else {
        return before.dialect.function(&format!("G{number}")).map(Some).ok_or_else(wrong);
    };
    let Some(group) = group else { return Ok(None) };
    let function = match (u8::try_from(group), u8::try_from(number)) {
        (Ok(group), Ok(index)) => GFunction { group, index },
        _ => return Err(wrong()),
    };
    if name(function).is_some() { Ok(Some(function)) } else { Err(wrong()) }
}

/// Groups of functions that define the syntax of their block.
const SYNTAX: [u8; 2] = [groups::WAITS, groups::OFFSETS];

impl Composer<'_> {
    fn function(&mut self, function: GFunction, at: Span) -> Result<(), Fault> {
        if self.has_group(function.group) {
            return Err(Fault::new(12060, at, format!("both belong to G group {}", function.group)));
        }
        if SYNTAX.contains(&function.group) && SYNTAX.iter().any(|group| self.has_group(*group)) {
            return Err(Fault::new(12070, at, "a block has one such function"));
        }
        self.groups.push((function, at));
        if !self.done.modal.set(function) {
            self.done.once.push(function);
        }
        Ok(())
    }

    /// Functions that accept only certain words beside them.
    fn alone(&self, words: &[Word]) -> Result<(), Fault> {
        let is_axis = |word: &Word| matches!(word, Word::Address(word) if matches!(word.address, Address::Axis(_) | Address::AxisOf));
        let is = |word: &Word, address: &Address| matches!(word, Word::Address(word) if word.address == *address);
        let is_output = |word: &Word| {
            let outputs = [Address::S, Address::M, Address::H, Address::T, Address::D, Address::SumOffset];
            outputs.iter().any(|address| is(word, address))
        };
        let is_function = |word: &Word| matches!(word, Word::Function { .. } | Word::Indirect { .. });
        for (function, at) in &self.groups {
            let misfit = |fits: &dyn Fn(&Word) -> bool, number: u32| {
                let found = words.iter().find(|word| word.at() != *at && !fits(word));
                found.map_or(Ok(()), |word| Err(Fault::new(number, word.at(), "this does not fit the G function")))
            };
            match (function.group, *function) {
                (groups::BUFFER, _) => misfit(&|_| false, 12120)?,
                (_, g::G25 | g::G26) => misfit(&|word| is_axis(word) || is(word, &Address::S), 12120)?,
                // Programs of real controls have M functions beside G4.
                (_, g::G4) => misfit(&|word| is(word, &Address::F) || is_output(word), 12110)?,
                (_, g::G74) => misfit(&is_axis, 12110)?,
                (_, g::TRANS | g::ATRANS) => {
                    misfit(&|word| is_axis(word) || is_function(word), 12110)?;
                    let modified =
                        words.iter().find(|word| matches!(word, Word::Address(word) if word.modifier.is_some()));
                    if let Some(word) = modified {
                        return Err(Fault::new(12020, word.at(), "an offset has none"));
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// What fits together, when all words are known.
    fn settle(&mut self, words: &[Word]) -> Result<(), Fault> {
        let at = words.first().map_or_else(Span::default, Word::at);
        let at = words.last().map_or(at, |last| at.until(last.at()));
        if self.has_function(g::G4) {
            return self.dwell(at);
        }
        if self.has_function(g::G25) || self.has_function(g::G26) {
            let axes: Vec<_> = self.done.axes.drain(..).map(|word| (word.axis, word.value)).collect();
            let spindles = std::mem::take(&mut self.speeds);
            self.done.auxiliary.clear(); // that S is a limit, not a speed
            if axes.is_empty() && spindles.is_empty() {
                return Err(Fault::new(12080, at, "an axis or S is missing"));
            }
            let is_upper = self.has_function(g::G26);
            self.done.actions.push(Action::Limit { is_upper, axes, spindles });
            return Ok(());
        }
        if self.has_function(g::G74) {
            let axes: Vec<_> = self.done.axes.drain(..).map(|word| word.axis).collect();
            if axes.is_empty() {
                return Err(Fault::new(12080, at, "an axis is missing"));
            }
            self.done.actions.push(Action::Reference(axes));
            self.done.stops_preparation = true;
            return Ok(());
        }
        if self.has_function(g::TRANS) || self.has_function(g::ATRANS) {
            self.offset();
            return Ok(());
        }
        self.circle()?;
        self.handwheel_overrides()?;
        self.path_feed(at)
    }

    fn dwell(&mut self, at: Span) -> Result<(), Fault> {
        let speeds = std::mem::take(&mut self.speeds);
        // That F and S are no feed and no speed.
        self.done.auxiliary.retain(|one| !matches!(one.kind, AuxiliaryKind::F | AuxiliaryKind::S));
        let action = match (self.new_feed, speeds.as_slice()) {
            (Some(seconds), []) => Action::DwellSeconds(seconds),
            (None, [(spindle, revolutions)]) => {
                Action::DwellRevolutions { spindle: *spindle, revolutions: *revolutions }
            }
            _ => return Err(Fault::new(12110, at, "G4 has either F with seconds, or S with revolutions")),
        };
        if matches!(action, Action::DwellSeconds(time) if time < 0.0) {
            return Err(Fault::new(12560, at, "a time is not negative"));
        }
        self.done.actions.push(action);
        Ok(())
    }

    /// TRANS replaces the offset, ATRANS adds to it. Both are lengths: what G70 and G71 say where they are programmed decides, and not what holds later.
    fn offset(&mut self) {
        if self.has_function(g::TRANS) {
            self.done.offset.clear();
        }
        let in_inches = self.done.modal.is_inch();
        for AxisWord { axis, value, .. } in std::mem::take(&mut self.done.axes) {
            let is_rotary =
                self.scope.axes().row(axis).is_some_and(|row| matches!(row.kind, AxisKind::Rotary | AxisKind::Modulo));
            let value = if in_inches && !is_rotary { value * INCH } else { value };
            match self.done.offset.iter_mut().find(|(other, _)| *other == axis) {
                Some((_, offset)) => *offset += value,
                None => self.done.offset.push((axis, value)),
            }
        }
    }

    fn circle(&mut self) -> Result<(), Fault> {
        let Some(at) = self.circle_at else { return Ok(()) };
        if !self.done.modal.is(g::G2) && !self.done.modal.is(g::G3) {
            let number = if self.has_group(groups::MOTION) { 12110 } else { 15460 };
            return Err(Fault::new(number, at, "I, J, K, CR, AR and TURN belong to G2 and G3"));
        }
        let circle = &self.done.circle;
        let has_centre = circle.centre.iter().any(Option::is_some);
        if circle.radius.is_some() && (has_centre || circle.opening_angle.is_some()) {
            let number = if self.has_group(groups::MOTION) { 12110 } else { 15460 };
            return Err(Fault::new(number, at, "CR cannot be combined with I, J, K or AR"));
        }
        Ok(())
    }

    /// FDA belongs to POS or POSA of its axis, without FA; FD to a path in G94 without F.
    fn handwheel_overrides(&self) -> Result<(), Fault> {
        for (axis, at) in &self.handwheels {
            let fits = match axis {
                Some(axis) => {
                    let is = |of: &AxisIndex| of == axis || *of == UNKNOWN || *axis == UNKNOWN;
                    let mut actions = self.done.actions.iter();
                    let positions =
                        actions.any(|one| matches!(one, Action::Position { target, .. } if is(&target.axis)));
                    let mut actions = self.done.actions.iter();
                    positions && !actions.any(|one| matches!(one, Action::AxisFeed(of, _) if of == axis))
                }
                None => {
                    let is_path = !self.done.axes.is_empty() || self.circle_at.is_some();
                    is_path && !self.done.modal.is(g::G0) && self.done.modal.is(g::G94) && self.new_feed.is_none()
                }
            };
            if !fits {
                let of_path = "FD belongs to a path in G1, G2 or G3 with G94, without F";
                let of_axis = "FDA belongs to POS or POSA of its axis, without FA";
                return Err(Fault::new(14300, *at, if axis.is_some() { of_axis } else { of_path }));
            }
        }
        Ok(())
    }

    /// F, and whether a path has one. A change between G94 and G95 needs a new F.
    fn path_feed(&mut self, at: Span) -> Result<(), Fault> {
        if !self.done.modal.agrees(&self.before.modal, groups::FEED) {
            self.done.feed = None;
        }
        if let Some(feed) = self.new_feed {
            if feed <= 0.0 {
                return Err(Fault::new(14800, at, format!("F is {feed}")));
            }
            self.done.feed = Some(feed);
        }
        let is_path = !self.done.axes.is_empty() || self.circle_at.is_some();
        let has_own = self.handwheels.iter().any(|(axis, _)| axis.is_none());
        if is_path && !has_own && !self.done.modal.is(g::G0) && self.done.feed.is_none() && self.before.needs_feed {
            return Err(Fault::new(10860, at, "no F since the start, or since a change between G94 and G95"));
        }
        Ok(())
    }
}
