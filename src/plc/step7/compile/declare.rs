//! The first pass: names of blocks, data types, interfaces and data blocks.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::plc::step7::instruction::{BlockKind, BlockName};
use crate::plc::step7::system::layout_of;
use crate::plc::step7::text::address::Address;
use crate::plc::step7::text::constants::Constant;
use crate::plc::step7::text::finding::{At, Fault};
use crate::plc::step7::text::parser::is_void;
use crate::plc::step7::text::symbols::Symbols;
use crate::plc::step7::text::syntax::{Block, Body, Declaration, Declared, Name, Step};
use crate::plc::step7::text::types::{Array, Layout, Section, Type, store};

use super::settings::Settings;

/// How deep blocks and types may contain each other.
const DEEPEST: usize = 24;

/// What callers know of a block.
#[derive(Clone, Debug)]
pub(in crate::plc::step7) struct Interface {
    /// The parameters of a function; the instance of a function block.
    pub(in crate::plc::step7) layout: Layout,
    /// The variables in the local data.
    pub(in crate::plc::step7) temporary: Layout,
    pub(in crate::plc::step7) is_version_1: bool,
}

/// A data block: its variables, and its bytes as loaded.
#[derive(Clone, Debug)]
pub(in crate::plc::step7) struct Data {
    pub(in crate::plc::step7) layout: Arc<Layout>,
    pub(in crate::plc::step7) bytes: Vec<u8>,
    pub(in crate::plc::step7) instance_of: Option<BlockName>,
}

/// All blocks of a program by name.
pub(in crate::plc::step7) struct Known<'a> {
    pub(in crate::plc::step7) symbols: &'a Symbols,
    pub(in crate::plc::step7) sources: BTreeMap<BlockName, &'a Block>,
    /// Library functions by the names that `plc.toml` gives.
    pub(super) library: &'a BTreeMap<BlockName, String>,
    /// Blocks of the basic program that stay ours although the sources hold them.
    pub(super) ours: &'a [BlockName],
    /// The parameters of the first call of each block.
    pub(super) called: BTreeMap<BlockName, Vec<String>>,
    types: BTreeMap<BlockName, Type>,
    pub(in crate::plc::step7) interfaces: BTreeMap<BlockName, Arc<Interface>>,
    pub(in crate::plc::step7) data: BTreeMap<u16, Data>,
    open: Vec<BlockName>,
    pub(in crate::plc::step7) faults: Vec<Fault>,
}

impl<'a> Known<'a> {
    /// Reads the declarations of all blocks.
    pub(in crate::plc::step7) fn new(
        blocks: impl Iterator<Item = &'a Block>,
        symbols: &'a Symbols,
        settings: &'a Settings,
    ) -> Self {
        let mut known = Self {
            symbols,
            sources: BTreeMap::new(),
            library: &settings.library,
            ours: &settings.ours,
            called: BTreeMap::new(),
            types: BTreeMap::new(),
            interfaces: BTreeMap::new(),
            data: BTreeMap::new(),
            open: Vec::new(),
            faults: Vec::new(),
        };
        for block in blocks {
            known.enter(block);
        }
        known.note_calls();
        let names: Vec<_> = known.sources.keys().copied().collect();
        for name in names {
            let done = match name.kind {
                BlockKind::Udt => known.user_type(name, known.sources[&name].at).map(|_| ()),
                BlockKind::Db => known.data_block(name),
                _ => known.interface(name, known.sources[&name].at).map(|_| ()),
            };
            if let Err(fault) = done
                && !known.faults.contains(&fault)
            {
                known.faults.push(fault);
            }
        }
        known.add_instances();
        known
    }

    fn enter(&mut self, block: &'a Block) {
        let name = match self.block_name(&block.name, block.at) {
            Ok(name) => name,
            Err(fault) => return self.faults.push(fault),
        };
        if name.kind != block.kind {
            let what = format!("expected a block of the kind {:?}, found {name}", block.kind);
            return self.faults.push(Fault::new(block.at, what, "correct the symbol or the keyword"));
        }
        if self.sources.insert(name, block).is_some() {
            self.faults.push(Fault::new(block.at, format!("{name} is there twice"), "remove one of the two blocks"));
        }
    }

    /// The absolute name of a block.
    pub(in crate::plc::step7) fn block_name(&self, name: &Name, at: At) -> Result<BlockName, Fault> {
        match name {
            Name::Absolute(name) => Ok(*name),
            Name::Symbol(symbol) => match self.symbols.address(symbol) {
                Some(Address::Block(name)) => Ok(name),
                Some(_) => {
                    let what = format!("expected a block, found \"{symbol}\", the symbol of an address");
                    Err(Fault::new(at, what, "correct the symbol, or its row in the symbol table"))
                }
                None => Err(self.unknown_symbol(symbol, at)),
            },
        }
    }

    pub(in crate::plc::step7) fn unknown_symbol(&self, symbol: &str, at: At) -> Fault {
        let cure = crate::source::did_you_mean(
            &symbol.to_lowercase(),
            self.symbols.names(),
            "add it to the symbol table, and put the table beside the sources",
        );
        Fault::new(at, format!("the symbol \"{symbol}\" is not in the symbol table"), cure)
    }

    fn within<T>(
        &mut self,
        name: BlockName,
        at: At,
        read: impl FnOnce(&mut Self) -> Result<T, Fault>,
    ) -> Result<T, Fault> {
        if self.open.contains(&name) || self.open.len() > DEEPEST {
            return Err(Fault::new(at, format!("{name} contains itself, or is nested too deeply"), "break the circle"));
        }
        self.open.push(name);
        let done = read(self);
        self.open.pop();
        done
    }

    fn user_type(&mut self, name: BlockName, at: At) -> Result<Type, Fault> {
        if let Some(ty) = self.types.get(&name) {
            return Ok(ty.clone());
        }
        let Some(Block { body: Body::Type { ty }, .. }) = self.sources.get(&name).copied() else {
            return Err(Fault::new(at, format!("{name} is not in the sources"), "add the source of the data type"));
        };
        let ty = self.within(name, at, |known| known.resolve(ty, at))?;
        self.types.insert(name, ty.clone());
        Ok(ty)
    }

    /// The interface of a function or a function block, of the sources or built in.
    pub(in crate::plc::step7) fn interface(
        &mut self,
        name: BlockName,
        at: At,
    ) -> Result<Option<Arc<Interface>>, Fault> {
        if let Some(interface) = self.interfaces.get(&name) {
            return Ok(Some(Arc::clone(interface)));
        }
        if let Some(system) = self.built_in(name) {
            let layout = layout_of(system);
            let interface = Interface { layout, temporary: Layout::default(), is_version_1: false };
            return Ok(Some(self.keep(name, interface)));
        }
        let Some(&block) = self.sources.get(&name) else { return Ok(None) };
        let Body::Code { result, declarations, .. } = &block.body else { return Ok(None) };
        let interface = self.within(name, at, |known| known.read_interface(block, result.as_ref(), declarations))?;
        Ok(Some(self.keep(name, interface)))
    }

    fn keep(&mut self, name: BlockName, interface: Interface) -> Arc<Interface> {
        let interface = Arc::new(interface);
        self.interfaces.insert(name, Arc::clone(&interface));
        interface
    }

    fn read_interface(
        &mut self,
        block: &Block,
        result: Option<&Declared>,
        declarations: &[Declaration],
    ) -> Result<Interface, Fault> {
        let mut interface =
            Interface { layout: Layout::default(), temporary: Layout::default(), is_version_1: block.is_version_1 };
        let is_function = matches!(block.kind, BlockKind::Fc | BlockKind::Sfc);
        for declaration in declarations {
            let at = declaration.at;
            let is_wrong = match declaration.section {
                Section::Temp => false,
                Section::Static => is_function || block.kind == BlockKind::Ob,
                Section::Input | Section::Output | Section::InOut => block.kind == BlockKind::Ob,
            };
            // Functions of libraries declare their temporary variables as VAR.
            if is_wrong && !(is_function && declaration.section == Section::Static) {
                let what = format!(
                    "expected VAR_TEMP in an organization block, found `{}` in another section",
                    declaration.name
                );
                return Err(Fault::new(at, what, "declare it as VAR_TEMP"));
            }
            let layout = if declaration.section == Section::Temp || is_wrong {
                &mut interface.temporary
            } else {
                &mut interface.layout
            };
            self.add(layout, declaration)?;
            if interface.layout.field(&declaration.name).is_some()
                && interface.temporary.field(&declaration.name).is_some()
            {
                return Err(Fault::new(at, format!("`{}` is declared twice", declaration.name), "rename one of them"));
            }
        }
        if let Some(result) = result.filter(|_| !is_void(result)) {
            let ty = self.resolve(result, block.at)?;
            interface.layout.add("RET_VAL", ty, Section::Output);
        }
        Ok(interface)
    }

    /// Adds a variable with its initial values.
    fn add(&mut self, layout: &mut Layout, declaration: &Declaration) -> Result<(), Fault> {
        let at = declaration.at;
        if layout.field(&declaration.name).is_some() {
            return Err(Fault::new(at, format!("`{}` is declared twice", declaration.name), "rename one of them"));
        }
        let ty = self.resolve(&declaration.ty, at)?;
        let too_large = || Fault::new(at, "the variables take more than 64 KiB", "make the block smaller");
        let bit = layout.add(&declaration.name, ty.clone(), declaration.section).ok_or_else(too_large)?;
        let is_stored = declaration.section != Section::InOut || !ty.is_complex();
        if is_stored {
            fill(&mut layout.image, bit, &ty, &declaration.initial, at)?;
        }
        Ok(())
    }

    /// A declared type with its layout.
    fn resolve(&mut self, declared: &Declared, at: At) -> Result<Type, Fault> {
        match declared {
            Declared::Elementary(ty) => Ok(ty.clone()),
            Declared::Array(ranges, element) => {
                let element = self.resolve(element, at)?;
                let array = Array { ranges: ranges.clone(), element };
                if !array.is_possible() {
                    let what = "expected a range from low to high and at most 64 KiB";
                    return Err(Fault::new(at, what, "correct the ranges of the array"));
                }
                Ok(Type::Array(Arc::new(array)))
            }
            Declared::Struct(declarations) => {
                let mut layout = Layout::default();
                for declaration in declarations {
                    self.add(&mut layout, declaration)?;
                }
                Ok(Type::Struct(Arc::new(layout)))
            }
            Declared::Named(at, name) => {
                let name = self.block_name(name, *at)?;
                if name.kind == BlockKind::Udt {
                    return self.user_type(name, *at);
                }
                match self.interface(name, *at)? {
                    Some(interface) => Ok(Type::Instance(name, Arc::new(interface.layout.clone()))),
                    None => {
                        Err(Fault::new(*at, format!("{name} is not in the sources"), "add the source of the block"))
                    }
                }
            }
        }
    }

    fn data_block(&mut self, name: BlockName) -> Result<(), Fault> {
        let Some(block) = self.sources.get(&name).copied() else { return Ok(()) };
        let Body::Data { ty, values } = &block.body else { return Ok(()) };
        let ty = self.resolve(ty, block.at)?;
        let (layout, instance_of) = match &ty {
            Type::Struct(layout) => (Arc::clone(layout), None),
            Type::Instance(of, layout) => (Arc::clone(layout), Some(*of)),
            other => {
                let what = format!("expected STRUCT, a UDT or an FB, found {}", other.name());
                return Err(Fault::new(block.at, what, "give the type of the data block"));
            }
        };
        let mut bytes = layout.image.clone();
        for (at, path, value) in values {
            let done = walk(&Type::Struct(Arc::clone(&layout)), path, *at)
                .and_then(|(ty, bit)| fill(&mut bytes, bit, &ty, &[(1, value.clone())], *at));
            if let Err(fault) = done {
                self.faults.push(fault);
            }
        }
        self.data.insert(name.number, Data { layout, bytes, instance_of });
        Ok(())
    }
}

/// Writes initial values, one after the other into the elements of an array.
fn fill(bytes: &mut [u8], bit: u32, ty: &Type, values: &[(u32, Constant)], at: At) -> Result<(), Fault> {
    let wrong = |expected| Fault::new(at, format!("expected {expected}"), "correct the initial value");
    let mut values = values.iter().flat_map(|(count, value)| std::iter::repeat_n(value, *count as usize));
    if let Type::Array(array) = ty {
        let elements = array.count();
        for (index, value) in values.enumerate() {
            let index = u32::try_from(index).unwrap_or(u32::MAX);
            if index >= elements {
                return Err(wrong(format!("at most {elements} values, found more")));
            }
            store(bytes, bit + array.offset_of(index), &array.element, value).map_err(wrong)?;
        }
        return Ok(());
    }
    if let Some(value) = values.next() {
        store(bytes, bit, ty, value).map_err(wrong)?;
    }
    Ok(())
}

/// The type and the bit address of a part of a variable.
pub(in crate::plc::step7) fn walk(ty: &Type, path: &[Step], at: At) -> Result<(Type, u32), Fault> {
    let mut ty = ty.clone();
    let mut bit = 0;
    for step in path {
        let next = match (&ty, step) {
            (Type::Struct(layout) | Type::Instance(_, layout), Step::Member(name)) => match layout.field(name) {
                Some(field) if field.is_pointer() => {
                    let what = format!("`{name}` is an in-out parameter that is passed by pointer");
                    return Err(Fault::new(at, what, "reach it from within its block"));
                }
                Some(field) => {
                    bit += field.bit;
                    field.ty.clone()
                }
                None => {
                    let names = layout.fields.iter().map(|field| field.name.as_str());
                    let cure = crate::source::did_you_mean(name, names, "check the declaration");
                    return Err(Fault::new(at, format!("there is no `{name}` in this structure"), cure));
                }
            },
            (Type::Array(array), Step::Index(indices)) => {
                let Some(number) = array.number_of(indices) else {
                    let what = format!("the index {indices:?} is outside of the array {:?}", array.ranges);
                    return Err(Fault::new(at, what, "use indices within its ranges"));
                };
                bit += array.offset_of(number);
                array.element.clone()
            }
            (Type::Text(length), Step::Index(indices)) => match indices[..] {
                [index] if (1..=i64::from(*length)).contains(&index) => {
                    bit += (u32::try_from(index).unwrap_or(0) + 1) * 8;
                    Type::Char
                }
                _ => {
                    let what = format!("expected an index from 1 to {length}, found {indices:?}");
                    return Err(Fault::new(at, what, "a STRING has as many characters as its declaration says"));
                }
            },
            (ty, Step::Member(name)) => {
                let what = format!("expected a structure before `.{name}`, found {}", ty.name());
                return Err(Fault::new(at, what, "remove the member, or check the declaration"));
            }
            (ty, Step::Index(_)) => {
                let what = format!("expected an array before the index, found {}", ty.name());
                return Err(Fault::new(at, what, "remove the index, or check the declaration"));
            }
        };
        ty = next;
    }
    Ok((ty, bit))
}
