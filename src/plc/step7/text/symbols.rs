//! Symbol tables: `.asc` with fixed columns, `.sdf` with commas, `.seq` with tabs.

use std::collections::BTreeMap;

use crate::plc::step7::instruction::{BlockName, Space, Width};

use super::address::{Address, parse};
use super::finding::{At, Fault};

/// The symbols of a program, compared without case.
#[derive(Clone, Debug, Default)]
pub(in crate::plc::step7) struct Symbols {
    by_name: BTreeMap<String, Address>,
    blocks: BTreeMap<BlockName, String>,
    names: Vec<(Address, String)>,
}

/// The form of a symbol table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SymbolForm {
    /// `126,` and columns of 24, 12, 10 and 80 characters.
    Asc,
    /// Fields in quotes, separated by commas.
    Sdf,
    /// Fields separated by tabs.
    Seq,
}

impl SymbolForm {
    /// The form by the ending of the file.
    #[must_use]
    pub fn of(ending: &str) -> Option<Self> {
        match ending.to_ascii_lowercase().as_str() {
            "asc" => Some(Self::Asc),
            "sdf" => Some(Self::Sdf),
            "seq" => Some(Self::Seq),
            _ => None,
        }
    }
}

impl Symbols {
    pub(in crate::plc::step7) fn address(&self, name: &str) -> Option<Address> {
        self.by_name.get(&name.trim().to_lowercase()).copied()
    }

    /// The symbol of a block.
    pub(in crate::plc::step7) fn of_block(&self, name: BlockName) -> Option<&str> {
        self.blocks.get(&name).map(String::as_str)
    }

    /// The symbols of bits, timers and counters by their addresses, such as `I1.0` and `T5`.
    pub(in crate::plc::step7) fn by_address(&self) -> BTreeMap<String, String> {
        let mut all = BTreeMap::new();
        for (address, name) in &self.names {
            if let Some(address) = shown(*address) {
                all.entry(address).or_insert_with(|| name.clone());
            }
        }
        all
    }

    pub(in crate::plc::step7) fn names(&self) -> impl Iterator<Item = &str> {
        self.by_name.keys().map(String::as_str)
    }

    /// Reads a table and adds its rows.
    pub(in crate::plc::step7) fn read(&mut self, text: &str, form: SymbolForm, file: u16) -> Vec<Fault> {
        let mut faults = Vec::new();
        for (line, row) in (1..).zip(text.lines()) {
            let row = row.trim_end_matches(['\r', '\u{1a}']);
            // STEP 7 writes no remarks; one in a table by hand does no harm.
            if row.trim().is_empty() || row.starts_with("//") {
                continue;
            }
            let found = match form {
                SymbolForm::Asc => fixed(row),
                SymbolForm::Sdf => fields(&quoted(row)),
                SymbolForm::Seq => fields(&row.split('\t').map(|field| field.trim().to_owned()).collect::<Vec<_>>()),
            };
            match found {
                Some((name, address)) => self.add(&name, address),
                None => faults.push(Fault::new(
                    At { file, line, column: 1 },
                    format!("expected a row of a symbol table with name and address, found `{}`", row.trim()),
                    "export the symbol table again, or correct the row",
                )),
            }
        }
        faults
    }

    fn add(&mut self, name: &str, address: Address) {
        if let Address::Block(block) = address {
            self.blocks.entry(block).or_insert_with(|| name.to_owned());
        }
        self.names.push((address, name.to_owned()));
        self.by_name.insert(name.to_lowercase(), address);
    }
}

/// The address of a bit, a timer or a counter as the traces of a machine write it.
fn shown(address: Address) -> Option<String> {
    match address {
        Address::Memory(space, Width::Bit, bit) => {
            let letter = match space {
                Space::Inputs => 'I',
                Space::Outputs => 'Q',
                Space::Flags => 'M',
                Space::Peripheral | Space::Data | Space::Instance | Space::Local | Space::Caller => return None,
            };
            Some(format!("{letter}{}.{}", bit / 8, bit % 8))
        }
        Address::Timer(number) => Some(format!("T{number}")),
        Address::Counter(number) => Some(format!("C{number}")),
        Address::Memory(..) | Address::Block(_) | Address::Other => None,
    }
}

fn fixed(row: &str) -> Option<(String, Address)> {
    let rest = row.strip_prefix("126,")?;
    let column = |from: usize, length: usize| rest.chars().skip(from).take(length).collect::<String>();
    let name = column(0, 24).trim().to_owned();
    (!name.is_empty()).then_some((name, parse(&column(24, 12))?))
}

/// The fields of a row of which each can be in quotes.
fn quoted(row: &str) -> Vec<String> {
    let mut is_inside = false;
    let fields = row.split(|letter| {
        is_inside ^= letter == '"';
        letter == ',' && !is_inside
    });
    fields.map(|field| field.trim().trim_matches('"').trim().to_owned()).collect()
}

/// Name and address: the address is the first field that is one, after the name.
fn fields(fields: &[String]) -> Option<(String, Address)> {
    fields.windows(2).find_map(|pair| {
        let address = parse(&pair[1])?;
        (!pair[0].is_empty()).then(|| (pair[0].clone(), address))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plc::step7::instruction::{BlockKind, Space, Width};

    #[test]
    fn three_forms_of_a_table_give_the_same_symbols() {
        let asc = "126,Motor läuft             M      20.1 BOOL      Kommentar\r\n126,Daten                   DB     10   DB     10\r\n";
        let sdf = "\"Motor läuft\",\"M      20.1\",\"BOOL\",\"Komma, hier\"\r\n\"Daten\",\"DB     10\",\"DB     10\",\"\"\r\n";
        let seq = "\tMotor läuft\tM      20.1\tBOOL\tKommentar\r\n\tDaten\tDB     10\tDB     10\r\n";
        for (text, form) in [(asc, SymbolForm::Asc), (sdf, SymbolForm::Sdf), (seq, SymbolForm::Seq)] {
            let mut symbols = Symbols::default();
            assert_eq!(symbols.read(text, form, 0), []);
            assert_eq!(symbols.address("motor LÄUFT"), Some(Address::Memory(Space::Flags, Width::Bit, 161)));
            let block = BlockName { kind: BlockKind::Db, number: 10 };
            assert_eq!(symbols.of_block(block), Some("Daten"));
        }
    }

    #[test]
    fn a_row_without_an_address_is_a_fault_with_its_line() {
        let mut symbols = Symbols::default();
        let faults = symbols.read("\n126,Motor\n", SymbolForm::Asc, 0);
        assert_eq!((faults.len(), faults[0].at.line), (1, 2));
    }
}
