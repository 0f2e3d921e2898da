//! The compiler: two passes over all sources, interfaces first, so that the order of blocks and files does not matter.
//!
//! All findings are collected, and a program exists only if there are none that prevent it.

mod built_in;
mod calls;
mod declare;
mod parameters;
mod settings;
mod statements;
mod unit;

use std::sync::Arc;

use super::instruction::{BlockKind, BlockName};
use super::program::{CodeBlock, Program, ProgramBlock, Sizes};
use super::text::finding::{Fault, Finding, FindingKind};
use super::text::mnemonics::Language;
use super::text::parser::{Parsed, parse};
use super::text::symbols::{SymbolForm, Symbols};
use super::text::syntax::{Block, Body};

use declare::Known;
pub use settings::Settings;
use unit::{Tables, Unit};

/// What a file contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceKind {
    /// Blocks with statements and data.
    Statements,
    /// A symbol table.
    Symbols(SymbolForm),
}

/// A file as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// The name for messages.
    pub name: String,
    /// The text.
    pub text: String,
    /// What it contains.
    pub kind: SourceKind,
}

impl Source {
    /// A source with blocks.
    #[must_use]
    pub fn statements(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), kind: SourceKind::Statements }
    }
}

/// What the compiler found: a program, or what prevents it.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The program; `None` if a finding prevents it.
    pub program: Option<Program>,
    /// The findings, in the order of files and lines.
    pub findings: Vec<Finding>,
    /// What the program has and the engine leaves out, each once: calls that do nothing, and organization blocks that are never called.
    pub remarks: Vec<Finding>,
    /// The blocks of the sources, with their symbols and their numbers of statements.
    pub blocks: Vec<(BlockName, Option<String>, usize)>,
    /// The language of each source with statements, by the name of the file.
    pub languages: Vec<(String, Language)>,
}

/// A fault with the block and the network in which it is.
type Placed = (String, Fault);

/// Compiles sources and symbol tables.
#[must_use]
pub fn compile(sources: &[Source], settings: &Settings) -> Compiled {
    let mut faults: Vec<Placed> = Vec::new();
    let mut symbols = Symbols::default();
    let mut parsed = Vec::new();
    let mut languages = Vec::new();
    let mut files = Vec::new();
    for (index, source) in sources.iter().enumerate() {
        let file = u16::try_from(index).unwrap_or(u16::MAX);
        match source.kind {
            SourceKind::Symbols(form) => {
                faults.extend(symbols.read(&source.text, form, file).into_iter().map(|fault| (String::new(), fault)));
            }
            SourceKind::Statements => {
                let mut read = parse(&source.text, file);
                faults.extend(read.faults.drain(..).map(|fault| (String::new(), fault)));
                files.push((source.name.as_str(), read));
            }
        }
    }
    let of_folder =
        settings.language.or_else(|| Language::of_balance(files.iter().map(|(_, read)| read.balance).sum()));
    for (name, Parsed { blocks, balance, differs, .. }) in files {
        let own = language_of_file(settings, name).or_else(|| Language::of_balance(balance));
        if let (None, None, Some((at, word))) = (own, of_folder, differs) {
            let what = format!(
                "expected operations that are German or international, found only such that are both, and `{word}`"
            );
            let cure = "`SE` is an on-delay timer in German and an extended pulse in international operations: \
                write `language = \"German\"` or `language = \"international\"` in `plc.toml`";
            faults.push((String::new(), Fault::new(at, what, cure)));
        }
        let language = own.or(of_folder).unwrap_or(Language::International);
        languages.push((name.to_owned(), language));
        parsed.extend(blocks.into_iter().map(|block| (block, language)));
    }
    let mut known = Known::new(parsed.iter().map(|(block, _)| block), &symbols, settings);
    let language_of = |block: &Block| {
        parsed
            .iter()
            .find(|(other, _)| std::ptr::eq(other, block))
            .map_or(Language::International, |(_, language)| *language)
    };
    let list: Vec<_> = known.sources.iter().map(|(name, block)| (*name, *block, language_of(block))).collect();
    let mut builder = Builder::new(&known, &list);
    for (name, block, language) in &list {
        faults.extend(builder.block(&mut known, *name, block, *language, settings.ignores_missing));
    }
    faults.extend(known.faults.iter().map(|fault| (String::new(), fault.clone())));
    let blocks = list
        .iter()
        .map(|(name, block, _)| {
            let count = match &block.body {
                Body::Code { statements, .. } => statements.len(),
                Body::Data { .. } | Body::Type { .. } => 0,
            };
            (*name, symbols.of_block(*name).map(str::to_owned), count)
        })
        .collect();
    let findings = findings(faults, sources);
    let mut remarks = std::mem::take(&mut builder.tables.remarks);
    let never = list.iter().filter(|(name, ..)| name.kind == BlockKind::Ob && !is_called(name.number));
    remarks.extend(never.map(|(name, block, _)| {
        (String::new(), Fault::unsupported(block.at, format!("{name} is compiled and never called")))
    }));
    let remarks = self::findings(remarks, sources);
    let program = findings.is_empty().then(|| builder.finish(&known, settings, sources));
    Compiled { program, findings, remarks, blocks, languages }
}

/// The language that `plc.toml` gives for a file, by its name without folders.
fn language_of_file(settings: &Settings, name: &str) -> Option<Language> {
    let file = std::path::Path::new(name).file_name()?.to_str()?;
    settings.languages.get(file).copied()
}

/// The findings in the order of files and lines; what is not supported is listed once.
fn findings(faults: Vec<Placed>, sources: &[Source]) -> Vec<Finding> {
    let mut faults = faults;
    faults.sort_by_key(|(_, a)| a.at);
    faults.dedup_by(|a, b| a.1 == b.1);
    let mut listed = Vec::new();
    faults.retain(|(_, fault)| {
        let is_new = fault.kind == FindingKind::Error || !listed.contains(&fault.what);
        if is_new && fault.kind != FindingKind::Error {
            listed.push(fault.what.clone());
        }
        is_new
    });
    let file = |index: u16| sources.get(usize::from(index)).map_or(String::new(), |source| source.name.clone());
    faults
        .into_iter()
        .map(|(context, fault)| Finding {
            kind: fault.kind,
            file: file(fault.at.file),
            line: fault.at.line,
            column: fault.at.column,
            context,
            what: fault.what,
            cure: fault.cure,
        })
        .collect()
}

/// Whether the engine calls an organization block.
fn is_called(number: u16) -> bool {
    matches!(number, 1 | 10..=17 | 20..=23 | 30..=38 | 40 | 60 | 80 | 100 | 102 | 121 | 122)
}

/// The FNV-1a hash of the texts.
fn fingerprint(sources: &[Source]) -> u64 {
    let bytes = sources.iter().flat_map(|source| source.text.bytes().chain([0]));
    bytes.fold(0xCBF2_9CE4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3))
}

/// The program while its blocks are added.
struct Builder {
    tables: Tables,
    blocks: Vec<CodeBlock>,
    statements: u32,
}

impl Builder {
    /// Gives each block with statements its index, so that calls need no order.
    fn new(known: &Known<'_>, list: &[(BlockName, &Block, Language)]) -> Self {
        let mut tables = Tables::default();
        let code = list.iter().filter(|(name, block, _)| {
            matches!(&block.body, Body::Code { statements, .. } if !(block.is_protected && statements.is_empty()))
                && !matches!(name.kind, BlockKind::Sfc | BlockKind::Sfb)
                && known.built_in(*name).is_none()
        });
        for (index, (name, ..)) in code.enumerate() {
            tables.index.insert(*name, u16::try_from(index).unwrap_or(u16::MAX));
        }
        Self { tables, blocks: Vec::new(), statements: 0 }
    }

    fn block(
        &mut self,
        known: &mut Known<'_>,
        name: BlockName,
        block: &Block,
        language: Language,
        ignores_missing: bool,
    ) -> Vec<Placed> {
        let Body::Code { statements, .. } = &block.body else { return Vec::new() };
        if !self.tables.index.contains_key(&name) {
            return Vec::new();
        }
        // A fault of the interface was already found.
        let Ok(Some(interface)) = known.interface(name, block.at) else { return Vec::new() };
        let is_function = name.kind == BlockKind::Fc;
        let parameters = if is_function { interface.layout.fields.len() } else { 0 };
        let symbol = known.symbols.of_block(name).map(str::to_owned);
        let mut unit = Unit::new(known, &mut self.tables, name, interface, statements, ignores_missing);
        let start = unit.here();
        let found = unit.statements(statements, language);
        let (local, unfinished) = unit.finish();
        self.blocks.push(CodeBlock {
            name,
            symbol,
            start,
            local,
            parameters: u16::try_from(parameters).unwrap_or(u16::MAX),
        });
        self.statements = self.statements.saturating_add(u32::try_from(statements.len()).unwrap_or(u32::MAX));
        let within = |network: u16| format!("{name}, network {network}");
        let mut placed: Vec<Placed> = found.into_iter().map(|(network, fault)| (within(network), fault)).collect();
        placed.extend(unfinished.into_iter().map(|fault| (name.to_string(), fault)));
        placed
    }

    fn finish(self, known: &Known<'_>, settings: &Settings, sources: &[Source]) -> Program {
        let used = |area: usize| self.tables.used[area].max(settings.least[area]);
        let sizes = Sizes { inputs: used(0), outputs: used(1), flags: used(2), timers: used(3), counters: used(4) };
        let block = |(&number, data): (&u16, &declare::Data)| ProgramBlock {
            number,
            symbol: known.symbols.of_block(BlockName { kind: BlockKind::Db, number }).map(str::to_owned),
            bytes: data.bytes.clone(),
        };
        Program {
            code: self.tables.code,
            lines: self.tables.lines,
            blocks: self.blocks,
            index: self.tables.index,
            copies: self.tables.copies,
            pointers: self.tables.pointers,
            calls: self.tables.calls,
            parameters: self.tables.parameters,
            data: known.data.iter().map(block).collect(),
            sizes,
            files: sources.iter().map(|source| source.name.clone()).collect(),
            statements: self.statements,
            fingerprint: fingerprint(sources),
            symbols: Arc::new(known.symbols.by_address()),
            basic: self.tables.basic.into_iter().collect(),
            ignored: self.tables.missing.into_iter().collect(),
            foreign: self.tables.foreign.into_iter().collect(),
        }
    }
}
