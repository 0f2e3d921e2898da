//! The NC language of the ISG kernel and TwinCAT CNC: text, words, expressions, commands, control blocks (isg.md 2.8, 2.9, 3). The module knows
//! no axis and no machine.
//!
//! # The boundary
//!
//! A channel owns an [`Interpreter`], which is plain data, and implements [`Environment`]. It calls [`Interpreter::next`] whenever its buffer
//! of prepared blocks has room:
//!
//! | result | what the channel does |
//! |---|---|
//! | [`Prepared::Block`] | executes the [`Block`]; with [`End::Aborted`] it also raises a warning: M30 in a subroutine |
//! | [`Prepared::Waits`] | calls again when everything before has been executed |
//! | [`Prepared::Calculated`] | calls again in its next cycle |
//! | [`Prepared::Ended`] | there are no more blocks |
//! | a [`Fault`] | raises it; nothing of the block has been executed, and the program has ended |
//!
//! The interpreter has the P parameters and the variables `V.P.` and `V.L.`; all other `V.` variables are those of the channel. The channel
//! judges what needs a machine: whether an axis exists, the number of a coupling group, indices, circles, feed.
//!
//! # How a program is read
//!
//! Nothing is parsed before it is reached. Subroutines, labels and the ends of control blocks are searched in the text at the moment of
//! execution. [`check`] reads a whole program statically instead.
//!
//! # Strict and lenient
//!
//! The examples that the manuals print have slips: text behind commands, `:` for blocks left out, comments that are never closed, no header of
//! the main program (isg.md 3.6). Strict reading refuses them with line and column; `lenient` reads them as they were meant.
//!
//! # Where the manuals leave a choice
//!
//! | question | here |
//! |---|---|
//! | case | commands, control blocks, `V.` variables and names of axes in capitals, as the manuals write them; addresses (`g01`), functions (`sin[30]`), labels and names of programs in any case |
//! | blanks | allowed between an address and its value |
//! | calls | 20 deep |
//! | an unclosed `(` | ends with its line; `lenient`: reaches over lines that are no blocks if one of them closes it |
//! | M17 in a main program | `nc-syntax`; `lenient`: ends it |
//! | two signs behind an axis, `X--5` | `nc-syntax`, except for a modulo axis |
//! | G74 without axes | `nc-syntax`; `lenient`: a warning |
//! | `$IF` without `$ENDIF` | `nc-syntax`; `lenient`: a warning at the end of the program if its branch runs |
//! | the same axis or address twice in a block | `nc-syntax` |
//! | `V.L.` variables | belong to one program level |
//! | a jump into a loop | `nc-syntax`; into a branch it is allowed |

mod block;
mod check;
mod commands;
mod compose;
mod control;
mod cursor;
mod evaluate;
mod expression;
mod fault;
mod flow;
mod head;
mod interpreter;
mod lines;
mod link;
mod parse;
mod scope;
mod search;
mod state;
mod syntax;
mod variables;
mod words;

#[cfg(test)]
mod tests;

pub use block::{
    AxisRequest, Block, Command, Conflicts, Dwell, End, GantryTargets, Origin, PutTargets, Sign, is_modelled,
};
pub use check::{Finding, check, is_called};
pub use fault::{Fault, FaultCode, NUMBERS};
pub use interpreter::DEEPEST_CALL;
pub use link::{AxisReference, Form, Link, LinkOff, Pair};
pub use state::{Interpreter, Prepared};
pub use variables::{Environment, Refusal, Variables};
