//! The faults of the verbs `fault` and `clear_fault`: `{ axis = "XF", kind = "block" }`. Each kind has one row in [`faults!`]: its name, how
//! its keys are read, and how a transcript writes them.

use super::naming::axis_named;
use crate::machine::{Fault, FaultKind, Machine, Switch};
use crate::source::{Node, Place, Problem, Table, Value, did_you_mean};
use crate::units::Position;
use crate::variables::FaultName;

/// The fastest drift in mm or degrees per second. No real axis is faster.
const FASTEST_DRIFT: f64 = FaultKind::FASTEST_DRIFT;
/// The largest push in mm or degrees: one kilometre, longer than any machine.
const FARTHEST_PUSH: f64 = FaultKind::FARTHEST_PUSH;

/// Reads the keys of a kind of fault.
type Read = fn(&mut Keys) -> Result<FaultKind, Problem>;

/// Makes from each row, `Name: value => keys as written, read;`, the list of names for reading and the match for writing. A kind without a
/// row does not compile.
macro_rules! faults {
    ($($name:ident: $kind:pat => $written:expr, $read:expr;)*) => {
        const KINDS: &[(FaultName, Read)] = &[$((FaultName::$name, $read)),*];

        /// The name of a kind of fault, and its keys as TOML, each after `, `.
        pub(super) fn written(kind: FaultKind) -> (&'static str, String) {
            match kind {
                $($kind => (FaultName::$name.name(), $written),)*
            }
        }
    };
}

faults! {
    Block: FaultKind::Block => String::new(), |_| Ok(FaultKind::Block);
    Push: FaultKind::Push { by } => distance_written(by), |keys| Ok(FaultKind::Push { by: keys.distance()? });
    DriveFault: FaultKind::DriveFault => String::new(), |_| Ok(FaultKind::DriveFault);
    EncoderFault: FaultKind::EncoderFault { encoder } =>
        encoder.map_or_else(String::new, |encoder| format!(", encoder = {}", encoder + 1)),
        |keys| Ok(FaultKind::EncoderFault { encoder: keys.table.take("encoder").map(|node| encoder(&node)).transpose()? });
    EncoderSlip: FaultKind::EncoderSlip { by } =>
        distance_written(by), |keys| Ok(FaultKind::EncoderSlip { by: keys.distance()? });
    Friction: FaultKind::Friction { by } => format!(", by = {by:?}"), |keys| Ok(FaultKind::Friction { by: keys.share()? });
    Drift: FaultKind::Drift { by } => format!(", by = {:?}", per_second(by)), |keys| {
        let what = "a velocity in mm or degrees per second";
        let velocity = keys.by(what, FASTEST_DRIFT, "write a velocity from -1000000 to 1000000")?;
        Ok(FaultKind::Drift { by: velocity * Position::PER_USER_UNIT })
    };
    ZeroMarkMissing: FaultKind::ZeroMarkMissing => String::new(), |_| Ok(FaultKind::ZeroMarkMissing);
    SwitchStuck: FaultKind::SwitchStuck { which, at } =>
        format!(", which = \"{}\", at = {}", switch_name(which), u8::from(at)),
        |keys| {
            let which = keys.required("which", "write which = \"cam\"")?;
            let at = keys.required("at", "write at = 1")?;
            Ok(FaultKind::SwitchStuck { which: switch(&which)?, at: one_or_zero(&at)? })
        };
    Hold: FaultKind::Hold { by } => distance_written(by), |keys| Ok(FaultKind::Hold { by: keys.distance()? });
    MovedByHand: FaultKind::MovedByHand { by } =>
        distance_written(by), |keys| Ok(FaultKind::MovedByHand { by: keys.distance()? });
    DriveNotReady: FaultKind::DriveNotReady => String::new(), |_| Ok(FaultKind::DriveNotReady);
}

/// The keys of a fault.
struct Keys {
    table: Table,
    place: Place,
    begins: bool,
}

impl Keys {
    fn required(&mut self, key: &'static str, example: &str) -> Result<Node, Problem> {
        let missing = || self.place.problem(format!("expected the key `{key}`, found none"), example);
        self.table.take(key).ok_or_else(missing)
    }

    /// The amount of a fault. It is required if the fault begins.
    fn by(&mut self, what: &str, largest: f64, cure: &str) -> Result<f64, Problem> {
        match self.table.take("by") {
            None if self.begins => Err(self.place.problem("expected the key `by`, found none", "write by = 0.05")),
            None => Ok(0.0),
            Some(node) => match node.number(what)? {
                number if number.abs() <= largest => Ok(number),
                _ => Err(node.expected(what, cure)),
            },
        }
    }

    fn distance(&mut self) -> Result<Position, Problem> {
        let what = "a distance in mm or degrees from -1000000 to 1000000";
        Ok(Position::from_user(self.by(what, FARTHEST_PUSH, "write by = 0.05")?))
    }

    fn share(&mut self) -> Result<f64, Problem> {
        let share = self.by("a share of the velocity, 0 to 1", 1.0, "0 loses nothing, 1 loses everything")?;
        if share < 0.0 {
            let found = "expected a share of the velocity, 0 to 1, found a negative number";
            return Err(self.place.problem(found, "0 loses nothing"));
        }
        Ok(share)
    }
}

/// Reads a fault. If the fault begins, its amount is required.
pub(super) fn fault(node: Node, begins: bool, machine: &Machine) -> Result<Fault, Problem> {
    const EXAMPLE: &str = "write { axis = \"XF\", kind = \"block\" }";
    let place = node.place.clone();
    let table = node.into_table("a fault, as { axis = \"XF\", kind = \"block\" }")?;
    let mut keys = Keys { table, place, begins };
    let axis = keys.required("axis", EXAMPLE)?;
    let kind = keys.required("kind", EXAMPLE)?;
    let axis =
        axis_named(machine, axis.text("the name of a machine axis")?).map_err(|problem| problem.at(&axis.place))?;
    let name = kind.text("the kind of a fault")?;
    let Some((_, read)) = KINDS.iter().find(|(known, _)| known.name() == name) else {
        let known = || KINDS.iter().map(|(known, _)| known.name());
        let fallback = format!("kinds are {}", known().collect::<Vec<_>>().join(", "));
        return Err(kind.expected("a kind of fault", &did_you_mean(name, known(), &fallback)));
    };
    let kind = read(&mut keys)?;
    keys.table.finish()?;
    Ok(Fault { axis, kind })
}

fn distance_written(by: Position) -> String {
    format!(", by = {:?}", by.user())
}

/// Increments per second in user units, chosen so that they convert back to the same increments.
fn per_second(increments: f64) -> f64 {
    let near = increments / Position::PER_USER_UNIT;
    let same = |user: &f64| (user * Position::PER_USER_UNIT).to_bits() == increments.to_bits();
    [near, near.next_up(), near.next_down()].into_iter().find(same).unwrap_or(near)
}

const SWITCHES: [Switch; 3] = [Switch::Cam, Switch::LimitPlus, Switch::LimitMinus];

fn switch_name(switch: Switch) -> &'static str {
    match switch {
        Switch::Cam => "cam",
        Switch::LimitPlus => "limit_plus",
        Switch::LimitMinus => "limit_minus",
    }
}

fn switch(node: &Node) -> Result<Switch, Problem> {
    let name = node.text("the name of a switch")?;
    let known = SWITCHES.map(switch_name);
    SWITCHES.into_iter().find(|switch| switch_name(*switch) == name).ok_or_else(|| {
        let fallback = format!("switches are {}", known.join(", "));
        node.expected("the name of a switch", &did_you_mean(name, known, &fallback))
    })
}

fn encoder(node: &Node) -> Result<u8, Problem> {
    match node.value {
        Value::Integer(1) => Ok(0),
        Value::Integer(2) => Ok(1),
        _ => Err(node.expected("encoder 1 or 2", "write encoder = 2, or omit it for the active encoder")),
    }
}

fn one_or_zero(node: &Node) -> Result<bool, Problem> {
    match node.value {
        Value::Integer(0) | Value::Boolean(false) => Ok(false),
        Value::Integer(1) | Value::Boolean(true) => Ok(true),
        _ => Err(node.expected("0 or 1", "write at = 1")),
    }
}
