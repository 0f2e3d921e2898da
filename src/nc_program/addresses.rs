//! Addresses of a block: positions, circles, feedrates, auxiliary functions.

use super::alarm::{Fault, Span};
use super::auxiliary::{AuxiliaryKind, judged_value};
use super::composer::{Composer, UNKNOWN};
use super::expression::Expression;
use super::functions::g;
use super::names::{AxisIndex, AxisKind, AxisName};
use super::prepared::{Action, AuxiliaryFunction, AxisWord, Centre, Dimension, End, predefined_group};
use super::syntax::{Address, AddressWord, Modifier};
use super::value::Value;

/// An auxiliary function: its address, the largest extension, how many a block can have.
struct Row {
    address: &'static str,
    kind: AuxiliaryKind,
    extension: u16,
    count: usize,
}

const fn row(address: &'static str, kind: AuxiliaryKind, extension: u16, count: usize) -> Row {
    Row { address, kind, extension, count }
}

/// Numbers of the manuals; of two contradictory ones the larger.
const AUXILIARY: [Row; 7] = [
    row("M", AuxiliaryKind::M, 99, 5),
    row("S", AuxiliaryKind::S, 12, 3),
    row("T", AuxiliaryKind::T, 99, 1),
    row("D", AuxiliaryKind::D, 99, 1),
    row("DL", AuxiliaryKind::SumOffset, 99, 1),
    row("H", AuxiliaryKind::H, 99, 3),
    row("F", AuxiliaryKind::F, 31, 6),
];

/// Auxiliary functions of a block, at most.
const MOST_AUXILIARY: usize = 10;

impl Composer<'_> {
    pub(super) fn address(&mut self, word: &AddressWord) -> Result<(), Fault> {
        match &word.address {
            Address::Axis(axis) => self.axis_word(*axis, word),
            Address::AxisOf => {
                let axis = self.bracket(word)?;
                self.axis_word(axis, word)
            }
            Address::Position | Address::PositionAcross => {
                let axis = self.bracket(word)?;
                self.position(axis, word.at)?;
                let target = self.target(axis, word)?;
                let waits = word.address == Address::Position;
                self.done.actions.push(Action::Position { target, waits });
                Ok(())
            }
            Address::Centre(index) => self.centre(usize::from(*index), word),
            Address::Radius => {
                self.plain("CR", word)?;
                self.done.circle.radius = Some(self.number(&word.value, word.at)?);
                self.circle_at = Some(word.at);
                Ok(())
            }
            Address::OpeningAngle => {
                self.plain("AR", word)?;
                self.done.circle.opening_angle = Some(self.number(&word.value, word.at)?);
                self.circle_at = Some(word.at);
                Ok(())
            }
            Address::Turns => self.turns(word),
            Address::F => self.feed(word),
            Address::AxisFeed => {
                let axis = self.bracket(word)?;
                let value = self.axis_value("FA", axis, word)?;
                if value < 0.0 {
                    let name = self.scope.axes().name(axis).to_owned();
                    return Err(Fault::new(14810, word.at, "a feedrate is not negative").about(name));
                }
                self.done.actions.push(Action::AxisFeed(axis, value));
                let axis = Some(axis);
                self.auxiliary(AuxiliaryFunction { axis, ..output(AuxiliaryKind::F, None, value) }, word.at)
            }
            Address::HandwheelFeed => {
                let axis = self.bracket(word)?;
                let value = self.axis_value("FDA", axis, word)?;
                if value < 0.0 {
                    let name = self.scope.axes().name(axis).to_owned();
                    return Err(Fault::new(14810, word.at, "a feedrate is not negative").about(name));
                }
                self.handwheels.push((Some(axis), word.at));
                self.done.actions.push(Action::HandwheelFeed(axis, value));
                Ok(())
            }
            Address::PathHandwheelFeed => {
                self.plain("FD", word)?;
                let value = self.number(&word.value, word.at)?;
                if value < 0.0 {
                    return Err(Fault::new(14800, word.at, format!("FD is {value}")));
                }
                if value == 0.0 {
                    return Err(Fault::refused(word.at, "FD=0 (contour handwheel)"));
                }
                self.handwheels.push((None, word.at));
                self.done.actions.push(Action::PathHandwheelFeed(value));
                Ok(())
            }
            Address::Acceleration => {
                let axis = self.bracket(word)?;
                let value = self.axis_value("ACC", axis, word)?;
                self.done.actions.push(Action::Acceleration(axis, percent(value, word.at)?));
                Ok(())
            }
            Address::Override => {
                self.plain("OVR", word)?;
                let value = self.number(&word.value, word.at)?;
                self.done.actions.push(Action::Override(percent(value, word.at)?));
                Ok(())
            }
            Address::SpindlePosition | Address::SpindlePositionAcross => self.spindle_position(word),
            Address::S | Address::T | Address::D | Address::SumOffset | Address::H | Address::M => self.output(word),
            Address::Passes => Err(Fault::new(12090, word.at, "a number of passes needs a call or a repetition")),
        }
    }

    /// The axis in brackets, or the spindle.
    fn bracket(&mut self, word: &AddressWord) -> Result<AxisIndex, Fault> {
        match &word.extension {
            Some(axis) => self.axis(axis, word.at),
            None => Err(Fault::new(12400, word.at, "the axis in brackets is missing")),
        }
    }

    fn axis_word(&mut self, axis: AxisIndex, word: &AddressWord) -> Result<(), Fault> {
        self.position(axis, word.at)?;
        let target = self.target(axis, word)?;
        self.done.axes.push(target);
        Ok(())
    }

    fn target(&mut self, axis: AxisIndex, word: &AddressWord) -> Result<AxisWord, Fault> {
        let value = self.number(&word.value, word.at)?;
        let dimension = match word.modifier {
            None => self.default_dimension_of(axis),
            Some(modifier) => dimension(modifier, word.at)?,
        };
        self.judge(axis, dimension, value, word.at)?;
        Ok(AxisWord { axis, value, dimension })
    }

    /// G90 or G91; G90 of a modulo axis can be DC (MD30455 bit 2). An offset or a limit has no way.
    pub(super) fn default_dimension_of(&self, axis: AxisIndex) -> Dimension {
        let takes_shortest = |row: &AxisName| row.kind == AxisKind::Modulo && row.is_shortest_by_default;
        match self.default_dimension() {
            Dimension::Absolute if self.is_motion() && self.scope.axes().row(axis).is_some_and(takes_shortest) => {
                Dimension::Shortest
            }
            dimension => dimension,
        }
    }

    /// DC needs a rotary axis, ACP and ACN a modulo axis. Every absolute position of a modulo axis is in its range, unless MD30455 allows others.
    #[expect(
        clippy::manual_range_contains,
        reason = "a value that a check does not know is not a number, and no error"
    )]
    fn judge(&self, axis: AxisIndex, dimension: Dimension, value: f64, at: Span) -> Result<(), Fault> {
        let axes = self.scope.axes();
        let Some(row) = axes.row(axis) else { return Ok(()) };
        let wrong = |number: u32, reason: &str| Err(Fault::new(number, at, reason).about(row.name.clone()));
        match (dimension, row.kind) {
            (Dimension::Incremental, _) | (_, AxisKind::Any) => return Ok(()),
            (Dimension::Absolute, AxisKind::Linear | AxisKind::Rotary) => return Ok(()),
            // An offset or a limit is no position, and the value beside G74 is not used.
            (Dimension::Absolute, AxisKind::Modulo) if !self.is_motion() => return Ok(()),
            (Dimension::Shortest, AxisKind::Linear) => return wrong(16800, "the axis is linear"),
            (Dimension::FromPlus, AxisKind::Linear | AxisKind::Rotary) => {
                return wrong(16810, "the axis is not modulo");
            }
            (Dimension::FromMinus, AxisKind::Linear | AxisKind::Rotary) => {
                return wrong(16820, "the axis is not modulo");
            }
            (Dimension::Shortest, AxisKind::Rotary) => return Ok(()),
            (
                Dimension::Absolute | Dimension::Shortest | Dimension::FromPlus | Dimension::FromMinus,
                AxisKind::Modulo,
            ) => {}
        }
        if !row.is_beyond_modulo && (value < 0.0 || value >= 360.0) {
            return wrong(16830, "the range is 0 to 359.999");
        }
        Ok(())
    }

    /// Whether axis words of the block are positions to move to.
    fn is_motion(&self) -> bool {
        ![g::TRANS, g::ATRANS, g::G25, g::G26, g::G74].into_iter().any(|function| self.has_function(function))
    }

    fn centre(&mut self, index: usize, word: &AddressWord) -> Result<(), Fault> {
        self.once(["I", "J", "K"][index.min(2)], None, word.at)?;
        let is_absolute = match word.modifier {
            None | Some(Modifier::Incremental) => false,
            Some(Modifier::Absolute) => true,
            Some(Modifier::Shortest | Modifier::FromPlus | Modifier::FromMinus | Modifier::Quick) => {
                return Err(Fault::new(12020, word.at, "AC and IC are possible"));
            }
        };
        let value = self.number(&word.value, word.at)?;
        self.done.circle.centre[index.min(2)] = Some(Centre { value, is_absolute });
        self.circle_at = Some(word.at);
        Ok(())
    }

    fn turns(&mut self, word: &AddressWord) -> Result<(), Fault> {
        self.plain("TURN", word)?;
        let number = self.number(&word.value, word.at)?;
        let wrong = || Fault::new(14048, word.at, format!("{number}: 0 to {MOST_TURNS} full circles are possible"));
        if number < 0.0 || number > f64::from(MOST_TURNS) || number.fract() != 0.0 && !number.is_nan() {
            return Err(wrong());
        }
        let turns = (0..=MOST_TURNS).find(|turns| f64::from(*turns) >= number);
        self.done.circle.turns = Some(turns.unwrap_or(0));
        self.circle_at = Some(word.at);
        Ok(())
    }

    fn feed(&mut self, word: &AddressWord) -> Result<(), Fault> {
        let extension = self.extension(word, 31)?;
        self.once("F", extension, word.at)?;
        let value = self.number(&word.value, word.at)?;
        if extension.unwrap_or(0) == 0 {
            self.new_feed = Some(value);
        }
        let is_quick = quick(word.modifier, word.at)?;
        self.auxiliary(AuxiliaryFunction { is_quick, ..output(AuxiliaryKind::F, extension, value) }, word.at)
    }

    fn spindle_position(&mut self, word: &AddressWord) -> Result<(), Fault> {
        let waits = word.address == Address::SpindlePosition;
        let spindle = match &word.extension {
            Some(spindle) => Some(self.limited(spindle, (1, 31), 16100, word.at)?),
            None => None,
        };
        self.once("SPOS", spindle, word.at)?;
        let value = self.number(&word.value, word.at)?;
        let dimension = match word.modifier {
            None => Dimension::Absolute,
            Some(modifier) => dimension(modifier, word.at)?,
        };
        self.done.actions.push(Action::SpindlePosition { spindle, value, dimension, waits });
        Ok(())
    }

    /// M, S, T, D, DL, H.
    fn output(&mut self, word: &AddressWord) -> Result<(), Fault> {
        let kind = match word.address {
            Address::S => AuxiliaryKind::S,
            Address::T => AuxiliaryKind::T,
            Address::D => AuxiliaryKind::D,
            Address::SumOffset => AuxiliaryKind::SumOffset,
            Address::H => AuxiliaryKind::H,
            _ => AuxiliaryKind::M,
        };
        let row = &AUXILIARY[AUXILIARY.iter().position(|row| row.kind == kind).unwrap_or(0)];
        let extension = self.extension(word, row.extension)?;
        let is_quick = quick(word.modifier, word.at)?;
        if kind == AuxiliaryKind::T && matches!(self.term(&word.value)?.value, Value::Text(_)) {
            return Err(Fault::refused(word.at, "the name of a tool (tool management)"));
        }
        let value = self.number(&word.value, word.at)?;
        judged_value(kind, value).map_err(|(number, reason)| Fault::new(number, word.at, reason))?;
        // Several M and H of a block are common; the others stand once for each extension.
        if !matches!(kind, AuxiliaryKind::M | AuxiliaryKind::H) {
            self.once(row.address, extension, word.at)?;
        }
        if kind == AuxiliaryKind::S {
            self.speeds.push((extension, value));
        }
        self.auxiliary(AuxiliaryFunction { is_quick, ..output(kind, extension, value) }, word.at)
    }

    fn extension(&mut self, word: &AddressWord, most: u16) -> Result<Option<u16>, Fault> {
        let Some(extension) = &word.extension else { return Ok(None) };
        let number = if word.address == Address::S { 16100 } else { 12560 };
        self.limited(extension, (0, most), number, word.at).map(Some)
    }

    fn auxiliary(&mut self, function: AuxiliaryFunction, at: Span) -> Result<(), Fault> {
        let row = AUXILIARY.iter().find(|row| row.kind == function.kind);
        let of_kind = self.done.auxiliary.iter().filter(|other| other.kind == function.kind).count();
        if let Some(row) = row
            && of_kind >= row.count
        {
            let reason = format!("a block has at most {} of {}", row.count, row.address);
            return Err(Fault::new(12010, at, reason));
        }
        if self.done.auxiliary.len() >= MOST_AUXILIARY {
            return Err(Fault::new(14750, at, format!("a block has at most {MOST_AUXILIARY}")));
        }
        if function.kind == AuxiliaryKind::M {
            let group = predefined_group(function.value);
            let same = |other: &&AuxiliaryFunction| {
                other.kind == AuxiliaryKind::M
                    && predefined_group(other.value) == group
                    && (group == Some(1) || other.extension == function.extension)
            };
            if let (Some(group), Some(_)) = (group, self.done.auxiliary.iter().find(same)) {
                return Err(Fault::new(14760, at, format!("both belong to auxiliary function group {group}")));
            }
            self.note_end(&function);
        }
        self.done.auxiliary.push(function);
        Ok(())
    }

    fn note_end(&mut self, function: &AuxiliaryFunction) {
        let is_end = [2.0, 17.0, 30.0].contains(&function.value);
        if is_end && function.extension.unwrap_or(0) == 0 {
            self.done.end = Some(if self.before.is_main { End::Program } else { End::Subprogram });
        }
    }

    /// An address without modifier that stands once.
    fn plain(&mut self, address: &'static str, word: &AddressWord) -> Result<(), Fault> {
        if word.modifier.is_some() {
            return Err(Fault::new(12020, word.at, format!("{address} has none")));
        }
        self.once(address, None, word.at)
    }

    /// The value of FA or ACC.
    fn axis_value(&mut self, address: &'static str, axis: AxisIndex, word: &AddressWord) -> Result<f64, Fault> {
        if word.modifier.is_some() {
            return Err(Fault::new(12020, word.at, format!("{address} has none")));
        }
        if axis != UNKNOWN {
            self.once(address, Some(axis.0), word.at)?;
        }
        self.number(&word.value, word.at)
    }

    fn once(&mut self, address: &'static str, extension: Option<u16>, at: Span) -> Result<(), Fault> {
        if self.programmed.contains(&(address, extension)) {
            return Err(Fault::new(12000, at, "the same address stands before in the block"));
        }
        self.programmed.push((address, extension));
        Ok(())
    }

    /// The value of an address of a synchronised action, which is calculated later.
    pub(super) fn bracket_axis(&mut self, extension: Option<&Expression>, at: Span) -> Result<AxisIndex, Fault> {
        match extension {
            Some(axis) => self.axis(axis, at),
            None => Err(Fault::new(12400, at, "the axis in brackets is missing")),
        }
    }
}

/// The dimension of a position. QU belongs to auxiliary functions.
pub(super) fn dimension(modifier: Modifier, at: Span) -> Result<Dimension, Fault> {
    match modifier {
        Modifier::Absolute => Ok(Dimension::Absolute),
        Modifier::Incremental => Ok(Dimension::Incremental),
        Modifier::Shortest => Ok(Dimension::Shortest),
        Modifier::FromPlus => Ok(Dimension::FromPlus),
        Modifier::FromMinus => Ok(Dimension::FromMinus),
        Modifier::Quick => Err(Fault::new(12020, at, "QU belongs to auxiliary functions")),
    }
}

fn quick(modifier: Option<Modifier>, at: Span) -> Result<bool, Fault> {
    match modifier {
        None => Ok(false),
        Some(Modifier::Quick) => Ok(true),
        Some(_) => Err(Fault::new(12020, at, "the modifier belongs to positions")),
    }
}

/// Full circles of TURN, at most.
const MOST_TURNS: u16 = 999;

fn percent(value: f64, at: Span) -> Result<f64, Fault> {
    if value <= 0.0 || value > 200.0 {
        return Err(Fault::new(12560, at, format!("{value} % is outside the range above 0 to 200 %")));
    }
    Ok(value)
}

fn output(kind: AuxiliaryKind, extension: Option<u16>, value: f64) -> AuxiliaryFunction {
    AuxiliaryFunction { kind, extension, axis: None, value, is_quick: false }
}
