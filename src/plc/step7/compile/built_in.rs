//! Which calls are of built-in blocks: system blocks by their number, functions of libraries by their name, blocks of the basic program by their
//! number and parameters. A block of the sources with statements wins.

use crate::plc::step7::basic_program;
use crate::plc::step7::instruction::{BlockKind, BlockName};
use crate::plc::step7::system::{BASIC, by_name, by_number, layout_of};
use crate::plc::step7::text::address::Address;
use crate::plc::step7::text::syntax::{Body, Operand};
use std::sync::Arc;

use super::declare::{Data, Known};

impl Known<'_> {
    /// The index of a built-in block: by its number; for a function by its name in `plc.toml`, in the header or in the symbol table; for a block of
    /// the basic program by its number, if the parameters of its first call are ours.
    pub(in crate::plc::step7) fn built_in(&self, name: BlockName) -> Option<usize> {
        if let Some(index) = by_number(name) {
            return Some(index);
        }
        if !matches!(name.kind, BlockKind::Fc | BlockKind::Fb) {
            return None;
        }
        if self.ours.contains(&name)
            && let Some(index) = basic_program::by_number(name)
        {
            return Some(BASIC + index);
        }
        let named = |text: &str| {
            let library = if name.kind == BlockKind::Fc { by_name(text) } else { None };
            library.or_else(|| basic_program::by_name(name.kind, text).map(|index| BASIC + index))
        };
        if let Some(library) = self.library.get(&name) {
            return named(library);
        }
        let source = self.sources.get(&name);
        let is_empty =
            source.is_none_or(|block| matches!(&block.body, Body::Code { statements, .. } if statements.is_empty()));
        if !is_empty {
            return None;
        }
        let header = source.and_then(|block| block.header_name.as_deref());
        let by_text = header.and_then(named).or_else(|| self.symbols.of_block(name).and_then(named));
        by_text.or_else(|| self.by_parameters(name))
    }

    /// The basic program and the IEC library share numbers: the parameters of a call tell them apart.
    fn by_parameters(&self, name: BlockName) -> Option<usize> {
        let index = BASIC + basic_program::by_number(name)?;
        let mut used: Vec<&str> =
            self.called.get(&name).map_or_else(Vec::new, |used| used.iter().map(String::as_str).collect());
        if let Some(block) = self.sources.get(&name) {
            // An interface without statements: its own parameters say what it is.
            let Body::Code { declarations, .. } = &block.body else { return None };
            if !block.is_protected {
                return None;
            }
            used.extend(declarations.iter().map(|declaration| declaration.name.as_str()));
        }
        if used.is_empty() {
            return (name.kind == BlockKind::Fb || layout_of(index).fields.is_empty()).then_some(index);
        }
        let fitting = |index: usize| {
            let layout = layout_of(index);
            used.iter().filter(|parameter| layout.field(parameter).is_some()).count()
        };
        let iec = basic_program::iec_name(name.number).filter(|_| name.kind == BlockKind::Fc).and_then(by_name);
        let best = iec.into_iter().chain([index]).max_by_key(|index| fitting(*index))?;
        (fitting(best) > 0).then_some(best)
    }

    /// What to say of a block of the basic program that a call does not reach: what is wrong, and the cure.
    pub(super) fn basic_missing(name: BlockName) -> Option<(String, String)> {
        let own = format!("or add the source of your own {name}");
        if let Some(block) = basic_program::by_number(name).and_then(|index| basic_program::BLOCKS.get(index)) {
            let names: Vec<&str> = block.layout.fields.iter().map(|field| &*field.name).collect();
            let cure = match names.as_slice() {
                [] => format!("call it without parameters, {own}"),
                names => format!("pass its parameters ({}), {own}", names.join(", ")),
            };
            let what = format!("{name} is the built-in {} only if a call has its parameters", block.name);
            return Some((what, cure));
        }
        let is_basic = match name.kind {
            BlockKind::Fb => matches!(name.number, 5 | 7 | 9 | 10 | 11 | 29),
            BlockKind::Fc => matches!(name.number, 13 | 17 | 21 | 26),
            _ => false,
        };
        is_basic.then(|| {
            let what = format!("{name} is called and is nowhere; the basic program has one, which is not built in");
            (what, format!("add the source of your own {name}, or write `missing = \"ignore\"` in `plc.toml`"))
        })
    }

    /// The block that an operand names.
    fn block_of(&self, operand: &Operand) -> Option<BlockName> {
        match operand {
            Operand::Block(name) => Some(*name),
            Operand::Symbol(symbol, path) if path.is_empty() => match self.symbols.address(symbol) {
                Some(Address::Block(name)) => Some(name),
                _ => None,
            },
            _ => None,
        }
    }

    /// Notes the parameters of the first call of each block.
    pub(super) fn note_calls(&mut self) {
        let mut called = std::mem::take(&mut self.called);
        for block in self.sources.values() {
            let Body::Code { statements, .. } = &block.body else { continue };
            for statement in statements.iter().filter(|statement| !statement.parameters.is_empty()) {
                if let Some(name) = self.block_of(&statement.operand) {
                    called.entry(name).or_insert_with(|| {
                        statement.parameters.iter().map(|parameter| parameter.name.clone()).collect()
                    });
                }
            }
        }
        self.called = called;
    }

    /// Instances of blocks of the basic program that the sources call and do not have.
    pub(super) fn add_instances(&mut self) {
        let mut wanted = Vec::new();
        for block in self.sources.values() {
            let Body::Code { statements, .. } = &block.body else { continue };
            for statement in statements {
                let (Some(name), Some(instance)) =
                    (self.block_of(&statement.operand), self.block_of(&statement.instance))
                else {
                    continue;
                };
                if instance.kind == BlockKind::Db
                    && let Some(index) = self.built_in(name).filter(|index| *index >= BASIC)
                {
                    wanted.push((instance.number, name, index));
                }
            }
        }
        let is_of_services = |(_, name, index): &(u16, BlockName, usize)| {
            name.kind == BlockKind::Fb && basic_program::is_service(*index - BASIC)
        };
        if wanted.iter().any(is_of_services) && !self.data.contains_key(&basic_program::SERVICE_BLOCK) {
            let layout = basic_program::service_names();
            let bytes = layout.image.clone();
            let data = Data { layout: Arc::new(layout), bytes, instance_of: None };
            self.data.insert(basic_program::SERVICE_BLOCK, data);
        }
        for (number, name, index) in wanted {
            self.data.entry(number).or_insert_with(|| {
                let layout = layout_of(index);
                let bytes = layout.image.clone();
                Data { layout: Arc::new(layout), bytes, instance_of: Some(name) }
            });
        }
    }
}
