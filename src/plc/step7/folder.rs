//! A folder with a STEP 7 program: `*.awl`, a symbol table, and `plc.toml`.

use std::path::Path;

use crate::source::{Place, Problem, Table, Value, read_text, unreadable};
use crate::units::Time;

use super::basic_program::by_name;
use super::compile::{Settings, Source, SourceKind};
use super::instruction::{BlockKind, BlockName};
use super::text::address::{Address, parse};
use super::text::mnemonics::Language;
use super::text::symbols::SymbolForm;

/// What `plc.toml` sets.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlcToml {
    /// The cycle of OB1; the NC cycle by default.
    pub cycle: Option<Time>,
    /// The periods of OB30 to OB38.
    pub cyclic: [Option<Time>; 9],
    /// How the sources are compiled.
    pub settings: Settings,
    /// The files that it names, and where.
    named_files: Vec<(String, Place)>,
}

/// The text of a program in a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Folder {
    /// The sources and symbol tables, by name.
    pub sources: Vec<Source>,
    /// `plc.toml`, or its defaults.
    pub toml: PlcToml,
}

/// The keys of `[areas]`, in the order of [`Settings::least`], with their limits.
const AREAS: [(&str, i64); 5] = [("I", 65_536), ("Q", 65_536), ("M", 65_536), ("T", 65_536), ("C", 65_536)];

/// The languages of the operations.
const LANGUAGES: &[(&str, Language)] = &[("German", Language::German), ("international", Language::International)];

/// The keys of the periods of OB30 to OB38.
const CYCLIC: [&str; 9] = ["ob30", "ob31", "ob32", "ob33", "ob34", "ob35", "ob36", "ob37", "ob38"];

impl Folder {
    /// Reads a folder.
    ///
    /// # Errors
    /// It cannot be read, has no source, or `plc.toml` is wrong.
    pub fn read(folder: &Path) -> Result<Self, Problem> {
        let entries = std::fs::read_dir(folder).map_err(|error| unreadable(folder, &error))?;
        let mut paths = Vec::new();
        for entry in entries {
            paths.push(entry.map_err(|error| unreadable(folder, &error))?.path());
        }
        paths.sort();
        let mut sources = Vec::new();
        for path in &paths {
            let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase();
            let kind = match SymbolForm::of(&ending) {
                Some(form) => SourceKind::Symbols(form),
                None if ending == "awl" || ending == "stl" => SourceKind::Statements,
                None => continue,
            };
            sources.push(Source { name: path.display().to_string(), text: read_text(path)?, kind });
        }
        if !sources.iter().any(|source| source.kind == SourceKind::Statements) {
            return Err(Place::file(&folder.display().to_string()).problem(
                "expected at least one source `*.awl`, found none",
                "export the blocks by \"generate source\"",
            ));
        }
        if sources.len() > usize::from(u16::MAX) {
            return Err(
                Place::file(&folder.display().to_string()).problem("more than 65535 sources", "join some of them")
            );
        }
        let toml = folder.join("plc.toml");
        let toml = if toml.exists() {
            PlcToml::parse(&read_text(&toml)?, &toml.display().to_string())?
        } else {
            PlcToml::default()
        };
        for (file, place) in &toml.named_files {
            let names = sources.iter().filter_map(|source| Path::new(&source.name).file_name()?.to_str());
            if !names.clone().any(|name| name == file) {
                let cure = crate::source::did_you_mean(file, names, "write the name of a source of this folder");
                return Err(place.problem(format!("expected the name of a source, found `{file}`"), cure));
            }
        }
        Ok(Self { sources, toml })
    }
}

impl PlcToml {
    /// Reads the text of `plc.toml`.
    ///
    /// # Errors
    /// The first key or value that is wrong.
    pub fn parse(text: &str, file: &str) -> Result<Self, Problem> {
        let mut table = Table::parse(text, file)?;
        let mut toml = Self::default();
        let periods = CYCLIC.into_iter().zip(&mut toml.cyclic);
        for (key, value) in [("cycle", &mut toml.cycle)].into_iter().chain(periods) {
            if let Some(node) = table.take(key) {
                let time = Time::parse(node.text("a duration")?).filter(|&time| time > Time::ZERO);
                *value = Some(time.ok_or_else(|| node.expected("a duration longer than 0", "write \"10ms\""))?);
            }
        }
        if let Some(node) = table.take("missing") {
            toml.settings.ignores_missing = node.one_of(&[("refuse", false), ("ignore", true)])?;
        }
        if let Some(node) = table.take("language") {
            toml.settings.language = Some(node.one_of(LANGUAGES)?);
        }
        if let Some(node) = table.take("languages") {
            for (file, place, node) in node.into_table("a table of files")?.take_rest() {
                toml.settings.languages.insert(file.clone(), node.one_of(LANGUAGES)?);
                toml.named_files.push((file, place));
            }
        }
        if let Some(node) = table.take("blocks") {
            toml.blocks(node.into_table("a table of blocks")?)?;
        }
        if let Some(node) = table.take("areas") {
            let mut areas = node.into_table("a table of areas")?;
            for ((key, limit), least) in AREAS.into_iter().zip(&mut toml.settings.least) {
                if let Some(node) = areas.take(key) {
                    let size = node.integer("a size")?;
                    let size = u32::try_from(size).ok().filter(|&size| i64::from(size) <= limit);
                    *least =
                        size.ok_or_else(|| node.expected(&format!("a size from 0 to {limit}"), "correct the size"))?;
                }
            }
            areas.finish()?;
        }
        table.finish()?;
        Ok(toml)
    }

    fn blocks(&mut self, mut table: Table) -> Result<(), Problem> {
        if let Some(node) = table.take("ours") {
            for entry in node.into_list() {
                let name = entry.text("a block, as \"FC10\"")?;
                let block = block(name)
                    .ok_or_else(|| entry.expected("a block, as \"FC10\"", "write the kind and the number"))?;
                self.settings.ours.push(block);
            }
        }
        for (key, place, node) in table.take_rest() {
            let Some(name) = block(&key).filter(|name| name.kind == BlockKind::Fc) else {
                let what = format!("expected `ours` or a function, as `FC210`, found `{key}`");
                return Err(place.problem(what, "write `ours = [\"FC10\"]`, or `FC210 = \"SCALE\"`"));
            };
            let Value::Text(library) = &node.value else {
                return Err(node.expected("the name of a library function", "write FC210 = \"SCALE\""));
            };
            if super::system::by_name(library).or_else(|| by_name(name.kind, library)).is_none() {
                let names: Vec<_> =
                    super::system::SYSTEM.iter().filter(|row| row.block.is_none()).map(|row| row.name).collect();
                return Err(node.expected(
                    &format!("one of the library functions {}", names.join(", ")),
                    &crate::source::did_you_mean(library, names, "this function is not built in"),
                ));
            }
            self.settings.library.insert(name, library.clone());
        }
        Ok(())
    }
}

fn block(text: &str) -> Option<BlockName> {
    match parse(text) {
        Some(Address::Block(name)) => Some(name),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plc_toml_is_read_and_wrong_keys_are_named() {
        let text = "cycle = \"10ms\"\nob35 = \"100ms\"\nmissing = \"ignore\"\n[blocks]\nours = [\"FB1\"]\nFC210 = \"SCALE\"\n[areas]\nM = 4096\n";
        let toml = PlcToml::parse(text, "plc.toml").unwrap();
        assert_eq!((toml.cycle, toml.cyclic[5]), (Some(Time::from_millis(10)), Some(Time::from_millis(100))));
        let periods = PlcToml::parse("ob30 = \"3s\"\nob38 = \"8ms\"", "plc.toml").unwrap().cyclic;
        assert_eq!(
            (periods[0], periods[5], periods[8]),
            (Some(Time::from_millis(3000)), None, Some(Time::from_millis(8)))
        );
        assert!(toml.settings.ignores_missing);
        assert_eq!(toml.settings.least, [128, 128, 4096, 32, 32]);
        assert_eq!(toml.settings.ours, [BlockName { kind: BlockKind::Fb, number: 1 }]);
        assert_eq!(toml.settings.library[&BlockName { kind: BlockKind::Fc, number: 210 }], "SCALE");
        for (text, wanted) in [
            ("cycle = 10", "duration"),
            ("[blocks]\nFC1 = \"SCALLE\"", "SCALE"),
            ("[blocks]\nDB1 = \"SCALE\"", "DB1"),
            ("[areas]\nM = -1", "size"),
            ("cycel = \"1ms\"", "cycle"),
        ] {
            let problem = PlcToml::parse(text, "plc.toml").unwrap_err().to_string();
            assert!(problem.contains(wanted), "{problem}");
        }
    }
}
