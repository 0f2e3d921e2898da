//! One block while its statements are compiled: names become places, and instructions are added to the program.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::plc::step7::instruction::{
    BlockKind, BlockName, CallSite, Copy, Line, MakePointer, Number, Op, Operand as Place, ParameterSource, Register,
    Space, Width,
};
use crate::plc::step7::text::address::Address;
use crate::plc::step7::text::finding::{At, Fault, FindingKind};
use crate::plc::step7::text::shown;
use crate::plc::step7::text::syntax::{Operand, Statement, Step};
use crate::plc::step7::text::types::{Section, Type};

use super::declare::{Interface, Known, walk};
use super::parameters::local_use;

/// The tables of the program that grow with each block.
#[derive(Default)]
pub(in crate::plc::step7) struct Tables {
    pub(in crate::plc::step7) code: Vec<Op>,
    pub(in crate::plc::step7) lines: Vec<Line>,
    pub(in crate::plc::step7) copies: Vec<Copy>,
    pub(in crate::plc::step7) pointers: Vec<MakePointer>,
    pub(in crate::plc::step7) calls: Vec<CallSite>,
    pub(in crate::plc::step7) parameters: Vec<ParameterSource>,
    /// The index of each block with statements.
    pub(in crate::plc::step7) index: BTreeMap<BlockName, u16>,
    /// The ends of the used bytes of I, Q, M, and of timers and counters.
    pub(in crate::plc::step7) used: [u32; 5],
    /// Data blocks that are used and not in the sources.
    pub(in crate::plc::step7) foreign: std::collections::BTreeSet<u16>,
    /// Blocks of the basic program that are called and built in, by their indices and the numbers under which they are called.
    pub(in crate::plc::step7) basic: std::collections::BTreeSet<(BlockName, usize)>,
    /// Blocks that are called and nowhere.
    pub(in crate::plc::step7) missing: std::collections::BTreeSet<BlockName>,
    /// What the program has and the engine leaves out, each once, with block and network.
    pub(in crate::plc::step7) remarks: Vec<(String, Fault)>,
}

/// What an operand names.
#[derive(Clone, Debug)]
pub(in crate::plc::step7) enum Named {
    /// Memory; the type is known for variables.
    Variable(Place, Kind),
    Timer(Number),
    Counter(Number),
    /// A data block, or a parameter that is one.
    Data(Number),
    /// A parameter that is a function or a function block.
    Code(BlockKind, Number),
    Block(BlockName),
    Instance(BlockName, u32),
}

#[derive(Clone, Debug)]
pub(in crate::plc::step7) enum Kind {
    Width(Width),
    Typed(Type),
}

impl Kind {
    pub(in crate::plc::step7) fn width(&self) -> Option<Width> {
        match self {
            Self::Width(width) => Some(*width),
            Self::Typed(ty) => ty.width(),
        }
    }

    pub(in crate::plc::step7) fn name(&self) -> String {
        match self {
            Self::Width(width) => format!("an operand of the width {width:?}").to_lowercase(),
            Self::Typed(ty) => ty.name(),
        }
    }
}

pub(in crate::plc::step7) type Done<T = ()> = Result<T, Fault>;

/// A block while its statements are compiled.
pub(in crate::plc::step7) struct Unit<'k, 'a> {
    pub(in crate::plc::step7) known: &'k mut Known<'a>,
    pub(in crate::plc::step7) tables: &'k mut Tables,
    pub(in crate::plc::step7) name: BlockName,
    pub(in crate::plc::step7) interface: Arc<Interface>,
    /// Calls of missing blocks are left out.
    pub(in crate::plc::step7) ignores_missing: bool,
    /// Further faults of the statement that is compiled.
    pub(in crate::plc::step7) further: Vec<Fault>,
    labels: BTreeMap<String, (u32, At)>,
    jumps: Vec<(usize, String, At)>,
    /// Where the hidden local data for calls begin and end, in bits.
    hidden: u32,
    next_hidden: u32,
    last_hidden: u32,
    pub(in crate::plc::step7) line: Line,
}

impl<'k, 'a> Unit<'k, 'a> {
    pub(in crate::plc::step7) fn new(
        known: &'k mut Known<'a>,
        tables: &'k mut Tables,
        name: BlockName,
        interface: Arc<Interface>,
        statements: &[Statement],
        ignores_missing: bool,
    ) -> Self {
        // Blocks from LAD and FBD use local data beyond the declared ones.
        let used = statements.iter().filter_map(local_use).max().unwrap_or(0);
        let hidden = interface.temporary.bits().max(used).next_multiple_of(16);
        Self {
            known,
            tables,
            name,
            interface,
            ignores_missing,
            further: Vec::new(),
            labels: BTreeMap::new(),
            jumps: Vec::new(),
            hidden,
            next_hidden: hidden,
            last_hidden: hidden,
            line: Line::default(),
        }
    }

    pub(in crate::plc::step7) fn here(&self) -> u32 {
        u32::try_from(self.tables.code.len()).unwrap_or(u32::MAX)
    }

    pub(in crate::plc::step7) fn emit(&mut self, op: Op) {
        self.tables.code.push(op);
        self.tables.lines.push(self.line);
    }

    pub(in crate::plc::step7) fn label(&mut self, label: &str, at: At) -> Done {
        let here = self.here();
        if self.labels.insert(label.to_owned(), (here, at)).is_some() {
            return Err(Fault::new(at, format!("the label `{label}` is there twice"), "rename one of them"));
        }
        Ok(())
    }

    /// Emits a jump whose target is set at the end of the block.
    pub(in crate::plc::step7) fn jump(&mut self, op: Op, label: &str, at: At) {
        self.jumps.push((self.tables.code.len(), label.to_owned(), at));
        self.emit(op);
    }

    /// Sets the targets of the jumps, and returns the number of bytes of local data.
    pub(in crate::plc::step7) fn finish(mut self) -> (u32, Vec<Fault>) {
        let mut faults = Vec::new();
        for (index, label, at) in std::mem::take(&mut self.jumps) {
            let Some(&(target, _)) = self.labels.get(&label) else {
                let cure = crate::source::did_you_mean(
                    &label,
                    self.labels.keys().map(String::as_str),
                    "a jump ends at a label of its own block, and capitals count",
                );
                faults.push(Fault::new(at, format!("there is no label `{label}` in this block"), cure));
                continue;
            };
            match &mut self.tables.code[index] {
                Op::Jump(_, to) | Op::JumpList(_, to) => *to = target,
                _ => {}
            }
        }
        (self.last_hidden.next_multiple_of(16) / 8, faults)
    }

    /// Local data for a call, of whole bytes at an even address.
    pub(in crate::plc::step7) fn hide(&mut self, bits: u32) -> u32 {
        let bit = self.next_hidden;
        self.next_hidden = (bit + bits.max(8)).next_multiple_of(16);
        self.last_hidden = self.last_hidden.max(self.next_hidden);
        bit
    }

    /// The hidden local data can be used again.
    pub(in crate::plc::step7) fn forget_hidden(&mut self) {
        self.next_hidden = self.hidden;
    }

    fn is_function(&self) -> bool {
        matches!(self.name.kind, BlockKind::Fc | BlockKind::Sfc)
    }

    /// The place of a variable of the function block.
    fn own(&self, bit: u32) -> Place {
        if self.interface.is_version_1 { Place::Direct(Space::Instance, bit) } else { Place::Own(bit) }
    }

    /// A local variable or parameter; `None` if it is not declared.
    pub(in crate::plc::step7) fn local(&mut self, name: &str, path: &[Step], at: At) -> Done<Option<Named>> {
        let interface = Arc::clone(&self.interface);
        if let Some(field) = interface.temporary.field(name) {
            let (ty, offset) = walk(&field.ty, path, at)?;
            return Ok(Some(Named::Variable(Place::Direct(Space::Local, field.bit + offset), Kind::Typed(ty))));
        }
        let Some(field) = interface.layout.field(name) else { return Ok(None) };
        let index = interface.layout.fields.iter().position(|other| other.name == field.name).unwrap_or(0);
        let (ty, offset) = walk(&field.ty, path, at)?;
        if self.is_function() {
            let index = u16::try_from(index).unwrap_or(u16::MAX);
            if field.ty.is_number() {
                return Ok(Some(number(&ty, Number::Parameter(index))));
            }
            let place = if field.ty.is_complex() { Place::Element(index, offset) } else { Place::Parameter(index) };
            return Ok(Some(Named::Variable(place, Kind::Typed(ty))));
        }
        if let Type::Instance(of, _) = &ty
            && field.section == Section::Static
        {
            return Ok(Some(Named::Instance(*of, field.bit + offset)));
        }
        if ty.is_number() {
            return Ok(Some(number(&ty, Number::Own(field.bit + offset))));
        }
        let place = if field.is_pointer() { Place::Through(field.bit, offset) } else { self.own(field.bit + offset) };
        Ok(Some(Named::Variable(place, Kind::Typed(ty))))
    }

    /// What an operand names; `None` for constants and special operands.
    pub(in crate::plc::step7) fn named(&mut self, operand: &Operand, at: At) -> Done<Option<Named>> {
        let of_block = self.name;
        let unknown = |name: &str| {
            Fault::new(at, format!("`{name}` is not declared in {of_block}"), "declare it, or put a symbol in quotes")
        };
        Ok(Some(match operand {
            Operand::Local(name, path) | Operand::Bare(name, path) => {
                self.local(name, path, at)?.ok_or_else(|| unknown(name))?
            }
            Operand::Symbol(symbol, path) => self.symbol(symbol, path, at)?,
            Operand::SymbolData(symbol, width, bit) => match self.known.symbols.address(symbol) {
                Some(Address::Block(BlockName { kind: BlockKind::Db, number })) => {
                    self.block_data(number, *width, *bit)
                }
                Some(_) => {
                    let what = format!("expected a data block before the address, found \"{symbol}\"");
                    return Err(Fault::new(at, what, "write the symbol of a data block"));
                }
                None => return Err(self.known.unknown_symbol(symbol, at)),
            },
            &Operand::Memory(space, width, bit) => self.memory(space, width, bit),
            &Operand::BlockData(number, width, bit) => self.block_data(number, width, bit),
            Operand::BlockMember(number, path) => self.member(*number, path, at)?,
            Operand::Indirect(space, width, pointer) => {
                let (from, bit) = self.pointer(pointer, Width::Double, at)?;
                Named::Variable(Place::Indirect(*space, from, bit), Kind::Width(*width))
            }
            &Operand::Register(space, width, register, offset) => {
                Named::Variable(Place::Register(space, register, offset), Kind::Width(width))
            }
            &Operand::Timer(number) => {
                self.use_up(3, u32::from(number) + 1);
                Named::Timer(Number::Direct(number))
            }
            &Operand::Counter(number) => {
                self.use_up(4, u32::from(number) + 1);
                Named::Counter(Number::Direct(number))
            }
            Operand::TimerAt(pointer) => Named::Timer(self.number_at(pointer, at)?),
            Operand::CounterAt(pointer) => Named::Counter(self.number_at(pointer, at)?),
            &Operand::Block(name) => Named::Block(name),
            &Operand::InstanceBlock(number) => Named::Data(Number::Direct(number)),
            Operand::BlockAt(BlockKind::Db, _, pointer) => Named::Data(self.number_at(pointer, at)?),
            Operand::BlockAt(kind, _, pointer) => Named::Code(*kind, self.number_at(pointer, at)?),
            Operand::None
            | Operand::Constant(_)
            | Operand::Status(_)
            | Operand::Special(_)
            | Operand::AddressOf(..) => return Ok(None),
        }))
    }

    fn symbol(&mut self, symbol: &str, path: &[Step], at: At) -> Done<Named> {
        let Some(address) = self.known.symbols.address(symbol) else {
            return Err(self.known.unknown_symbol(symbol, at));
        };
        match address {
            Address::Block(BlockName { kind: BlockKind::Db, number }) if !path.is_empty() => {
                self.member(number, path, at)
            }
            _ if !path.is_empty() => Err(Fault::new(
                at,
                format!("expected a data block before `{}`, found \"{symbol}\"", shown::path(path)),
                "write the symbol of a data block, or remove the member",
            )),
            Address::Memory(space, width, bit) => Ok(self.memory(space, width, bit)),
            Address::Timer(number) => {
                self.use_up(3, u32::from(number) + 1);
                Ok(Named::Timer(Number::Direct(number)))
            }
            Address::Counter(number) => {
                self.use_up(4, u32::from(number) + 1);
                Ok(Named::Counter(Number::Direct(number)))
            }
            Address::Block(name) => Ok(Named::Block(name)),
            Address::Other => {
                let what = format!(
                    "expected an operand, found \"{symbol}\", a symbol of a variable table or a system data block"
                );
                Err(Fault::new(at, what, "write another symbol, or an address"))
            }
        }
    }

    fn memory(&mut self, space: Space, width: Width, bit: u32) -> Named {
        let end = (bit + width.bits()).div_ceil(8);
        match space {
            Space::Inputs => self.use_up(0, end),
            Space::Outputs => self.use_up(1, end),
            Space::Flags => self.use_up(2, end),
            Space::Peripheral => {
                self.use_up(0, end);
                self.use_up(1, end);
            }
            Space::Data | Space::Instance | Space::Local | Space::Caller => {}
        }
        Named::Variable(Place::Direct(space, bit), Kind::Width(width))
    }

    /// Notes how far an area is used.
    pub(in crate::plc::step7) fn use_up(&mut self, area: usize, end: u32) {
        self.tables.used[area] = self.tables.used[area].max(end);
    }

    fn block_data(&mut self, number: u16, width: Width, bit: u32) -> Named {
        self.note_block(number);
        Named::Variable(Place::Block(number, bit), Kind::Width(width))
    }

    /// Notes a data block that is not in the sources.
    pub(in crate::plc::step7) fn note_block(&mut self, number: u16) {
        if !self.known.data.contains_key(&number) {
            self.tables.foreign.insert(number);
        }
    }

    fn member(&mut self, number: u16, path: &[Step], at: At) -> Done<Named> {
        let Some(data) = self.known.data.get(&number) else {
            return Err(Fault::new(
                at,
                format!("the variables of DB{number} are not known, because it is not in the sources"),
                "add the source of the data block, or use an absolute address",
            ));
        };
        let (ty, bit) = walk(&Type::Struct(Arc::clone(&data.layout)), path, at)?;
        if ty.is_number() {
            return Ok(Named::Variable(Place::Block(number, bit), Kind::Width(Width::Word)));
        }
        Ok(Named::Variable(Place::Block(number, bit), Kind::Typed(ty)))
    }

    /// The place of a pointer in brackets.
    fn pointer(&mut self, pointer: &Operand, wanted: Width, at: At) -> Done<(Space, u32)> {
        let wrong = |found: &str| {
            let what = format!("expected a pointer in M, L, DB or DI with the width {wanted:?}, found {found}");
            Fault::new(at, what.to_lowercase(), "use MD, LD, DBD, DID, and for numbers MW, LW, DBW, DIW")
        };
        match self.named(pointer, at)? {
            Some(Named::Variable(Place::Direct(space, bit), kind)) => {
                let fits = matches!(space, Space::Flags | Space::Local | Space::Data | Space::Instance);
                if fits && kind.width() == Some(wanted) { Ok((space, bit)) } else { Err(wrong(&kind.name())) }
            }
            _ => Err(wrong(&pointer.to_string())),
        }
    }

    fn number_at(&mut self, pointer: &Operand, at: At) -> Done<Number> {
        let (space, bit) = self.pointer(pointer, Width::Word, at)?;
        Ok(Number::At(space, bit))
    }

    /// The place of an operand that must be memory of a width.
    pub(in crate::plc::step7) fn place(
        &mut self,
        operand: &Operand,
        allowed: &[Width],
        at: At,
    ) -> Done<(Width, Place)> {
        let wanted = allowed.iter().map(|width| format!("{width:?}").to_lowercase()).collect::<Vec<_>>().join(" or ");
        match self.named(operand, at)? {
            Some(Named::Variable(place, kind)) => match kind.width() {
                Some(width) if allowed.contains(&width) => {
                    if let (Width::Bit, Place::Direct(Space::Peripheral, _) | Place::Indirect(Space::Peripheral, ..)) =
                        (width, place)
                    {
                        return Err(Fault::new(at, "the peripheral area has no bits", "use bytes, or I and Q"));
                    }
                    Ok((width, place))
                }
                _ => {
                    let what = format!("expected an operand of the width {wanted}, found {operand}, {}", kind.name());
                    Err(Fault::new(at, what, "write an operand of this width"))
                }
            },
            _ => Err(Fault::new(
                at,
                format!("expected an operand of the width {wanted}, found {operand}"),
                "write an address or a variable",
            )),
        }
    }

    /// The address of a local name: of `P##name`.
    pub(in crate::plc::step7) fn address_of(&mut self, name: &str, path: &[Step], at: At) -> Done<AddressOf> {
        let interface = Arc::clone(&self.interface);
        if let Some(field) = interface.temporary.field(name) {
            let (_, offset) = walk(&field.ty, path, at)?;
            return Ok(AddressOf::Constant(0x86 << 24 | (field.bit + offset)));
        }
        let Some(field) = interface.layout.field(name) else {
            let what = format!("`{name}` is not declared in {}", self.name);
            return Err(Fault::new(at, what, "declare it"));
        };
        if self.is_function() {
            let index = interface.layout.fields.iter().position(|other| other.name == field.name).unwrap_or(0);
            if !path.is_empty() {
                let what = "the address of a part of a parameter is not known to the caller";
                return Err(Fault::new(at, what, "load the address of the parameter, and add the distance"));
            }
            return Ok(AddressOf::Parameter(u16::try_from(index).unwrap_or(u16::MAX)));
        }
        let (_, offset) = if field.is_pointer() { (Type::Pointer, 0) } else { walk(&field.ty, path, at)? };
        Ok(AddressOf::Constant(0x85 << 24 | (field.bit + offset)))
    }

    /// Notes a block that is called and nowhere.
    pub(in crate::plc::step7) fn missing(&mut self, name: BlockName, at: At) -> Done {
        let is_new = self.tables.missing.insert(name);
        if self.ignores_missing || !is_new {
            return Ok(());
        }
        if let Some((what, cure)) = Known::basic_missing(name).filter(|_| !self.known.sources.contains_key(&name)) {
            return Err(Fault { at, kind: FindingKind::Missing, what, cure });
        }
        Err(Fault {
            at,
            kind: FindingKind::Missing,
            what: if self.known.sources.contains_key(&name) {
                format!("{name} is called, is protected, and its source has no statements")
            } else {
                format!("{name} is called and is nowhere")
            },
            cure: "add its source, name a library function in `plc.toml`, or write `missing = \"ignore\"` there"
                .to_owned(),
        })
    }

    /// Loads an address register from the address of a local name.
    pub(in crate::plc::step7) fn register_from_address(&mut self, register: Register, address: AddressOf) {
        match address {
            AddressOf::Constant(value) => self.emit(Op::RegisterFromConstant(register, value)),
            AddressOf::Parameter(index) => self.emit(Op::RegisterFromParameterAddress(register, index)),
        }
    }
}

/// The address of a local name.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) enum AddressOf {
    Constant(u32),
    Parameter(u16),
}

fn number(ty: &Type, number: Number) -> Named {
    match ty {
        Type::Timer => Named::Timer(number),
        Type::Counter => Named::Counter(number),
        Type::BlockDb => Named::Data(number),
        Type::BlockFb => Named::Code(BlockKind::Fb, number),
        _ => Named::Code(BlockKind::Fc, number),
    }
}
