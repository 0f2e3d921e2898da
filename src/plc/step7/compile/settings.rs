//! How sources are compiled.

use std::collections::BTreeMap;

use crate::plc::step7::instruction::BlockName;
use crate::plc::step7::text::mnemonics::Language;

/// How sources are compiled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Calls of blocks that are nowhere are left out.
    pub ignores_missing: bool,
    /// Library functions by their numbers: `FC210` is `SCALE`.
    pub library: BTreeMap<BlockName, String>,
    /// Blocks of the basic program that stay ours although the sources hold them.
    pub ours: Vec<BlockName>,
    /// The language of the operations of files that do not show it themselves; without it that of the other files.
    pub language: Option<Language>,
    /// The languages of single files, by their names.
    pub languages: BTreeMap<String, Language>,
    /// The least numbers of bytes of I, Q, M, and of timers and counters.
    pub least: [u32; 5],
}

impl Default for Settings {
    /// Calls of missing blocks are findings; the areas are at least as large as in a machine without a program.
    fn default() -> Self {
        Self {
            ignores_missing: false,
            library: BTreeMap::new(),
            ours: Vec::new(),
            language: None,
            languages: BTreeMap::new(),
            least: [128, 128, 256, 32, 32],
        }
    }
}
