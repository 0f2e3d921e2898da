//! The operands that made the RLO of an instruction: the logic string before it is read backwards, evaluated again with the present values,
//! and only if the result is the RLO, the operands on its decisive paths are named. So nothing is named that was not tested.

use arrayvec::ArrayVec;

use crate::plc::step7::instruction::{CopySource, Jump, Logic, Number, Op, Operand, Space};

use super::cpu::Cpu;
use super::flow::width_of;
use super::memory::{Areas, OpenBlock};
use super::read::{Named, OPERANDS, Read};

/// The nodes of the tree of a logic string.
const NODES: usize = 96;
/// Instructions that are read backwards.
const LONGEST: u32 = 400;
/// Local bits that are followed to the string that wrote them, one within another.
const DEEPEST: u8 = 6;

type Index = u8;

#[derive(Clone, Copy, Debug)]
enum Node {
    /// An operand and its value; without a name it is local data or unknown.
    Leaf(Option<Named>, bool),
    /// A comparison: its number in the tree, and its result.
    Compared(Index, bool),
    /// A value that cannot be read again: a status bit, an edge. It is what fits.
    Open,
    /// An edge: its marker, whose value was tested, and the logic before it.
    Edge(Option<Named>, bool, Index),
    Not(Index),
    And(Index, Index),
    Or(Index, Index),
    Xor(Index, Index),
}

/// A logic string as a tree.
#[derive(Debug, Default)]
struct Tree {
    nodes: ArrayVec<Node, NODES>,
    /// What the comparisons compared.
    compared: Vec<ArrayVec<Read, OPERANDS>>,
    /// How many values are open.
    open: u8,
}

/// The present state of the string: the terms before `O`, and the term since.
#[derive(Clone, Copy, Debug, Default)]
struct Term {
    before: Option<Index>,
    term: Option<Index>,
}

impl Tree {
    fn add(&mut self, node: Node) -> Option<Index> {
        if matches!(node, Node::Open | Node::Edge(..)) {
            self.open += 1;
        }
        self.nodes.try_push(node).ok()?;
        Index::try_from(self.nodes.len() - 1).ok()
    }

    fn result(&mut self, term: Term) -> Option<Index> {
        match (term.before, term.term) {
            (Some(before), Some(term)) => self.add(Node::Or(before, term)),
            (before, term) => before.or(term),
        }
    }

    fn combine(&mut self, state: Term, logic: Logic, x: Index) -> Option<Term> {
        let is_negated = matches!(logic, Logic::AndNot | Logic::OrNot | Logic::XorNot);
        let x = if is_negated { self.add(Node::Not(x))? } else { x };
        Some(match logic {
            Logic::And | Logic::AndNot => {
                let term = match state.term {
                    Some(term) => self.add(Node::And(term, x))?,
                    None => x,
                };
                Term { term: Some(term), ..state }
            }
            Logic::Or | Logic::OrNot | Logic::Xor | Logic::XorNot => {
                let is_or = matches!(logic, Logic::Or | Logic::OrNot);
                let term = match self.result(state) {
                    Some(before) => self.add(if is_or { Node::Or(before, x) } else { Node::Xor(before, x) })?,
                    None => x,
                };
                Term { before: None, term: Some(term) }
            }
        })
    }

    /// The value of a node, with this value for those that are open.
    fn value(&self, index: Index, open: bool) -> bool {
        match self.nodes[usize::from(index)] {
            Node::Leaf(_, value) | Node::Compared(_, value) => value,
            Node::Open | Node::Edge(..) => open,
            Node::Not(x) => !self.value(x, open),
            Node::And(x, y) => self.value(x, open) && self.value(y, open),
            Node::Or(x, y) => self.value(x, open) || self.value(y, open),
            Node::Xor(x, y) => self.value(x, open) != self.value(y, open),
        }
    }

    /// The leaves that decide the value of a node.
    fn decisive(&self, index: Index, open: bool, tested: &mut ArrayVec<Read, OPERANDS>) {
        let mut keep = |named: Option<Named>, value: bool| {
            let read = named.map(|named| Read::bit(named, value));
            if let Some(read) = read.filter(|read| !tested.contains(read)) {
                let _ = tested.try_push(read);
            }
        };
        match self.nodes[usize::from(index)] {
            Node::Leaf(named, value) => keep(named, value),
            Node::Compared(number, _) => {
                for read in &self.compared[usize::from(number)] {
                    if !tested.contains(read) {
                        let _ = tested.try_push(*read);
                    }
                }
            }
            Node::Open => {}
            Node::Edge(marker, value, inner) => {
                // Where there was no edge although its logic is as it must be, the marker decided.
                if !open {
                    keep(marker, value);
                }
                self.decisive(inner, open, tested);
            }
            Node::Not(x) => self.decisive(x, open, tested),
            Node::And(x, y) | Node::Or(x, y) => {
                let is_and = matches!(self.nodes[usize::from(index)], Node::And(..));
                let value = self.value(index, open);
                for part in [x, y] {
                    // All of an AND that is true and of an OR that is false; else the parts that decided alone.
                    if value == is_and || self.value(part, open) == value {
                        self.decisive(part, open, tested);
                    }
                }
            }
            Node::Xor(x, y) => {
                self.decisive(x, open, tested);
                self.decisive(y, open, tested);
            }
        }
    }
}

impl Cpu {
    /// The operands that made the RLO before an instruction that writes, or the operand that it copies.
    pub(super) fn reasons<A: Areas>(&mut self, areas: &A, op: Op, pc: u32, tested: &mut ArrayVec<Read, OPERANDS>) {
        if let Op::Copy(index) = op
            && width_of(self.program.copies[index as usize].bits).is_none()
        {
            if let CopySource::Operand(operand) = self.program.copies[index as usize].from
                && let Ok(spot) = self.spot(areas, operand)
                && let (Some(named), Ok(value)) = (self.named(spot), self.read_bit(areas, spot))
            {
                tested.push(Read::bit(named, value));
            }
            return;
        }
        if let Op::Transfer(..) | Op::Copy(_) = op {
            let origin = self.transferred(areas, op);
            let Some(reads) = origin.reads() else { return };
            tested.extend(reads.iter().copied());
            if !reads.is_empty() || matches!(op, Op::Copy(_)) {
                return;
            }
        }
        let mut tree = Tree::default();
        let string = if matches!(op, Op::Transfer(..)) { None } else { self.string(areas, pc, &mut tree, 0) };
        let (root, rlo) = match string {
            Some(root) => (root, self.state.registers.status.rlo),
            // After SET or CLR, and with a constant, the statement runs because of the jump before it.
            None => match self
                .guard(pc, matches!(op, Op::Transfer(..)))
                .and_then(|(jump, rlo)| Some((self.string(areas, jump, &mut tree, 0)?, rlo)))
            {
                Some(guarded) => guarded,
                None => return,
            },
        };
        // With several open values it is not known which is what.
        let open = match tree.open {
            0 => false,
            1 if tree.value(root, true) != tree.value(root, false) => tree.value(root, true) == rlo,
            _ => return,
        };
        if tree.value(root, open) == rlo {
            tree.decisive(root, open, tested);
        }
    }

    /// The conditional jump over an instruction behind SET or CLR, or with a constant, and the RLO with which it was not taken.
    fn guard(&self, pc: u32, mut has_constant: bool) -> Option<(u32, bool)> {
        let begin = self.program.block_at(pc)?.start.max(self.landed());
        for at in (begin..pc).rev().take(LONGEST as usize) {
            match self.program.code[at as usize] {
                Op::SetRlo(_) | Op::LoadConstant(_) => has_constant = true,
                Op::Jump(Jump::IfNotRlo, target) if has_constant && target > pc => return Some((at, true)),
                Op::Jump(Jump::IfRlo, target) if has_constant && target > pc => return Some((at, false)),
                Op::Assign(_) | Op::Set(_) | Op::Reset(_) | Op::Transfer(..) | Op::Nothing => {}
                _ => return None,
            }
        }
        None
    }

    /// The instruction since which the program ran in order.
    fn landed(&self) -> u32 {
        self.observed.as_ref().map_or(0, |observed| observed.flow.landed)
    }

    /// The tree of the logic string that ends before an instruction.
    fn string<A: Areas>(&mut self, areas: &A, end: u32, tree: &mut Tree, depth: u8) -> Option<Index> {
        let program = std::sync::Arc::clone(&self.program);
        let block = program.block_at(end)?.start;
        let mut start = end;
        let mut last = end;
        let mut is_begun = false;
        let mut depth_of_brackets = 0_i32;
        while start > block && end - start < LONGEST {
            match program.code[start as usize - 1] {
                Op::CloseNest => {
                    depth_of_brackets += 1;
                    is_begun = true;
                }
                Op::OpenNest(_) => depth_of_brackets -= 1,
                Op::Logic(..)
                | Op::LogicTimer(..)
                | Op::LogicCounter(..)
                | Op::LogicStatus(..)
                | Op::OrBeforeAnd
                | Op::Not
                | Op::Edge(..)
                | Op::Compare(..) => is_begun = true,
                // These end a string; between its end and the instruction they are further outputs.
                Op::Assign(_) | Op::Set(_) | Op::Reset(_) | Op::StartTimer(..) | Op::ResetTimer(_) if !is_begun => {
                    last = start - 1;
                }
                Op::Load(..) | Op::LoadConstant(_) | Op::Nothing | Op::Arithmetic(..) | Op::Save => {}
                Op::SetRlo(_) if !is_begun => return None,
                _ => break,
            }
            start -= 1;
        }
        // A string that a jump entered in its middle did not run as it stands.
        if depth_of_brackets != 0 || !is_begun || start < self.landed() {
            return None;
        }
        self.build(areas, (start, last, end), tree, depth)
    }

    fn build<A: Areas>(
        &mut self,
        areas: &A,
        (start, last, end): (u32, u32, u32),
        tree: &mut Tree,
        depth: u8,
    ) -> Option<Index> {
        let program = std::sync::Arc::clone(&self.program);
        let mut nests: ArrayVec<(Term, Logic), 8> = ArrayVec::new();
        let mut state = Term::default();
        for at in start..last {
            let leaf = match program.code[at as usize] {
                Op::OpenNest(logic) => {
                    nests.try_push((state, logic)).ok()?;
                    state = Term::default();
                    continue;
                }
                Op::CloseNest => {
                    state.term?;
                    let x = tree.result(state)?;
                    let (outer, logic) = nests.pop()?;
                    state = tree.combine(outer, logic, x)?;
                    continue;
                }
                Op::OrBeforeAnd => {
                    state = Term { before: tree.result(state), term: None };
                    continue;
                }
                Op::Not => {
                    // Behind `O` it inverts the RLO, and the terms before stay as they were.
                    let x = state.term.filter(|_| state.before.is_none())?;
                    state = Term { before: None, term: Some(tree.add(Node::Not(x))?) };
                    continue;
                }
                Op::Edge(_, marker) => {
                    let inner = tree.result(state)?;
                    let before = self.leaf(areas, marker, (at, end));
                    let (marker, value) = before.unwrap_or((None, false));
                    state = Term { before: None, term: Some(tree.add(Node::Edge(marker, value, inner))?) };
                    continue;
                }
                Op::Compare(..) => {
                    let node = self.compared(at, tree);
                    state = Term { before: None, term: Some(tree.add(node)?) };
                    continue;
                }
                Op::Logic(logic, operand) => {
                    // Someone may have written it since it was tested.
                    let is_written = (last..end).any(|at| {
                        matches!(program.code[at as usize], Op::Assign(to) | Op::Set(to) | Op::Reset(to) if to == operand)
                    });
                    if is_written {
                        return None;
                    }
                    (logic, self.operand(areas, operand, (at, end), tree, depth)?)
                }
                Op::LogicTimer(logic, number) => {
                    let number = self.fixed(areas, number, (at, end))?;
                    let status = self.state.timers.get(usize::from(number))?.status(self.work.now);
                    (logic, tree.add(Node::Leaf(Some(Named::Timer(number)), status))?)
                }
                Op::LogicCounter(logic, number) => {
                    let number = self.fixed(areas, number, (at, end))?;
                    let status = self.state.counters.get(usize::from(number))?.value != 0;
                    (logic, tree.add(Node::Leaf(Some(Named::Counter(number)), status))?)
                }
                Op::LogicStatus(logic, _) => (logic, tree.add(Node::Open)?),
                _ => continue,
            };
            state = tree.combine(state, leaf.0, leaf.1)?;
        }
        if nests.is_empty() { tree.result(state) } else { None }
    }

    /// A comparison, with its operands if they are known.
    fn compared(&self, at: u32, tree: &mut Tree) -> Node {
        let flow = self.observed.as_ref().map(|observed| &observed.flow);
        let Some((origin, result)) = flow.and_then(|flow| flow.comparison(at)) else { return Node::Open };
        let (Some(reads), Ok(number)) = (origin.reads(), Index::try_from(tree.compared.len())) else {
            return Node::Open;
        };
        tree.compared.push(reads.iter().copied().collect());
        Node::Compared(number, result)
    }

    /// A leaf, or for a local bit the string that wrote it.
    fn operand<A: Areas>(
        &mut self,
        areas: &A,
        operand: Operand,
        (at, end): (u32, u32),
        tree: &mut Tree,
        depth: u8,
    ) -> Option<Index> {
        if let Operand::Direct(Space::Local, _) = operand {
            let spot = self.spot(areas, operand).ok()?;
            let value = self.read_bit(areas, spot).ok()?;
            let nodes = tree.nodes.len();
            let open = tree.open;
            if depth < DEEPEST
                && let Some(writer) = self.writer(operand, at)
                && let Some(root) = self.string(areas, writer, tree, depth + 1)
                && tree.open == open
                && tree.value(root, false) == value
            {
                return Some(root);
            }
            tree.nodes.truncate(nodes);
            tree.open = open;
            return tree.add(Node::Leaf(None, value));
        }
        let (named, value) = self.leaf(areas, operand, (at, end))?;
        tree.add(Node::Leaf(named, value))
    }

    /// The statement before an instruction that wrote a local bit, if nothing between them can jump over it.
    fn writer(&self, operand: Operand, before: u32) -> Option<u32> {
        let block = self.program.block_at(before)?.start;
        for at in (block..before).rev().take(LONGEST as usize) {
            match self.program.code[at as usize] {
                Op::Assign(to) if to == operand => return Some(at),
                Op::Set(to) | Op::Reset(to) if to == operand => return None,
                Op::Jump(..) | Op::JumpList(..) | Op::End(_) => return None,
                _ => {}
            }
        }
        None
    }

    /// The name and the present value of an operand that was tested at an instruction; `None` if registers that it needs have changed since.
    fn leaf<A: Areas>(&mut self, areas: &A, operand: Operand, (at, end): (u32, u32)) -> Option<(Option<Named>, bool)> {
        let needs_db = matches!(operand, Operand::Direct(Space::Data, _) | Operand::Register(..));
        let needs_registers = matches!(operand, Operand::Register(..) | Operand::Own(_) | Operand::Indirect(..));
        let mut db = None;
        for later in at..end {
            let op = self.program.code[later as usize];
            if later > at && needs_db && opens_db(op) {
                db = Some(self.opened_before(areas, at)?);
            }
            if later > at && needs_registers && moves_registers(op) {
                return None;
            }
        }
        let before = self.state.registers.db;
        if let Some(db) = db {
            self.state.registers.db = db;
        }
        let spot = self.spot(areas, operand);
        self.state.registers.db = before;
        let spot = spot.ok()?;
        Some((self.named(spot), self.read_bit(areas, spot).ok()?))
    }

    /// The data block that was open at an instruction, if a statement before it says so.
    fn opened_before<A: Areas>(&self, areas: &A, at: u32) -> Option<OpenBlock> {
        let block = self.program.block_at(at)?.start;
        for earlier in (block..at).rev().take(LONGEST as usize) {
            match self.program.code[earlier as usize] {
                Op::OpenDb(Number::Direct(number)) => return areas.block(number),
                op => match operand_of(op) {
                    Some(Operand::Block(number, _)) => return areas.block(number),
                    _ if opens_db(op) || matches!(op, Op::Jump(..) | Op::JumpList(..)) => return None,
                    _ => {}
                },
            }
        }
        None
    }

    /// The number of a timer or counter that was tested at an instruction.
    fn fixed<A: Areas>(&mut self, areas: &A, number: Number, (at, end): (u32, u32)) -> Option<u16> {
        if let Some(number) = direct(number) {
            return Some(number);
        }
        let moves = (at + 1..end).any(|later| {
            let op = self.program.code[later as usize];
            opens_db(op) || moves_registers(op)
        });
        if moves { None } else { self.number(areas, number).ok() }
    }
}

/// The operand of an instruction that has one.
fn operand_of(op: Op) -> Option<Operand> {
    match op {
        Op::Logic(_, operand)
        | Op::Assign(operand)
        | Op::Set(operand)
        | Op::Reset(operand)
        | Op::Edge(_, operand)
        | Op::Load(_, operand)
        | Op::Transfer(_, operand) => Some(operand),
        _ => None,
    }
}

/// Whether an instruction can change the DB register.
fn opens_db(op: Op) -> bool {
    match op {
        Op::OpenDb(_) | Op::SwapDb | Op::Copy(_) | Op::Pointer(_) | Op::Call(_) => true,
        op => matches!(operand_of(op), Some(Operand::Block(..) | Operand::Element(..) | Operand::Through(..))),
    }
}

/// Whether an instruction can change the address registers or DI.
fn moves_registers(op: Op) -> bool {
    matches!(
        op,
        Op::RegisterFromAccu(_)
            | Op::RegisterFromConstant(..)
            | Op::RegisterFromOperand(..)
            | Op::RegisterFromParameterAddress(..)
            | Op::RegisterFromOther
            | Op::OtherFromRegister
            | Op::SwapRegisters
            | Op::AddRegister(_)
            | Op::AddRegisterConstant(..)
            | Op::OpenDi(_)
            | Op::SwapDb
            | Op::Call(_)
    )
}

/// The number of a timer or counter, if it does not depend on memory.
fn direct(number: Number) -> Option<u16> {
    match number {
        Number::Direct(number) => Some(number),
        Number::At(..) | Number::Parameter(_) | Number::Own(_) => None,
    }
}
