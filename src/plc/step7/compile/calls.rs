//! `CALL`: instructions that pass parameters, the call, and instructions that fetch results.
//!
//! Functions get references to operands in I, Q, M and L, and to copies in the local data for all others; complex types as POINTER. Function
//! blocks have their parameters in the instance: they are copied before the call, results after it.

use std::sync::Arc;

use crate::plc::step7::instruction::{
    BlockKind, BlockName, CallSite, Copy, CopySource, Instance, MakePointer, Number, Op, Operand as Place,
    ParameterSource, Pointed, Space, Target, Width,
};
use crate::plc::step7::system::{BASIC, SYSTEM, System, SystemBlock};
use crate::plc::step7::text::constants::Constant;
use crate::plc::step7::text::finding::{At, Fault, FindingKind};
use crate::plc::step7::text::parser::code;
use crate::plc::step7::text::syntax::{Operand, Parameter, Statement};
use crate::plc::step7::text::types::{Field, Section, Type, value_of};

use super::declare::Interface;
use super::parameters::{check_names, find, pointed, same_shape};
use super::unit::{AddressOf, Done, Kind, Named, Unit};

impl Unit<'_, '_> {
    /// What a call of a block reaches.
    pub(in crate::plc::step7) fn target(&mut self, name: BlockName, at: At) -> Done<Target> {
        if let Some(index) = self.known.built_in(name) {
            if let Some(basic) = index.checked_sub(BASIC) {
                self.tables.basic.insert((name, basic));
            }
            if let Some(SystemBlock { system: System::Answer(code), name: known, .. }) = SYSTEM.get(index) {
                let answer = if *code == 0 { "0".to_owned() } else { format!("{code:04X}h") };
                self.remark(at, format!("{name} {known} does nothing: its RET_VAL is {answer}"));
            }
            return Ok(Target::System(u16::try_from(index).unwrap_or(u16::MAX)));
        }
        if let Some(&index) = self.tables.index.get(&name) {
            return Ok(Target::Block(index));
        }
        if matches!(name.kind, BlockKind::Sfc | BlockKind::Sfb) {
            if self.ignores_missing {
                self.tables.missing.insert(name);
                self.remark(at, format!("{name} is not built in: its calls are left out"));
                return Ok(Target::Nothing);
            }
            return Err(Fault::unsupported(at, format!("{name} is not built in")));
        }
        self.missing(name, at)?;
        self.remark(at, format!("{name} is nowhere: its calls are left out"));
        Ok(Target::Nothing)
    }

    /// What the engine leaves out, listed once.
    fn remark(&mut self, at: At, what: String) {
        if self.tables.remarks.iter().all(|(_, known)| known.what != what) {
            let fault = Fault { at, kind: FindingKind::Unsupported, what, cure: String::new() };
            self.tables.remarks.push((format!("{}, network {}", self.name, self.line.network), fault));
        }
    }

    pub(in crate::plc::step7) fn call(&mut self, statement: &Statement) -> Done {
        let at = statement.at;
        self.forget_hidden();
        match self.named(&statement.operand, at)? {
            Some(Named::Block(name)) => match name.kind {
                BlockKind::Fc | BlockKind::Sfc => {
                    if statement.instance != Operand::None {
                        let what =
                            format!("expected no instance data block, found {} behind {name}", statement.instance);
                        return Err(Fault::new(at, what, "only function blocks have one: remove it"));
                    }
                    self.call_function(name, &statement.parameters, at)
                }
                BlockKind::Fb | BlockKind::Sfb => {
                    let Some(Named::Block(BlockName { kind: BlockKind::Db, number })) =
                        self.named(&statement.instance, at)?
                    else {
                        let what =
                            format!("expected an instance data block behind {name}, found {}", statement.instance);
                        return Err(Fault::new(at, what, format!("write `CALL {name} , DB 20`")));
                    };
                    self.call_with_block(name, number, &statement.parameters, at)
                }
                _ => Err(Fault::new(at, format!("expected an FC, FB, SFC or SFB, found {name}"), "call one of these")),
            },
            Some(Named::Instance(name, bit)) => self.call_within(name, bit, &statement.parameters, at),
            _ => {
                let what = format!("expected a block or a multi-instance, found {}", statement.operand);
                Err(Fault::new(at, what, "write `CALL FC 10` or `CALL #instance`"))
            }
        }
    }

    fn known_interface(&mut self, name: BlockName, at: At) -> Done<Option<Arc<Interface>>> {
        let interface = self.known.interface(name, at)?;
        if interface.is_none() {
            self.target(name, at)?;
            self.emit(Op::Nothing);
        }
        Ok(interface)
    }

    fn call_function(&mut self, name: BlockName, parameters: &[Parameter], at: At) -> Done {
        let Some(interface) = self.known_interface(name, at)? else { return Ok(()) };
        let target = self.target(name, at)?;
        let mut sources = Vec::new();
        let mut after = Vec::new();
        let mut faults = check_names(&interface, parameters, name);
        let mut missing = Vec::new();
        for field in &interface.layout.fields {
            match find(parameters, field).map(|parameter| self.function_parameter(field, parameter, &mut after)) {
                Some(Ok(source)) => sources.push(source),
                Some(Err(fault)) => faults.push(fault),
                None => missing.push(format!("`{}`", field.name)),
            }
        }
        if !missing.is_empty() {
            let what = match &*missing {
                [one] => format!("the parameter {one} of {name} is missing"),
                several => format!("the parameters {} of {name} are missing", several.join(", ")),
            };
            faults.push(Fault::new(at, what, "a call gives all parameters of a function"));
        }
        self.all_or_none(faults)?;
        let first = u32::try_from(self.tables.parameters.len()).unwrap_or(u32::MAX);
        let count = u16::try_from(sources.len()).unwrap_or(u16::MAX);
        self.tables.parameters.extend(sources);
        self.emit_call(CallSite { target, instance: Instance::None, first, count });
        self.emit_copies(after);
        Ok(())
    }

    /// Reports all faults of a call together.
    fn all_or_none(&mut self, mut faults: Vec<Fault>) -> Done {
        if faults.is_empty() {
            return Ok(());
        }
        self.further.extend(faults.drain(1..));
        faults.pop().map_or(Ok(()), Err)
    }

    fn emit_call(&mut self, call: CallSite) {
        let index = u32::try_from(self.tables.calls.len()).unwrap_or(u32::MAX);
        self.tables.calls.push(call);
        self.emit(Op::Call(index));
    }

    fn emit_copy(&mut self, copy: Copy) {
        let index = u32::try_from(self.tables.copies.len()).unwrap_or(u32::MAX);
        self.tables.copies.push(copy);
        self.emit(Op::Copy(index));
    }

    fn emit_copies(&mut self, copies: Vec<Copy>) {
        for copy in copies {
            self.emit_copy(copy);
        }
    }

    fn emit_pointer(&mut self, pointer: MakePointer) {
        let index = u32::try_from(self.tables.pointers.len()).unwrap_or(u32::MAX);
        self.tables.pointers.push(pointer);
        self.emit(Op::Pointer(index));
    }

    fn function_parameter(
        &mut self,
        field: &Field,
        parameter: &Parameter,
        after: &mut Vec<Copy>,
    ) -> Done<ParameterSource> {
        let at = parameter.at;
        if field.ty.is_number() {
            return Ok(ParameterSource::Number(self.number_for(&field.ty, &parameter.value, at)?));
        }
        if let Some(width) = field.ty.width() {
            return self.elementary_parameter(field, width, parameter, after);
        }
        if let Some(kept) = self.kept_any(&field.ty, &parameter.value, at)? {
            return Ok(ParameterSource::Reference(kept));
        }
        let to = Place::Direct(Space::Local, self.hide(if field.ty == Type::Any { 80 } else { 48 }));
        self.pass_pointer(&field.ty, &parameter.value, to, at)?;
        Ok(ParameterSource::Reference(to))
    }

    fn elementary_parameter(
        &mut self,
        field: &Field,
        width: Width,
        parameter: &Parameter,
        after: &mut Vec<Copy>,
    ) -> Done<ParameterSource> {
        let at = parameter.at;
        if let Some(value) = self.constant_for(field, &parameter.value, at)? {
            let to = Place::Direct(Space::Local, self.hide(width.bits()));
            self.emit_copy(Copy { from: CopySource::Constant(value), to, bits: width.bits() });
            return Ok(ParameterSource::Reference(to));
        }
        let place = self.place_for(field, width, &parameter.value, at)?;
        match place {
            Place::Direct(Space::Data | Space::Instance, _)
            | Place::Block(..)
            | Place::Fixed(..)
            | Place::Own(_)
            | Place::Through(..)
            | Place::Element(..)
            | Place::Indirect(..)
            | Place::Register(..) => {
                let copy = Place::Direct(Space::Local, self.hide(width.bits()));
                if field.section != Section::Output {
                    self.emit_copy(Copy { from: CopySource::Operand(place), to: copy, bits: width.bits() });
                }
                if field.section != Section::Input {
                    after.push(Copy { from: CopySource::Operand(copy), to: place, bits: width.bits() });
                }
                Ok(ParameterSource::Reference(copy))
            }
            Place::Direct(..) | Place::Parameter(_) => Ok(ParameterSource::Reference(place)),
        }
    }

    /// The value of a constant for a parameter; `None` for another operand.
    fn constant_for(&mut self, field: &Field, operand: &Operand, at: At) -> Done<Option<u32>> {
        let value = match operand {
            Operand::Constant(constant) => value_of(&field.ty, constant),
            Operand::AddressOf(name, path) if matches!(field.ty, Type::DWord | Type::DInt) => {
                match self.address_of(name, path, at)? {
                    AddressOf::Constant(value) => Some(value),
                    AddressOf::Parameter(_) => None,
                }
            }
            _ => return Ok(None),
        };
        let expected = || {
            let what = format!("expected a {} for `{}`, found {operand}", field.ty.name(), field.name);
            Fault::new(at, what, "write a constant of this type, or an address")
        };
        if field.section != Section::Input {
            return Err(Fault::new(
                at,
                format!("expected an operand that can be written for `{}`, found {operand}", field.name),
                "write an address or a variable",
            ));
        }
        value.map(Some).ok_or_else(expected)
    }

    fn place_for(&mut self, field: &Field, width: Width, operand: &Operand, at: At) -> Done<Place> {
        let (_, place) = self.place(operand, &[width], at).map_err(|fault| Fault {
            what: format!("{} for the parameter `{}` of the type {}", fault.what, field.name, field.ty.name()),
            ..fault
        })?;
        Ok(place)
    }

    /// The number of a timer, a counter or a block for a parameter.
    fn number_for(&mut self, ty: &Type, operand: &Operand, at: At) -> Done<Number> {
        let named = self.named(operand, at)?;
        match (ty, named) {
            (Type::Timer, Some(Named::Timer(number)))
            | (Type::Counter, Some(Named::Counter(number)))
            | (Type::BlockDb, Some(Named::Data(number)))
            | (Type::BlockFb, Some(Named::Code(BlockKind::Fb, number)))
            | (Type::BlockFc, Some(Named::Code(BlockKind::Fc, number))) => Ok(number),
            (Type::BlockDb, Some(Named::Block(BlockName { kind: BlockKind::Db, number }))) => {
                self.note_block(number);
                Ok(Number::Direct(number))
            }
            (Type::BlockFb, Some(Named::Block(BlockName { kind: BlockKind::Fb, number })))
            | (Type::BlockFc, Some(Named::Block(BlockName { kind: BlockKind::Fc, number }))) => {
                Ok(Number::Direct(number))
            }
            _ => {
                let cure = match ty {
                    Type::Timer => "write `T 5`",
                    Type::Counter => "write `C 5`",
                    Type::BlockDb => "write `DB 10`",
                    Type::BlockFb => "write `FB 10`",
                    _ => "write `FC 10`",
                };
                Err(Fault::new(at, format!("expected an operand of the type {}, found {operand}", ty.name()), cure))
            }
        }
    }

    /// A temporary variable or a parameter of the type ANY, which is handed on as it is.
    fn kept_any(&mut self, ty: &Type, operand: &Operand, at: At) -> Done<Option<Place>> {
        if *ty != Type::Any || !matches!(operand, Operand::Local(..) | Operand::Bare(..)) {
            return Ok(None);
        }
        Ok(match self.named(operand, at)? {
            Some(Named::Variable(
                place @ (Place::Direct(Space::Local, _) | Place::Parameter(_)),
                Kind::Typed(Type::Any),
            )) => Some(place),
            _ => None,
        })
    }

    /// Writes a POINTER, or an ANY, to an operand.
    fn pass_pointer(&mut self, ty: &Type, operand: &Operand, to: Place, at: At) -> Done {
        let is_any = *ty == Type::Any;
        if let Operand::Constant(Constant::Pointer { block, pointer, any }) = *operand {
            if ty.is_complex() {
                let what = format!("expected a variable of the type {}, found {operand}", ty.name());
                return Err(Fault::new(at, what, "pass a variable of this type, not a pointer"));
            }
            let any = is_any.then(|| any.unwrap_or((0x02, 1)));
            // Local data of this block are those of the caller for the called one.
            let pointed = if pointer >> 24 == 0x86 {
                Pointed::Local(pointer & 0x00FF_FFFF)
            } else {
                Pointed::Constant(block, pointer)
            };
            self.emit_pointer(MakePointer { to, pointed, any });
            return Ok(());
        }
        let wrong = |found: &str| {
            let what = format!("expected an operand for a parameter of the type {}, found {found}", ty.name());
            Fault::new(at, what, "write an address or a variable")
        };
        let numbered = |kind: u8, number: Number| match number {
            Number::Direct(number) => Ok((Pointed::Constant(0, u32::from(number)), (kind, 1))),
            _ => Err(wrong("a number that is known at run time only")),
        };
        let (pointed, (kind, count)) = match self.named(operand, at)? {
            Some(Named::Variable(place, kind)) => {
                if let Kind::Typed(found) = &kind
                    && found == ty
                    && matches!(found, Type::Any | Type::Pointer)
                {
                    self.emit_copy(Copy { from: CopySource::Operand(place), to, bits: ty.bits() });
                    return Ok(());
                }
                if ty.is_complex() {
                    let found = match &kind {
                        Kind::Typed(found) => Some(found),
                        Kind::Width(_) => None,
                    };
                    let fits = found.is_some_and(|found| same_shape(ty, found));
                    if !fits {
                        return Err(wrong(&kind.name()));
                    }
                }
                let any = match &kind {
                    Kind::Typed(ty) => ty.any(),
                    Kind::Width(Width::Bit) => (0x01, 1),
                    Kind::Width(Width::Byte) => (0x02, 1),
                    Kind::Width(Width::Word) => (0x04, 1),
                    Kind::Width(Width::Double) => (0x06, 1),
                };
                (pointed(place).ok_or_else(|| wrong("an indirect address"))?, any)
            }
            Some(Named::Instance(_, bit)) if is_any => (Pointed::Own(bit), (0x02, 1)),
            Some(Named::Timer(number)) if is_any => numbered(0x1D, number)?,
            Some(Named::Counter(number)) if is_any => numbered(0x1C, number)?,
            Some(Named::Block(BlockName { kind: BlockKind::Db, number })) if is_any => {
                let bytes = self.known.data.get(&number).map_or(0, |data| data.bytes.len());
                (Pointed::Constant(number, code(Space::Data) << 24), (0x02, u16::try_from(bytes).unwrap_or(u16::MAX)))
            }
            _ => return Err(wrong(&operand.to_string())),
        };
        self.emit_pointer(MakePointer { to, pointed, any: is_any.then_some((kind, count)) });
        Ok(())
    }

    fn call_with_block(&mut self, name: BlockName, number: u16, parameters: &[Parameter], at: At) -> Done {
        self.note_block(number);
        let Some(interface) = self.known_interface(name, at)? else { return Ok(()) };
        if let Some(data) = self.known.data.get(&number)
            && data.instance_of != Some(name)
        {
            let (has, needs) = (data.bytes.len(), interface.layout.image.len());
            let found = match data.instance_of {
                Some(other) => format!("which is an instance of {other}"),
                None if has < needs => format!("a data block of its own with {has} bytes, where {name} needs {needs}"),
                None => String::new(),
            };
            if !found.is_empty() {
                let what = format!("expected an instance of {name}, found DB{number}, {found}");
                return Err(Fault::new(at, what, format!("declare an instance: `DATA_BLOCK DB {number} {name}`")));
            }
        }
        self.call_block(name, &interface, Instance::Block(number), parameters, at)
    }

    fn call_within(&mut self, name: BlockName, bit: u32, parameters: &[Parameter], at: At) -> Done {
        let Some(interface) = self.known_interface(name, at)? else { return Ok(()) };
        if self.interface.is_version_1 {
            return Err(Fault::new(at, "a block with CODE_VERSION1 has no multi-instances", "remove CODE_VERSION1"));
        }
        self.call_block(name, &interface, Instance::Within(bit), parameters, at)
    }

    fn call_block(
        &mut self,
        name: BlockName,
        interface: &Interface,
        instance: Instance,
        parameters: &[Parameter],
        at: At,
    ) -> Done {
        let target = self.target(name, at)?;
        let mut faults = check_names(interface, parameters, name);
        let own = |bit: u32| match instance {
            Instance::Block(number) => Place::Fixed(number, bit),
            Instance::Within(start) => Place::Own(start + bit),
            Instance::None => Place::Own(bit),
        };
        let mut after = Vec::new();
        for field in &interface.layout.fields {
            let done = find(parameters, field)
                .map_or(Ok(()), |parameter| self.block_parameter(field, parameter, own(field.bit), &mut after));
            faults.extend(done.err());
        }
        self.all_or_none(faults)?;
        self.emit_call(CallSite { target, instance, first: 0, count: 0 });
        self.emit_copies(after);
        Ok(())
    }

    fn block_parameter(&mut self, field: &Field, parameter: &Parameter, own: Place, after: &mut Vec<Copy>) -> Done {
        let at = parameter.at;
        if field.ty.is_number() {
            let number = self.number_for(&field.ty, &parameter.value, at)?;
            self.emit_copy(Copy { from: CopySource::Number(number), to: own, bits: 16 });
            return Ok(());
        }
        if field.is_pointer() || matches!(field.ty, Type::Any | Type::Pointer) {
            return self.pass_pointer(&field.ty, &parameter.value, own, at);
        }
        let (place, bits) = if let Some(width) = field.ty.width() {
            if let Some(value) = self.constant_for(field, &parameter.value, at)? {
                self.emit_copy(Copy { from: CopySource::Constant(value), to: own, bits: width.bits() });
                return Ok(());
            }
            (self.place_for(field, width, &parameter.value, at)?, width.bits())
        } else {
            let wrong = |found: &str| {
                let what =
                    format!("expected a variable of the type {} for `{}`, found {found}", field.ty.name(), field.name);
                Fault::new(at, what, "pass a variable of this type")
            };
            match self.named(&parameter.value, at)? {
                Some(Named::Variable(place, Kind::Typed(ty))) if same_shape(&field.ty, &ty) => {
                    (place, field.ty.bits().min(ty.bits()))
                }
                Some(Named::Variable(_, kind)) => return Err(wrong(&kind.name())),
                _ => return Err(wrong(&parameter.value.to_string())),
            }
        };
        if field.section != Section::Output {
            self.emit_copy(Copy { from: CopySource::Operand(place), to: own, bits });
        }
        if field.section != Section::Input {
            after.push(Copy { from: CopySource::Operand(own), to: place, bits });
        }
        Ok(())
    }
}
