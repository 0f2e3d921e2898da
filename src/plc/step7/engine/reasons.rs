//! The operands that made the RLO of an instruction: the logic string before it is read backwards and evaluated again with what its
//! operations have tested, and only if the result is the RLO, the operands on its decisive paths are named. So nothing is named that was not
//! tested, and nothing that decided is left out: where an operand has no name, its operation is named.

use arrayvec::ArrayVec;

use crate::plc::step7::instruction::{CopySource, Jump, Logic, Op, Operand, Space};

use super::bit_operations::local;
use super::contacts::Contact;
use super::cpu::Cpu;
use super::flow::width_of;
use super::memory::Areas;
use super::origin::Origin;
use super::read::{Named, OPERANDS, Read, TESTED};

/// The nodes of the tree of a logic string.
const NODES: usize = 128;
/// Instructions that are read backwards.
const LONGEST: u32 = 400;
/// Local bits that are followed to the string that wrote them, one within another.
const DEEPEST: u8 = 6;

type Index = u8;

#[derive(Clone, Copy, Debug)]
enum Node {
    /// What an operation tested.
    Leaf(Named, bool),
    /// A comparison, a status bit or a local bit: the number of what it was made of, and its result.
    Made(Index, bool),
    /// An edge: its result, its marker if that decided with its value before, and the logic before it.
    Edge(bool, Option<Named>, bool, Index),
    Not(Index),
    And(Index, Index),
    Or(Index, Index),
    Xor(Index, Index),
}

/// A logic string as a tree.
#[derive(Debug, Default)]
struct Tree {
    nodes: ArrayVec<Node, NODES>,
    /// Of what comparisons, status bits and local bits were made.
    made: Vec<ArrayVec<Read, OPERANDS>>,
}

/// The operands that decide, as long as they are complete.
#[derive(Debug, Default)]
struct Decisive {
    reads: ArrayVec<Read, TESTED>,
    is_cut: bool,
}

impl Decisive {
    fn add(&mut self, read: Read) {
        if !self.reads.contains(&read) {
            self.is_cut |= self.reads.try_push(read).is_err();
        }
    }
}

/// The present state of the string: the terms before `O`, and the term since.
#[derive(Clone, Copy, Debug, Default)]
struct Term {
    before: Option<Index>,
    term: Option<Index>,
}

impl Tree {
    fn add(&mut self, node: Node) -> Option<Index> {
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

    fn value(&self, index: Index) -> bool {
        match self.nodes[usize::from(index)] {
            Node::Leaf(_, value) | Node::Made(_, value) | Node::Edge(value, ..) => value,
            Node::Not(x) => !self.value(x),
            Node::And(x, y) => self.value(x) && self.value(y),
            Node::Or(x, y) => self.value(x) || self.value(y),
            Node::Xor(x, y) => self.value(x) != self.value(y),
        }
    }

    /// The leaves that decide the value of a node.
    fn decisive(&self, index: Index, found: &mut Decisive) {
        match self.nodes[usize::from(index)] {
            Node::Leaf(named, value) => found.add(Read::bit(named, value)),
            Node::Made(number, _) => self.made[usize::from(number)].iter().for_each(|read| found.add(*read)),
            Node::Edge(_, marker, before, inner) => {
                if let Some(marker) = marker {
                    found.add(Read::bit(marker, before));
                }
                self.decisive(inner, found);
            }
            Node::Not(x) => self.decisive(x, found),
            Node::And(x, y) | Node::Or(x, y) => {
                let is_and = matches!(self.nodes[usize::from(index)], Node::And(..));
                let value = self.value(index);
                for part in [x, y] {
                    // All of an AND that is true and of an OR that is false; else the parts that decided alone.
                    if value == is_and || self.value(part) == value {
                        self.decisive(part, found);
                    }
                }
            }
            Node::Xor(x, y) => {
                self.decisive(x, found);
                self.decisive(y, found);
            }
        }
    }
}

impl Cpu {
    /// The operands that made the RLO before an instruction that writes, or the operand that it copies.
    pub(super) fn reasons<A: Areas>(&mut self, areas: &A, op: Op, pc: u32, tested: &mut ArrayVec<Read, TESTED>) {
        if self.work.mcr.is_off() && !matches!(op, Op::Copy(_)) {
            // The zone of the MCR made the value.
            return;
        }
        if let Op::Copy(index) = op
            && width_of(self.program.copies[index as usize].bits).is_none()
        {
            self.copied_bit(areas, index, tested);
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
        let string = if matches!(op, Op::Transfer(..)) { None } else { self.string(pc, &mut tree, 0) };
        let (root, rlo) = match string {
            Some(root) => (root, self.state.registers.status.rlo),
            // After SET or CLR, and with a constant, the statement runs because of the jump before it.
            None => match self
                .guard(pc, matches!(op, Op::Transfer(..)))
                .and_then(|(jump, rlo)| Some((self.string(jump, &mut tree, 0)?, rlo)))
            {
                Some(guarded) => guarded,
                None => return,
            },
        };
        if let Some(decisive) = complete(&tree, root, rlo) {
            *tested = decisive;
        }
    }

    /// What a copy of a bit copies.
    fn copied_bit<A: Areas>(&mut self, areas: &A, index: u32, tested: &mut ArrayVec<Read, TESTED>) {
        let CopySource::Operand(operand) = self.program.copies[index as usize].from else { return };
        let Ok(spot) = self.spot(areas, operand) else { return };
        if let Some(bit) = local(spot) {
            let origin = self.observed.as_ref().map(|observed| observed.flow.of_local(bit, 1)).unwrap_or_default();
            tested.extend(origin.reads().unwrap_or_default().iter().copied());
        } else if let (Some(named), Ok(value)) = (self.named(spot), self.read_bit(areas, spot)) {
            tested.push(Read::bit(named, value));
        }
    }

    /// Of what the RLO before an instruction was made.
    pub(super) fn origin_of_rlo(&self, pc: u32) -> Origin {
        let mut tree = Tree::default();
        let root = self.string(pc, &mut tree, 0);
        let decisive = root.and_then(|root| complete(&tree, root, self.state.registers.status.rlo));
        decisive.map_or_else(Origin::default, |reads| Origin::made_of(&reads))
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

    fn contact(&self, at: u32) -> Option<Contact> {
        self.observed.as_ref()?.contacts.at(at)
    }

    /// Whether a logic string begins with a bit operation: a first check, but not behind `O`, where it goes on, also with `NOT` between them.
    fn begins_with(&self, at: u32, begin: u32) -> Option<bool> {
        let before = (begin..at).rev().map(|at| self.program.code[at as usize]);
        let mut before = before.skip_while(|op| leaves_rlo(*op) || matches!(op, Op::Not));
        Some(self.contact(at)?.is_first && before.next() != Some(Op::OrBeforeAnd))
    }

    /// The tree of the logic string that ends before an instruction.
    fn string(&self, end: u32, tree: &mut Tree, depth: u8) -> Option<Index> {
        let program = &self.program;
        // A string that a jump entered in its middle did not run as it stands.
        let begin = program.block_at(end)?.start.max(self.landed());
        let (mut start, mut last) = (end, end);
        let mut is_begun = false;
        let mut brackets = 0_u32;
        loop {
            if start <= begin || end - start >= LONGEST {
                return None;
            }
            start -= 1;
            match program.code[start as usize] {
                Op::CloseNest => brackets += 1,
                Op::OpenNest(_) => {
                    brackets = brackets.checked_sub(1)?;
                    if brackets == 0 && self.begins_with(start, begin)? {
                        break;
                    }
                }
                Op::Logic(..)
                | Op::LogicTimer(..)
                | Op::LogicCounter(..)
                | Op::LogicStatus(..)
                | Op::OrBeforeAnd
                | Op::Not
                | Op::Edge(..) => {
                    if brackets == 0 && self.begins_with(start, begin)? {
                        break;
                    }
                }
                // It overwrites the RLO.
                Op::Compare(..) => {
                    if brackets == 0 {
                        break;
                    }
                }
                // These end a string; between its end and the instruction they are further outputs.
                Op::Assign(_)
                | Op::Set(_)
                | Op::Reset(_)
                | Op::StartTimer(..)
                | Op::ResetTimer(_)
                | Op::FreeTimer(_)
                | Op::CountUp(_)
                | Op::CountDown(_)
                | Op::SetCounter(_)
                | Op::ResetCounter(_)
                | Op::FreeCounter(_)
                    if !is_begun =>
                {
                    last = start;
                    continue;
                }
                op if leaves_rlo(op) => continue,
                _ => return None,
            }
            is_begun = true;
        }
        self.build((start, last), tree, depth)
    }

    fn build(&self, (start, last): (u32, u32), tree: &mut Tree, depth: u8) -> Option<Index> {
        let mut nests: ArrayVec<(Term, Logic), 8> = ArrayVec::new();
        let mut state = Term::default();
        for at in start..last {
            let (logic, leaf) = match self.program.code[at as usize] {
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
                Op::Edge(is_positive, _) => {
                    let inner = tree.result(state)?;
                    let Contact { named, value, marker, .. } = self.contact(at)?;
                    // Where there was no edge although its logic is as it must be, the marker decided.
                    let named = named.filter(|_| !value && tree.value(inner) == is_positive);
                    state = Term { before: None, term: Some(tree.add(Node::Edge(value, named, marker, inner))?) };
                    continue;
                }
                Op::Compare(..) => {
                    let node = self.made(at, tree)?;
                    state = Term { before: None, term: Some(tree.add(node)?) };
                    continue;
                }
                Op::Logic(logic, operand) => (logic, self.operand(operand, at, tree, depth)?),
                Op::LogicTimer(logic, _) | Op::LogicCounter(logic, _) => {
                    let Contact { named, value, .. } = self.contact(at)?;
                    (logic, tree.add(Node::Leaf(named?, value))?)
                }
                Op::LogicStatus(logic, _) => {
                    let node = self.made(at, tree)?;
                    (logic, tree.add(node)?)
                }
                _ => continue,
            };
            state = tree.combine(state, logic, leaf)?;
        }
        if nests.is_empty() { tree.result(state) } else { None }
    }

    /// A comparison, a status bit or a local bit: what it was made of, or else itself.
    fn made(&self, at: u32, tree: &mut Tree) -> Option<Node> {
        let value = self.contact(at)?.value;
        let origin = self.observed.as_ref()?.flow.remembered(at);
        let (Some(reads), Ok(number)) = (origin.and_then(Origin::reads), Index::try_from(tree.made.len())) else {
            return Some(Node::Leaf(Named::Operation(at), value));
        };
        tree.made.push(reads.iter().copied().collect());
        Some(Node::Made(number, value))
    }

    /// A leaf, or for a local bit the string that wrote it.
    fn operand(&self, operand: Operand, at: u32, tree: &mut Tree, depth: u8) -> Option<Index> {
        let Contact { named, value, .. } = self.contact(at)?;
        if let Some(named) = named {
            return tree.add(Node::Leaf(named, value));
        }
        let (nodes, made) = (tree.nodes.len(), tree.made.len());
        if depth < DEEPEST
            && let Operand::Direct(Space::Local, bit) = operand
            && let Some(writer) = self.writer(bit, at)
            && let Some(root) = self.string(writer, tree, depth + 1)
            && tree.value(root) == value
        {
            return Some(root);
        }
        tree.nodes.truncate(nodes);
        tree.made.truncate(made);
        let node = self.made(at, tree)?;
        tree.add(node)
    }

    /// The statement before an instruction that wrote a local bit, if nothing between them can jump over it or write it otherwise.
    fn writer(&self, bit: u32, before: u32) -> Option<u32> {
        let begin = self.program.block_at(before)?.start.max(self.landed());
        for at in (begin..before).rev().take(LONGEST as usize) {
            match self.program.code[at as usize] {
                Op::Assign(Operand::Direct(Space::Local, to)) if to == bit => return Some(at),
                Op::Set(Operand::Direct(Space::Local, to)) | Op::Reset(Operand::Direct(Space::Local, to))
                    if to == bit =>
                {
                    return None;
                }
                // Another local bit.
                Op::Assign(Operand::Direct(..)) | Op::Set(Operand::Direct(..)) | Op::Reset(Operand::Direct(..)) => {}
                Op::Assign(to) | Op::Set(to) | Op::Reset(to) | Op::Edge(_, to) | Op::Transfer(_, to)
                    if may_be_local(to) =>
                {
                    return None;
                }
                Op::Jump(..) | Op::JumpList(..) | Op::End(_) | Op::Copy(_) | Op::Pointer(_) | Op::Call(_) => {
                    return None;
                }
                Op::CallPlain(..) | Op::CallNumber(..) | Op::OperandFromRegister(..) => return None,
                _ => {}
            }
        }
        None
    }
}

/// All operands that decide the result of a tree, if it is the RLO and there is room for them.
fn complete(tree: &Tree, root: Index, rlo: bool) -> Option<ArrayVec<Read, TESTED>> {
    if tree.value(root) != rlo {
        return None;
    }
    let mut found = Decisive::default();
    tree.decisive(root, &mut found);
    (!found.is_cut).then_some(found.reads)
}

/// Whether a write to an operand can reach the local data.
fn may_be_local(operand: Operand) -> bool {
    match operand {
        Operand::Direct(space, _) | Operand::Indirect(space, ..) => matches!(space, Space::Local | Space::Caller),
        Operand::Register(space, ..) => space.is_none_or(|space| matches!(space, Space::Local | Space::Caller)),
        Operand::Parameter(_) | Operand::Element(..) | Operand::Through(..) => true,
        Operand::Block(..) | Operand::Fixed(..) | Operand::Own(_) => false,
    }
}

/// Whether an instruction neither reads nor changes the logic string.
fn leaves_rlo(op: Op) -> bool {
    matches!(
        op,
        Op::Nothing
            | Op::Load(..)
            | Op::LoadConstant(_)
            | Op::LoadStatus
            | Op::LoadData(_)
            | Op::LoadTimer(..)
            | Op::LoadCounter(..)
            | Op::LoadParameterAddress(_)
            | Op::Transfer(..)
            | Op::Arithmetic(..)
            | Op::AddWord(_)
            | Op::AddDouble(_)
            | Op::Convert(_)
            | Op::WordLogic(..)
            | Op::WordLogicConstant(..)
            | Op::Shift(_)
            | Op::ShiftBy(..)
            | Op::Accumulators(_)
            | Op::Increment(_)
            | Op::Decrement(_)
            | Op::Save
            | Op::RegisterFromAccu(_)
            | Op::RegisterFromConstant(..)
            | Op::RegisterFromOperand(..)
            | Op::RegisterFromParameterAddress(..)
            | Op::RegisterFromOther
            | Op::AccuFromRegister(_)
            | Op::OperandFromRegister(..)
            | Op::OtherFromRegister
            | Op::SwapRegisters
            | Op::AddRegister(_)
            | Op::AddRegisterConstant(..)
            | Op::OpenDb(_)
            | Op::OpenDi(_)
            | Op::SwapDb
    )
}
