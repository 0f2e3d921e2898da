//! Expressions: the tree, and the parser with the ranks of the dialect.

use serde::{Deserialize, Serialize};

use super::alarm::{Fault, Span};
use super::dialect::Dialect;
use super::function::Function;
use super::names::AxisNames;
use super::operator::{Operator, Prefix};

use super::token::{Kind, Symbol, Token};
use super::value::Value;
use super::vocabulary::{Command, is_keyword};

/// An expression.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Expression {
    Constant(Value),
    /// `R1`, `R[expression]`.
    RParameter {
        index: Box<Self>,
        at: Span,
    },
    /// A variable of DEF, or a parameter.
    Variable {
        name: String,
        indices: Vec<Self>,
        at: Span,
    },
    /// `$AA_IM[X]`.
    System {
        name: String,
        indices: Vec<Self>,
        at: Span,
    },
    Prefixed {
        operator: Prefix,
        operand: Box<Self>,
        at: Span,
    },
    Binary {
        operator: Operator,
        left: Box<Self>,
        right: Box<Self>,
        at: Span,
    },
    Function {
        function: Function,
        arguments: Vec<Self>,
        at: Span,
    },
    /// `SET(1,,3)`, `REP(0)`, `REP(0,5)`: values for an array, only to be assigned.
    List {
        is_repeated: bool,
        values: Vec<Option<Self>>,
        at: Span,
    },
}

impl Expression {
    /// Whether a part of the expression satisfies a test.
    pub(super) fn any(&self, test: &dyn Fn(&Self) -> bool) -> bool {
        test(self)
            || match self {
                Self::Constant(_) => false,
                Self::RParameter { index, .. } => index.any(test),
                Self::Variable { indices, .. } | Self::System { indices, .. } => {
                    indices.iter().any(|one| one.any(test))
                }
                Self::Prefixed { operand, .. } => operand.any(test),
                Self::Binary { left, right, .. } => left.any(test) || right.any(test),
                Self::Function { arguments, .. } => arguments.iter().any(|one| one.any(test)),
                Self::List { values, .. } => values.iter().flatten().any(|one| one.any(test)),
            }
    }
}

/// Whether a system variable is of the interpreter's time or of the movement's: `$A…`, `$V…` and `$R…`. Reading one makes preparation wait
/// until everything before has been executed.
pub(super) fn is_main_run(name: &str) -> bool {
    name.starts_with("$A") || name.starts_with("$V") || name.starts_with("$R") || name.starts_with("$$")
}

/// Parts of an expression, at most: an expression of a block needs a handful.
const LARGEST: usize = 200;

/// The parser of a block: its tokens, and the place in them.
#[derive(Debug)]
pub(super) struct Parser<'a> {
    pub(super) tokens: &'a [Token],
    pub(super) at: usize,
    pub(super) dialect: &'a Dialect,
    pub(super) axes: &'a AxisNames,
    /// Comparisons beside AND, OR, XOR or NOT without parentheses.
    pub(super) warnings: Vec<Span>,
    /// The columns behind the last token.
    pub(super) end: Span,
    parts: usize,
    depth: usize,
}

/// An expression, and whether its last operator is logical and outside parentheses.
type Parsed = (Expression, bool);

impl<'a> Parser<'a> {
    pub(super) fn new(tokens: &'a [Token], end: u32, dialect: &'a Dialect, axes: &'a AxisNames) -> Self {
        let end = Span { from: end, to: end };
        Self { tokens, at: 0, dialect, axes, warnings: Vec::new(), end, parts: 0, depth: 0 }
    }

    pub(super) fn kind(&self, ahead: usize) -> Option<&'a Kind> {
        self.tokens.get(self.at + ahead).map(|token| &token.kind)
    }

    /// The columns of the next token.
    pub(super) fn here(&self) -> Span {
        self.tokens.get(self.at).map_or(self.end, |token| token.at)
    }

    /// The columns of the last token.
    pub(super) fn before(&self) -> Span {
        self.at.checked_sub(1).and_then(|last| self.tokens.get(last)).map_or(self.end, |token| token.at)
    }

    pub(super) fn is_at_end(&self) -> bool {
        self.at >= self.tokens.len()
    }

    pub(super) fn is_symbol(&self, ahead: usize, symbol: Symbol) -> bool {
        self.kind(ahead) == Some(&Kind::Symbol(symbol))
    }

    pub(super) fn take_symbol(&mut self, symbol: Symbol) -> bool {
        let found = self.is_symbol(0, symbol);
        self.at += usize::from(found);
        found
    }

    pub(super) fn need(&mut self, symbol: Symbol, what: &str) -> Result<(), Fault> {
        if self.take_symbol(symbol) { Ok(()) } else { Err(self.syntax(format!("{what} is missing"))) }
    }

    pub(super) fn name(&self) -> Option<&'a str> {
        match self.kind(0) {
            Some(Kind::Name(name)) => Some(name),
            _ => None,
        }
    }

    pub(super) fn take_name(&mut self, wanted: &str) -> bool {
        let found = self.name() == Some(wanted);
        self.at += usize::from(found);
        found
    }

    pub(super) fn syntax(&self, reason: impl Into<String>) -> Fault {
        Fault::new(12080, self.here(), reason)
    }

    pub(super) fn expression(&mut self) -> Result<Expression, Fault> {
        self.parts = 0;
        self.nested()
    }

    fn nested(&mut self) -> Result<Expression, Fault> {
        let weakest = 11;
        self.ranked(weakest).map(|(expression, _)| expression)
    }

    /// An expression of operators of this rank and stronger ones, left to right.
    fn ranked(&mut self, rank: u8) -> Result<Parsed, Fault> {
        if rank < 2 {
            return self.operand();
        }
        // `<<` without a left side makes a text of a value.
        let is_text = self.is_symbol(0, Symbol::Join) && (self.dialect.rank)(Operator::Join) == rank;
        let (mut left, mut is_logical) =
            if is_text { (Expression::Constant(Value::Text(String::new())), false) } else { self.ranked(rank - 1)? };
        while let Some(operator) = self.operator().filter(|operator| (self.dialect.rank)(*operator) == rank) {
            let at = self.here();
            self.at += 1;
            self.count(at)?;
            let (right, is_right_logical) = self.ranked(rank - 1)?;
            if operator.is_comparison() && (is_logical || is_right_logical) {
                self.warnings.push(at);
            }
            is_logical = operator.is_logical() || is_logical && !operator.is_comparison();
            left = Expression::Binary { operator, left: Box::new(left), right: Box::new(right), at };
        }
        Ok((left, is_logical))
    }

    fn operator(&self) -> Option<Operator> {
        Some(match self.kind(0)? {
            Kind::Symbol(symbol) => match symbol {
                Symbol::Equal => Operator::Equal,
                Symbol::Unequal => Operator::Unequal,
                Symbol::Greater => Operator::Greater,
                Symbol::Less => Operator::Less,
                Symbol::GreaterOrEqual => Operator::GreaterOrEqual,
                Symbol::LessOrEqual => Operator::LessOrEqual,
                Symbol::Join => Operator::Join,
                Symbol::Plus => Operator::Add,
                Symbol::Minus => Operator::Subtract,
                Symbol::Times => Operator::Multiply,
                Symbol::Divide => Operator::Divide,
                Symbol::Colon => Operator::Chain,
                Symbol::Assign
                | Symbol::Open
                | Symbol::Close
                | Symbol::OpenIndex
                | Symbol::CloseIndex
                | Symbol::Comma => return None,
            },
            Kind::Name(name) => match name.as_str() {
                "DIV" => Operator::WholeDivide,
                "MOD" => Operator::Modulo,
                "B_AND" => Operator::BitAnd,
                "B_XOR" => Operator::BitXor,
                "B_OR" => Operator::BitOr,
                "AND" => Operator::And,
                "XOR" => Operator::Xor,
                "OR" => Operator::Or,
                _ => return None,
            },
            _ => return None,
        })
    }

    /// An operand with the operators before it, which bind strongest.
    fn operand(&mut self) -> Result<Parsed, Fault> {
        let at = self.here();
        let operator = match self.kind(0) {
            Some(Kind::Symbol(Symbol::Minus)) => Prefix::Minus,
            Some(Kind::Symbol(Symbol::Plus)) => {
                self.at += 1;
                self.count(at)?;
                return self.deeper(at, Self::operand);
            }
            Some(Kind::Name(name)) if name == "NOT" => Prefix::Not,
            Some(Kind::Name(name)) if name == "B_NOT" => Prefix::BitNot,
            _ => return Ok((self.primary()?, false)),
        };
        self.at += 1;
        self.count(at)?;
        let (operand, _) = self.deeper(at, Self::operand)?;
        Ok((Expression::Prefixed { operator, operand: Box::new(operand), at }, operator == Prefix::Not))
    }

    fn primary(&mut self) -> Result<Expression, Fault> {
        let at = self.here();
        self.count(at)?;
        let Some(kind) = self.kind(0) else { return Err(self.syntax("a value is missing")) };
        match kind {
            Kind::Int(value) => self.constant(Value::Int(*value)),
            Kind::Real(value) => self.constant(Value::Real(*value)),
            Kind::Text(text) => self.constant(Value::Text(text.clone())),
            Kind::Character(code) => self.constant(Value::Char(*code)),
            Kind::System(name) => {
                self.at += 1;
                let indices = self.indices()?;
                Ok(Expression::System { name: name.clone(), indices, at: at.until(self.before()) })
            }
            Kind::Numbered(numbered) => {
                self.at += 1;
                if numbered.letter == 'R'
                    && let Some(index) = numbered.whole()
                {
                    let index = Value::Real(f64::from(index));
                    return Ok(Expression::RParameter { index: Box::new(Expression::Constant(index)), at });
                }
                let name = numbered.name();
                match self.axes.find(&name) {
                    Some(axis) => Ok(Expression::Constant(Value::Axis(axis))),
                    None if numbered.letter == 'G' => {
                        Err(Fault::new(12080, at, "a value is missing: this is a G function"))
                    }
                    None => Err(Fault::new(12550, at, "neither an axis nor a variable has this name").about(name)),
                }
            }
            Kind::Name(name) => {
                self.at += 1;
                self.named(name, at)
            }
            Kind::Symbol(Symbol::Open) => {
                self.at += 1;
                let inside = self.deeper(at, Self::nested)?;
                self.need(Symbol::Close, "`)`")?;
                Ok(inside)
            }
            Kind::Symbol(_) => Err(self.syntax("a value is missing")),
        }
    }

    fn constant(&mut self, value: Value) -> Result<Expression, Fault> {
        self.at += 1;
        Ok(Expression::Constant(value))
    }

    fn named(&mut self, name: &str, at: Span) -> Result<Expression, Fault> {
        match name {
            "TRUE" => return Ok(Expression::Constant(Value::Bool(true))),
            "FALSE" => return Ok(Expression::Constant(Value::Bool(false))),
            _ => {}
        }
        if name == "R" {
            let indices = self.indices()?;
            return self.r_parameter(indices, at);
        }
        if self.is_symbol(0, Symbol::Open) {
            if let Some(function) = Function::find(name) {
                return self.function_call(function, at);
            }
            if let Some(what) = self.dialect.refused(name) {
                return Err(Fault::refused(at, what));
            }
            if matches!(name, "AC" | "IC" | "DC" | "ACP" | "ACN" | "QU") {
                return Err(Fault::new(12020, at, "only the value of an address has one"));
            }
            return Err(Fault::new(12550, at, "there is no function of this name"));
        }
        if let Some(axis) = self.axes.find(name) {
            return Ok(Expression::Constant(Value::Axis(axis)));
        }
        let is_word = is_keyword(name) || self.dialect.function(name).is_some() || Command::find(name).is_some();
        if is_word {
            return Err(Fault::new(12080, at, "a value is missing: this is a word of the language"));
        }
        let indices = self.indices()?;
        Ok(Expression::Variable { name: name.to_owned(), indices, at })
    }

    fn r_parameter(&mut self, indices: Vec<Expression>, at: Span) -> Result<Expression, Fault> {
        let at = at.until(self.before());
        let mut indices = indices.into_iter();
        match (indices.next(), indices.next()) {
            (Some(index), None) => Ok(Expression::RParameter { index: Box::new(index), at }),
            (None, _) => Err(Fault::new(12400, at, "R needs an index: `R[1]`")),
            (Some(_), Some(_)) => Err(Fault::new(12400, at, "R has one index")),
        }
    }

    fn function_call(&mut self, function: Function, at: Span) -> Result<Expression, Fault> {
        self.at += 1;
        let mut arguments = Vec::new();
        if !self.take_symbol(Symbol::Close) {
            loop {
                arguments.push(self.deeper(at, Self::nested)?);
                if !self.take_symbol(Symbol::Comma) {
                    break;
                }
            }
            self.need(Symbol::Close, "`)`")?;
        }
        let (least, most) = function.parameters();
        let at = at.until(self.before());
        if !(least..=most).contains(&arguments.len()) {
            let reason = format!("{} parameters, the function has {least}", arguments.len());
            return Err(Fault::new(14020, at, reason));
        }
        Ok(Expression::Function { function, arguments, at })
    }

    /// The indices in brackets, if there are any.
    pub(super) fn indices(&mut self) -> Result<Vec<Expression>, Fault> {
        let at = self.here();
        let mut indices = Vec::new();
        if self.take_symbol(Symbol::OpenIndex) {
            loop {
                if self.is_symbol(0, Symbol::CloseIndex) && indices.is_empty() {
                    return Err(Fault::new(12400, at, "the index is missing"));
                }
                indices.push(self.deeper(at, Self::nested)?);
                if !self.take_symbol(Symbol::Comma) {
                    break;
                }
            }
            self.need(Symbol::CloseIndex, "`]`")?;
        }
        Ok(indices)
    }

    fn deeper<T>(&mut self, at: Span, parse: fn(&mut Self) -> Result<T, Fault>) -> Result<T, Fault> {
        if self.depth >= DEEPEST {
            return Err(Fault::new(14050, at, format!("more than {DEEPEST} levels")));
        }
        self.depth += 1;
        let parsed = parse(self);
        self.depth -= 1;
        parsed
    }

    fn count(&mut self, at: Span) -> Result<(), Fault> {
        self.parts += 1;
        if self.parts <= LARGEST {
            return Ok(());
        }
        Err(Fault::new(14050, at, format!("an expression has at most {LARGEST} parts")))
    }
}

/// Parentheses inside each other, at most.
const DEEPEST: usize = 20;
