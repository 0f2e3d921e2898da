//! Statements become instructions.

use crate::plc::step7::instruction::{
    BlockKind, BlockName, Condition, DataRegister, Jump, Line, Logic, Number, Op, Register, Target, Width,
};
use crate::plc::step7::text::constants::Constant;
use crate::plc::step7::text::finding::{At, Fault};
use crate::plc::step7::text::mnemonics::{Language, Operation};
use crate::plc::step7::text::syntax::{Operand, Statement};

use super::unit::{AddressOf, Done, Named, Unit};

const BIT: &[Width] = &[Width::Bit];
const BYTES: &[Width] = &[Width::Byte, Width::Word, Width::Double];

impl Unit<'_, '_> {
    /// Compiles the statements of the block; returns its faults with their networks.
    pub(in crate::plc::step7) fn statements(
        &mut self,
        statements: &[Statement],
        language: Language,
    ) -> Vec<(u16, Fault)> {
        let mut faults = Vec::new();
        for (index, statement) in statements.iter().enumerate() {
            self.line = Line {
                file: statement.at.file,
                network: statement.network,
                line: statement.at.line,
                statement: statement.number,
            };
            if let Some(label) = &statement.label
                && let Err(fault) = self.label(label, statement.at)
            {
                faults.push((statement.network, fault));
            }
            if statement.operation.is_empty() {
                continue;
            }
            if let Err(fault) = self.statement(statement, &statements[index + 1..], language) {
                faults.push((statement.network, fault));
            }
            faults.extend(self.further.drain(..).map(|fault| (statement.network, fault)));
        }
        self.emit(Op::End(Condition::Always));
        faults
    }

    fn statement(&mut self, statement: &Statement, following: &[Statement], language: Language) -> Done {
        let at = statement.at;
        let Some(operation) = language.operation(&statement.operation) else {
            let other = match language {
                Language::International => Language::German,
                Language::German => Language::International,
            };
            let cure = if other.operation(&statement.operation).is_some() {
                format!("the other statements of this file are {language:?}: use one language in a file").to_lowercase()
            } else {
                crate::source::did_you_mean(&statement.operation, language.words(), "check the operation")
            };
            return Err(Fault::new(at, format!("there is no operation `{}`", statement.operation), cure));
        };
        let operand = &statement.operand;
        match operation {
            Operation::Logic(logic) => self.logic(logic, operand, at),
            Operation::Open(logic) => self.plain(operand, Op::OpenNest(logic), at),
            Operation::Close => self.plain(operand, Op::CloseNest, at),
            Operation::Assign => {
                let (_, place) = self.place(operand, BIT, at)?;
                self.emit(Op::Assign(place));
                Ok(())
            }
            Operation::Set | Operation::Reset => self.set(operation == Operation::Set, operand, at),
            Operation::Not => self.plain(operand, Op::Not, at),
            Operation::SetRlo(value) => self.plain(operand, Op::SetRlo(value), at),
            Operation::Save => self.plain(operand, Op::Save, at),
            Operation::Edge(positive) => {
                let (_, place) = self.place(operand, BIT, at)?;
                self.emit(Op::Edge(positive, place));
                Ok(())
            }
            Operation::Compare(relation, numeric) => self.plain(operand, Op::Compare(relation, numeric), at),
            Operation::Arithmetic(arithmetic, numeric) => self.plain(operand, Op::Arithmetic(arithmetic, numeric), at),
            Operation::AddConstant => self.add_constant(operand, at),
            Operation::Convert(convert) => self.plain(operand, Op::Convert(convert), at),
            Operation::WordLogic(logic, is_double) => {
                let width = if is_double { Width::Double } else { Width::Word };
                match operand {
                    Operand::None => self.emit(Op::WordLogic(logic, width)),
                    Operand::Constant(constant) => {
                        let value = constant.bits().filter(|&value| is_double || value <= 0xFFFF);
                        let value = value.ok_or_else(|| {
                            let bits = width.bits();
                            let what = format!("expected a constant of {bits} bits, found {constant}");
                            Fault::new(at, what, "write W#16#… for 16 bits, DW#16#… for 32 bits")
                        })?;
                        self.emit(Op::WordLogicConstant(logic, width, value));
                    }
                    _ => {
                        let what = format!("expected a constant, or no operand, found {operand}");
                        return Err(Fault::new(at, what, "write W#16#… or DW#16#…, or load the operand before"));
                    }
                }
                Ok(())
            }
            Operation::Shift(shift) => {
                match operand {
                    Operand::None => self.emit(Op::Shift(shift)),
                    operand => {
                        let count = self.small(operand, 32, at)?;
                        self.emit(Op::ShiftBy(shift, count));
                    }
                }
                Ok(())
            }
            Operation::Load => self.load(operand, at),
            Operation::LoadBcd => self.load_number(true, operand, at),
            Operation::Transfer => self.transfer(operand, at),
            Operation::Accumulators(operation) => self.plain(operand, Op::Accumulators(operation), at),
            Operation::Increment => {
                let count = self.small(operand, 255, at)?;
                self.emit(Op::Increment(count));
                Ok(())
            }
            Operation::Decrement => {
                let count = self.small(operand, 255, at)?;
                self.emit(Op::Decrement(count));
                Ok(())
            }
            Operation::LoadRegister(register) => self.load_register(register, operand, at),
            Operation::TransferRegister(register) => self.transfer_register(register, operand, at),
            Operation::SwapRegisters => self.plain(operand, Op::SwapRegisters, at),
            Operation::AddRegister(register) => match operand {
                Operand::None => {
                    self.emit(Op::AddRegister(register));
                    Ok(())
                }
                Operand::Constant(Constant::Bit(bits)) => {
                    self.emit(Op::AddRegisterConstant(register, *bits));
                    Ok(())
                }
                _ => {
                    let what = format!("expected a distance as P#2.0, or no operand, found {operand}");
                    Err(Fault::new(at, what, "without an operand ACCU1 is added"))
                }
            },
            Operation::OpenData => self.open(operand, at),
            Operation::SwapDb => self.plain(operand, Op::SwapDb, at),
            Operation::Jump(jump) => self.jump_to(jump, operand, at),
            Operation::JumpList => {
                let is_jump = |statement: &&Statement| {
                    language.operation(&statement.operation) == Some(Operation::Jump(Jump::Always))
                };
                let count = following.iter().take_while(is_jump).take(255).count();
                let count = u16::try_from(count).unwrap_or(255);
                let label = label_of(operand, at)?;
                self.jump(Op::JumpList(count, 0), label, at);
                Ok(())
            }
            Operation::End(condition) => self.plain(operand, Op::End(condition), at),
            Operation::Call => self.call(statement),
            Operation::PlainCall(condition) => self.plain_call(condition, operand, at),
            Operation::Mcr(mcr) => self.plain(operand, Op::Mcr(mcr), at),
            Operation::Timer(kind) => {
                let Some(Named::Timer(number)) = self.named(operand, at)? else {
                    return Err(expected_timer(operand, at));
                };
                self.emit(Op::StartTimer(kind, number));
                Ok(())
            }
            Operation::Free => match self.named(operand, at)? {
                Some(Named::Timer(number)) => {
                    self.emit(Op::FreeTimer(number));
                    Ok(())
                }
                Some(Named::Counter(number)) => {
                    self.emit(Op::FreeCounter(number));
                    Ok(())
                }
                _ => Err(expected_timer(operand, at)),
            },
            Operation::CountUp | Operation::CountDown => {
                let Some(Named::Counter(number)) = self.named(operand, at)? else {
                    let what = format!("expected a counter, found {operand}");
                    return Err(Fault::new(at, what, "write `C 5`, or a parameter of the type COUNTER"));
                };
                self.emit(if operation == Operation::CountUp { Op::CountUp(number) } else { Op::CountDown(number) });
                Ok(())
            }
            Operation::Nothing => {
                self.emit(Op::Nothing);
                Ok(())
            }
        }
    }

    /// An operation without an operand.
    fn plain(&mut self, operand: &Operand, op: Op, at: At) -> Done {
        if *operand != Operand::None {
            return Err(Fault::new(at, format!("expected `;`, found {operand}"), "this operation has no operand"));
        }
        self.emit(op);
        Ok(())
    }

    fn small(&mut self, operand: &Operand, limit: i64, at: At) -> Done<u8> {
        let value = match operand {
            Operand::Constant(Constant::Integer(value)) => Some(*value),
            Operand::Constant(Constant::Bits(value, _)) => Some(i64::from(*value)),
            _ => None,
        };
        value.filter(|value| (0..=limit).contains(value)).and_then(|value| u8::try_from(value).ok()).ok_or_else(|| {
            let what = format!("expected a number from 0 to {limit}, found {operand}");
            Fault::new(at, what, "correct the number")
        })
    }

    fn logic(&mut self, logic: Logic, operand: &Operand, at: At) -> Done {
        let op = match operand {
            Operand::None if logic == Logic::Or => Op::OrBeforeAnd,
            Operand::Status(bit) => Op::LogicStatus(logic, *bit),
            operand => match self.named(operand, at)? {
                Some(Named::Timer(number)) => Op::LogicTimer(logic, number),
                Some(Named::Counter(number)) => Op::LogicCounter(logic, number),
                _ => Op::Logic(logic, self.place(operand, BIT, at)?.1),
            },
        };
        self.emit(op);
        Ok(())
    }

    fn set(&mut self, is_set: bool, operand: &Operand, at: At) -> Done {
        let op = match (self.named(operand, at)?, is_set) {
            (Some(Named::Timer(number)), false) => Op::ResetTimer(number),
            (Some(Named::Counter(number)), false) => Op::ResetCounter(number),
            (Some(Named::Counter(number)), true) => Op::SetCounter(number),
            (_, true) => Op::Set(self.place(operand, BIT, at)?.1),
            (_, false) => Op::Reset(self.place(operand, BIT, at)?.1),
        };
        self.emit(op);
        Ok(())
    }

    fn add_constant(&mut self, operand: &Operand, at: At) -> Done {
        let op = match operand {
            Operand::Constant(Constant::Long(value)) => Op::AddDouble(value.cast_unsigned()),
            Operand::Constant(Constant::Integer(value)) => match i16::try_from(*value) {
                Ok(value) => Op::AddWord(value.cast_unsigned()),
                Err(_) => {
                    let value = i32::try_from(*value).map_err(|_| {
                        let what = format!("expected a number from -2147483648 to 2147483647, found {value}");
                        Fault::new(at, what, "the constant has 16 or 32 bits")
                    })?;
                    Op::AddDouble(value.cast_unsigned())
                }
            },
            Operand::Constant(constant @ Constant::Bits(_, 8 | 16)) => {
                Op::AddWord(u16::try_from(constant.bits().unwrap_or(0)).unwrap_or(0))
            }
            Operand::Constant(constant) => Op::AddDouble(constant.bits().ok_or_else(|| {
                Fault::new(at, format!("expected a number, found {constant}"), "write `+ 5` or `+ L#5`")
            })?),
            _ => {
                let what = format!("expected a constant, found {operand}");
                return Err(Fault::new(at, what, "write `+ 5` or `+ L#5`; `+I`, `+D` and `+R` add the accumulators"));
            }
        };
        self.emit(op);
        Ok(())
    }

    fn load(&mut self, operand: &Operand, at: At) -> Done {
        let op = match operand {
            Operand::Constant(constant) => Op::LoadConstant(constant.bits().ok_or_else(|| {
                let what = format!("expected a constant of at most 32 bits, found {constant}");
                Fault::new(at, what, "texts have at most four characters here")
            })?),
            Operand::Special("STW") => Op::LoadStatus,
            Operand::Special("DBLG") => Op::LoadData(DataRegister::DbLength),
            Operand::Special("DBNO") => Op::LoadData(DataRegister::DbNumber),
            Operand::Special("DILG") => Op::LoadData(DataRegister::DiLength),
            Operand::Special("DINO") => Op::LoadData(DataRegister::DiNumber),
            Operand::AddressOf(name, path) => match self.address_of(name, path, at)? {
                AddressOf::Constant(value) => Op::LoadConstant(value),
                AddressOf::Parameter(index) => Op::LoadParameterAddress(index),
            },
            operand => match self.named(operand, at)? {
                Some(Named::Timer(_) | Named::Counter(_)) => return self.load_number(false, operand, at),
                _ => {
                    let (width, place) = self.place(operand, BYTES, at)?;
                    Op::Load(width, place)
                }
            },
        };
        self.emit(op);
        Ok(())
    }

    fn load_number(&mut self, is_bcd: bool, operand: &Operand, at: At) -> Done {
        let op = match self.named(operand, at)? {
            Some(Named::Timer(number)) => Op::LoadTimer(is_bcd, number),
            Some(Named::Counter(number)) => Op::LoadCounter(is_bcd, number),
            _ => return Err(expected_timer(operand, at)),
        };
        self.emit(op);
        Ok(())
    }

    fn transfer(&mut self, operand: &Operand, at: At) -> Done {
        let op = if *operand == Operand::Special("STW") {
            Op::TransferStatus
        } else {
            let (width, place) = self.place(operand, BYTES, at)?;
            Op::Transfer(width, place)
        };
        self.emit(op);
        Ok(())
    }

    fn load_register(&mut self, register: Register, operand: &Operand, at: At) -> Done {
        let op = match operand {
            Operand::None => Op::RegisterFromAccu(register),
            Operand::Constant(Constant::Bit(value)) => Op::RegisterFromConstant(register, *value),
            Operand::Constant(Constant::Pointer { pointer, .. }) => Op::RegisterFromConstant(register, *pointer),
            Operand::Special("AR2") if register == Register::Ar1 => Op::RegisterFromOther,
            Operand::AddressOf(name, path) => {
                let address = self.address_of(name, path, at)?;
                self.register_from_address(register, address);
                return Ok(());
            }
            operand => Op::RegisterFromOperand(register, self.place(operand, &[Width::Double], at)?.1),
        };
        self.emit(op);
        Ok(())
    }

    fn transfer_register(&mut self, register: Register, operand: &Operand, at: At) -> Done {
        let op = match operand {
            Operand::None => Op::AccuFromRegister(register),
            Operand::Special("AR2") if register == Register::Ar1 => Op::OtherFromRegister,
            operand => Op::OperandFromRegister(register, self.place(operand, &[Width::Double], at)?.1),
        };
        self.emit(op);
        Ok(())
    }

    fn open(&mut self, operand: &Operand, at: At) -> Done {
        let is_instance = matches!(operand, Operand::InstanceBlock(_) | Operand::BlockAt(_, true, _));
        let number = match self.named(operand, at)? {
            Some(Named::Data(number)) => number,
            Some(Named::Block(BlockName { kind: BlockKind::Db, number })) => Number::Direct(number),
            _ => {
                let what = format!("expected a data block, found {operand}");
                return Err(Fault::new(at, what, "write `DB 10`, `DI 10` or `DB [MW 2]`"));
            }
        };
        if let Number::Direct(number) = number {
            self.note_block(number);
        }
        self.emit(if is_instance { Op::OpenDi(number) } else { Op::OpenDb(number) });
        Ok(())
    }

    fn jump_to(&mut self, jump: Jump, operand: &Operand, at: At) -> Done {
        let label = label_of(operand, at)?;
        self.jump(Op::Jump(jump, 0), label, at);
        Ok(())
    }

    fn plain_call(&mut self, condition: Condition, operand: &Operand, at: At) -> Done {
        let op = match self.named(operand, at)? {
            Some(Named::Code(kind, number)) => Op::CallNumber(condition, kind, number),
            Some(Named::Block(name))
                if matches!(name.kind, BlockKind::Fc | BlockKind::Fb | BlockKind::Sfc | BlockKind::Sfb) =>
            {
                let target = self.target(name, at)?;
                if let Target::System(_) = target
                    && self.known.interface(name, at)?.is_some_and(|interface| !interface.layout.fields.is_empty())
                {
                    let what = format!("expected a block without parameters, found {name}, which has some");
                    return Err(Fault::new(at, what, format!("write `CALL {name} ( … )`")));
                }
                Op::CallPlain(condition, target)
            }
            _ => {
                let what = format!("expected a block with statements, found {operand}");
                return Err(Fault::new(at, what, "write `FC 10` or `FC [MW 2]`"));
            }
        };
        self.emit(op);
        Ok(())
    }
}

fn label_of(operand: &Operand, at: At) -> Done<&str> {
    match operand {
        Operand::Bare(label, path) if path.is_empty() => Ok(label),
        _ => {
            let what = format!("expected a label, found {operand}");
            Err(Fault::new(at, what, "a label has one to four letters, digits or `_`, and is no address"))
        }
    }
}

fn expected_timer(operand: &Operand, at: At) -> Fault {
    let what = format!("expected a timer or a counter, found {operand}");
    Fault::new(at, what, "write `T 5`, `C 5` or a parameter of this type")
}
