//! `--identity F.toml`: the identification of the CPU, for example that of a particular machine.
//!
//! ```toml
//! order_number = "6ES7 317-2EK14-0AB0"   # up to 20 characters
//! version = "3.2.6"                      # of the firmware
//! system_name = "Line 4"                 # these up to 32
//! module_name = "PLC 317-2 PN/DP"
//! plant = "Hall 2"
//! copyright = "Original Siemens Equipment"
//! serial_number = "S C-X4U421302009"
//! module_type = "CPU 317-2 PN/DP"
//! location = "=A1+S2"
//! ```
//! Missing keys keep their defaults.

use std::path::Path;

use crate::image::Profile;
use crate::machine::Machine;
use crate::s7::Identity;
use crate::source::{Node, Problem, Table, read_text};

/// The content of an identity file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OwnIdentity {
    order_number: Option<String>,
    version: Option<[u8; 3]>,
    system_name: Option<String>,
    module_name: Option<String>,
    plant: Option<String>,
    copyright: Option<String>,
    serial_number: Option<String>,
    module_type: Option<String>,
    location: Option<String>,
}

impl OwnIdentity {
    /// Reads a file.
    ///
    /// # Errors
    /// The file cannot be read, is not TOML, or has unknown keys or a text that is too long for its field.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        Self::parse(&read_text(path)?, &path.display().to_string())
    }

    fn parse(text: &str, file: &str) -> Result<Self, Problem> {
        let mut table = Table::parse(text, file)?;
        let mut name = |key, longest| table.take(key).map(|node| short(&node, longest)).transpose();
        let identity = Self {
            order_number: name("order_number", 20)?,
            system_name: name("system_name", 32)?,
            module_name: name("module_name", 32)?,
            plant: name("plant", 32)?,
            copyright: name("copyright", 32)?,
            serial_number: name("serial_number", 32)?,
            module_type: name("module_type", 32)?,
            location: name("location", 32)?,
            version: table.take("version").map(|node| version(&node)).transpose()?,
        };
        table.finish()?;
        Ok(identity)
    }

    /// The identification `base` with the values of the file.
    #[must_use]
    pub fn over<'a>(&'a self, base: Identity<'a>) -> Identity<'a> {
        let value_or = |own: &'a Option<String>, base| own.as_deref().unwrap_or(base);
        Identity {
            order_number: value_or(&self.order_number, base.order_number),
            version: self.version.unwrap_or(base.version),
            system_name: value_or(&self.system_name, base.system_name),
            module_name: value_or(&self.module_name, base.module_name),
            plant: value_or(&self.plant, base.plant),
            copyright: value_or(&self.copyright, base.copyright),
            serial_number: value_or(&self.serial_number, base.serial_number),
            module_type: value_or(&self.module_type, base.module_type),
            location: value_or(&self.location, base.location),
        }
    }
}

/// An ASCII text for a field of fixed length.
fn short(node: &Node, longest: usize) -> Result<String, Problem> {
    let text = node.text("a text")?;
    if text.len() <= longest && text.bytes().all(|byte| (b' '..=b'~').contains(&byte)) {
        return Ok(text.to_owned());
    }
    Err(node.expected(&format!("at most {longest} characters of ASCII"), "the field of the module is not longer"))
}

fn version(node: &Node) -> Result<[u8; 3], Problem> {
    let wrong = || node.expected("a version of three numbers up to 255", "write it as \"3.2.6\"");
    let numbers: Option<Vec<u8>> = node.text("a version")?.split('.').map(|number| number.parse().ok()).collect();
    numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(wrong)
}

/// The identification of the PLC of a control. The PLC of a control that is not a SINUMERIK is only that of a simulator.
pub(super) fn identity(machine: &Machine) -> Identity<'static> {
    let profile = machine.names().profile;
    if profile == Profile::SINUMERIK_840D_SL {
        Identity::SINUMERIK_840D_SL
    } else if profile == Profile::SINUMERIK_828D {
        Identity::SINUMERIK_828D
    } else {
        Identity::SIMULATOR
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::s7::Machinery;

    #[test]
    fn values_of_a_file_replace_the_defaults() {
        let own = OwnIdentity::parse("order_number = \"6ES7 1\"\nversion = \"2.10.255\"\nplant = \"Hall 2\"", "a.toml");
        let base = Machinery::default().identity;
        let own = own.unwrap();
        let identity = own.over(base);
        assert_eq!((identity.order_number, identity.version, identity.plant), ("6ES7 1", [2, 10, 255], "Hall 2"));
        assert_eq!((identity.module_name, identity.serial_number), (base.module_name, base.serial_number));
    }

    #[test]
    fn errors_have_their_line() {
        for (text, said) in [
            ("plant = 7", "a.toml:1: expected a text"),
            ("\norder_number = \"123456789012345678901\"", "a.toml:2: expected at most 20 characters"),
            ("plant = \"Süd\"", "ASCII"),
            ("version = \"3.2\"", "three numbers"),
            ("version = \"3.2.256\"", "three numbers"),
            ("serial = \"1\"", "serial"),
        ] {
            let problem = OwnIdentity::parse(text, "a.toml").unwrap_err().to_string();
            assert!(problem.contains(said), "{text}: {problem}");
        }
    }
}
