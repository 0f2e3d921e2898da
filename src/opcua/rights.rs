//! The rights of users, in the words of a SINUMERIK: `StateRead;PlcRead;PlcWrite`, `SinuReadAll`, `SinuWriteAll`.

use super::node_id::Id;
use crate::source::{Problem, did_you_mean};

/// The areas that have rights of their own. The simulator has no values of most of them.
const REALMS: [&str; 10] = ["State", "Frame", "Sea", "Tea", "Tool", "Drive", "Gud", "Fs", "Plc", "Random"];
const STATE: u16 = 1;
const TEA: u16 = 1 << 3;
const PLC: u16 = 1 << 8;
const ALL: u16 = (1 << REALMS.len()) - 1;

/// What a user may read and write: a bit for each realm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rights {
    read: u16,
    write: u16,
}

impl Rights {
    /// `SinuReadAll;SinuWriteAll`.
    pub const ALL: Self = Self { read: ALL, write: ALL };

    /// Reads the words between semicolons. `AlarmRead` changes nothing: alarms are for all users.
    ///
    /// # Errors
    /// A word is unknown.
    pub fn parse(text: &str) -> Result<Self, Problem> {
        let mut rights = Self::default();
        for word in text.split(';').map(str::trim).filter(|word| !word.is_empty()) {
            let bit = |name: &str| REALMS.iter().position(|realm| *realm == name).map(|index| 1 << index);
            match word {
                "SinuReadAll" => rights.read = ALL,
                "SinuWriteAll" => rights.write = ALL,
                "AlarmRead" => {}
                word => match (word.strip_suffix("Read").and_then(bit), word.strip_suffix("Write").and_then(bit)) {
                    (Some(bit), _) => rights.read |= bit,
                    (_, Some(bit)) => rights.write |= bit,
                    (None, None) => return Err(unknown(word)),
                },
            }
        }
        Ok(rights)
    }

    pub(super) fn may_read(self, id: &Id) -> bool {
        realm(id).is_none_or(|realm| self.read & realm != 0)
    }

    pub(super) fn may_write(self, id: &Id) -> bool {
        realm(id).is_none_or(|realm| self.write & realm != 0)
    }
}

fn unknown(word: &str) -> Problem {
    let words = REALMS.iter().flat_map(|realm| [format!("{realm}Read"), format!("{realm}Write")]);
    let words: Vec<_> = ["SinuReadAll", "SinuWriteAll"].into_iter().map(str::to_owned).chain(words).collect();
    let fallback = format!("the rights are {}", words.join(", "));
    let cure = did_you_mean(word, words.iter().map(String::as_str), &fallback);
    Problem::new(format!("unknown right `{word}`"), cure)
}

/// The realm of a value; R parameters are State. The simulator's own values are for everybody.
fn realm(id: &Id) -> Option<u16> {
    match id {
        Id::Plc(_) | Id::Pattern(..) => Some(PLC),
        Id::Variable(nc) if nc.variable.path().is_some() => Some(STATE),
        Id::Absent | Id::Cnc(_) => Some(STATE),
        Id::Variable(_) | Id::Datum(_) => Some(TEA),
        Id::Own(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_give_rights_for_realms() {
        let id = |text| Id::parse(text).unwrap();
        let (plc, state) = (id("/Plc/MB5"), id("/Channel/State/chanStatus"));
        let datum = id("/NC/_N_AX_TEA_ACX/$MA_GANTRY_AXIS_TYPE[u1]");
        let rights = Rights::parse("StateRead; PlcRead;PlcWrite;AlarmRead").unwrap();
        let may = |id| (rights.may_read(id), rights.may_write(id));
        assert_eq!((may(&plc), may(&state), may(&datum)), ((true, true), (true, false), (false, false)));
        assert_eq!(Rights::parse("SinuReadAll;SinuWriteAll"), Ok(Rights::ALL));
        assert!(rights.may_read(&id("/OpenNCK/Cycle")));
        let problem = Rights::parse("PlcReed").unwrap_err().to_string();
        assert!(problem.contains("unknown right `PlcReed`") && problem.contains("PlcRead"), "{problem}");
    }
}
