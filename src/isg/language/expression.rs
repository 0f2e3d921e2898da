//! Expressions as a tree: numbers, P parameters, `V.` variables, operators, functions with arguments in `[ ]`.
//!
//! Ranks, strongest first: sign, `**`, then `*` `/` `MOD`, `+` `-`, `&`, `^`, `|`, comparisons, `&&` `AND`, `XOR`, `||` `OR`; equal ranks from left
//! to right. The ranks of bit operators, comparisons and logic are those of C, after which the manual models its control blocks.

use super::cursor::Cursor;
use super::fault::Error;

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Expression {
    Number(f64),
    Variable(Place),
    Minus(Box<Self>),
    Binary { operator: Operator, left: Box<Self>, right: Box<Self>, at: usize },
    Function { function: Function, arguments: Vec<Self>, at: usize },
}

/// A P parameter or a `V.` variable: `P10`, `P10[3]`, `V.G.T[2].X`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Place {
    /// The name, with `[]` for each index.
    pub(super) name: String,
    pub(super) indices: Vec<Expression>,
    pub(super) at: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
    Power,
    Multiply,
    Divide,
    Modulo,
    Add,
    Subtract,
    BitAnd,
    BitXor,
    BitOr,
    Equal,
    Unequal,
    LessOrEqual,
    GreaterOrEqual,
    Less,
    Greater,
    And,
    Xor,
    Or,
}

/// Symbols, those that begin with another one first; and their ranks.
const SYMBOLS: [(&str, Operator, u8); 16] = [
    ("**", Operator::Power, 10),
    ("*", Operator::Multiply, 9),
    ("/", Operator::Divide, 9),
    ("+", Operator::Add, 8),
    ("-", Operator::Subtract, 8),
    ("&&", Operator::And, 3),
    ("&", Operator::BitAnd, 7),
    ("^", Operator::BitXor, 6),
    ("||", Operator::Or, 1),
    ("|", Operator::BitOr, 5),
    ("==", Operator::Equal, 4),
    ("!=", Operator::Unequal, 4),
    ("<=", Operator::LessOrEqual, 4),
    (">=", Operator::GreaterOrEqual, 4),
    ("<", Operator::Less, 4),
    (">", Operator::Greater, 4),
];

const WORDS: [(&str, Operator, u8); 4] =
    [("MOD", Operator::Modulo, 9), ("AND", Operator::And, 3), ("XOR", Operator::Xor, 2), ("OR", Operator::Or, 1)];

/// The rank of the operand of a sign: `-2 ** 2` is −4.
const SIGN: u8 = 10;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Abs,
    Square,
    Root,
    Exponential,
    Logarithm,
    PowerOfTen,
    LogarithmOfTen,
    Sine,
    Cosine,
    Tangent,
    Cotangent,
    ArcSine,
    ArcCosine,
    ArcTangent,
    ArcCotangent,
    ArcTangentOfTwo,
    Integer,
    Fraction,
    Round,
    Not,
    Invert,
    Ceiling,
    Floor,
    Minimum,
    Maximum,
}

/// Functions and how many arguments they have.
const FUNCTIONS: [(&str, Function, usize); 25] = [
    ("ABS", Function::Abs, 1),
    ("SQR", Function::Square, 1),
    ("SQRT", Function::Root, 1),
    ("EXP", Function::Exponential, 1),
    ("LN", Function::Logarithm, 1),
    ("DEXP", Function::PowerOfTen, 1),
    ("LOG", Function::LogarithmOfTen, 1),
    ("SIN", Function::Sine, 1),
    ("COS", Function::Cosine, 1),
    ("TAN", Function::Tangent, 1),
    ("COT", Function::Cotangent, 1),
    ("ASIN", Function::ArcSine, 1),
    ("ACOS", Function::ArcCosine, 1),
    ("ATAN", Function::ArcTangent, 1),
    ("ACOT", Function::ArcCotangent, 1),
    ("ATAN2", Function::ArcTangentOfTwo, 2),
    ("INT", Function::Integer, 1),
    ("FRACT", Function::Fraction, 1),
    ("ROUND", Function::Round, 1),
    ("NOT", Function::Not, 1),
    ("INV", Function::Invert, 1),
    ("CEIL", Function::Ceiling, 1),
    ("FLOOR", Function::Floor, 1),
    ("MIN", Function::Minimum, 2),
    ("MAX", Function::Maximum, 2),
];

/// Parts of one expression, so that no text needs too much stack.
const PARTS: usize = 250;

/// Brackets and signs inside each other, for the same reason.
const DEPTH: usize = 50;

/// Reads an expression.
pub(super) fn expression(cursor: &mut Cursor<'_>) -> Result<Expression, Error> {
    Parser { cursor, parts: 0, depth: 0 }.binary(0)
}

/// Reads the name of a P parameter or a `V.` variable; nothing if something else follows.
pub(super) fn place(cursor: &mut Cursor<'_>) -> Result<Option<Place>, Error> {
    Parser { cursor, parts: 0, depth: 0 }.place()
}

/// Whether a P parameter or a `V.` variable follows.
pub(super) fn is_place(cursor: &Cursor<'_>) -> bool {
    let rest = cursor.rest();
    let follows =
        |letter: char, next: fn(char) -> bool| rest.strip_prefix(letter).is_some_and(|rest| rest.starts_with(next));
    follows('P', |next| next.is_ascii_digit())
        || follows('p', |next| next.is_ascii_digit())
        || follows('V', |next| next == '.')
            && rest[2..].starts_with(|next: char| next.is_ascii_alphabetic() || next == '_')
}

struct Parser<'p, 'a> {
    cursor: &'p mut Cursor<'a>,
    parts: usize,
    depth: usize,
}

impl Parser<'_, '_> {
    fn count(&mut self) -> Result<(), Error> {
        self.parts += 1;
        if self.parts > PARTS {
            let text = format!("the expression has more than {PARTS} parts; calculate a part of it in a block before");
            return Err(Error::syntax(self.cursor.at(), text));
        }
        Ok(())
    }

    fn binary(&mut self, least: u8) -> Result<Expression, Error> {
        let mut left = self.signed()?;
        while let Some((operator, rank, at)) = self.operator(least) {
            let right = self.binary(rank + 1)?;
            left = Expression::Binary { operator, left: Box::new(left), right: Box::new(right), at };
        }
        Ok(left)
    }

    /// The operator that follows, if its rank is high enough.
    fn operator(&mut self, least: u8) -> Option<(Operator, u8, usize)> {
        let mut next = *self.cursor;
        next.skip_blanks();
        let at = next.at();
        let symbol = SYMBOLS.iter().find(|(symbol, ..)| next.rest().starts_with(symbol));
        let (operator, rank) = if let Some((symbol, operator, rank)) = symbol {
            next.eat(symbol);
            (*operator, *rank)
        } else {
            let (_, operator, rank) = WORDS.iter().find(|(word, ..)| next.eat_word(word))?;
            (*operator, *rank)
        };
        (rank >= least).then(|| {
            *self.cursor = next;
            (operator, rank, at)
        })
    }

    fn signed(&mut self) -> Result<Expression, Error> {
        self.count()?;
        self.depth += 1;
        let result = if self.depth > DEPTH {
            let text = format!("brackets and signs are nested more than {DEPTH} deep");
            Err(Error::syntax(self.cursor.at(), text))
        } else if self.cursor.eat("-") {
            self.binary(SIGN).map(|inner| Expression::Minus(Box::new(inner)))
        } else if self.cursor.eat("+") {
            self.binary(SIGN)
        } else {
            self.primary()
        };
        self.depth -= 1;
        result
    }

    fn primary(&mut self) -> Result<Expression, Error> {
        self.cursor.skip_blanks();
        let at = self.cursor.at();
        if self.cursor.eat("[") {
            let inner = self.binary(0)?;
            self.cursor.expect("]", "behind an expression")?;
            return Ok(inner);
        }
        if self.cursor.peek().is_some_and(|letter| letter.is_ascii_digit() || letter == '.') {
            return self.number();
        }
        if let Some(place) = self.place()? {
            return Ok(Expression::Variable(place));
        }
        let name = self.cursor.name();
        match name {
            "TRUE" => return Ok(Expression::Number(1.0)),
            "PI" => return Ok(Expression::Number(std::f64::consts::PI)),
            "FALSE" => return Ok(Expression::Number(0.0)),
            _ => {}
        }
        let Some((name, function, count)) = FUNCTIONS.iter().find(|(known, ..)| known.eq_ignore_ascii_case(name))
        else {
            let found = self.cursor.moved(at).found();
            let text = format!("expected a number, `[`, a P parameter, a V. variable or a function; found {found}");
            return Err(Error::syntax(at, text));
        };
        let form = format!("behind {name}");
        self.cursor.expect("[", &form)?;
        let mut arguments = vec![self.binary(0)?];
        while self.cursor.eat(",") {
            arguments.push(self.binary(0)?);
        }
        self.cursor.expect("]", &format!("behind the arguments of {name}"))?;
        if arguments.len() != *count {
            let text = format!("{name} has {count} argument(s), found {}", arguments.len());
            return Err(Error::syntax(at, text));
        }
        Ok(Expression::Function { function: *function, arguments, at })
    }

    fn number(&mut self) -> Result<Expression, Error> {
        let at = self.cursor.at();
        let text = self.cursor.while_letters(|letter| letter.is_ascii_digit() || letter == '.');
        let number: Option<f64> = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.map(Expression::Number).ok_or_else(|| Error::syntax(at, format!("`{text}` is no number")))
    }

    fn place(&mut self) -> Result<Option<Place>, Error> {
        self.cursor.skip_blanks();
        if !is_place(self.cursor) {
            return Ok(None);
        }
        let at = self.cursor.at();
        let mut place = Place { name: String::new(), indices: Vec::new(), at };
        if matches!(self.cursor.peek(), Some('P' | 'p')) {
            self.cursor.step();
            let digits = self.cursor.digits().trim_start_matches('0');
            if digits.is_empty() {
                return Err(Error::syntax(at, "the number of a P parameter is greater than 0"));
            }
            place.name = format!("P{digits}");
        }
        loop {
            if !place.name.starts_with('P') {
                let part =
                    self.cursor.while_letters(|letter| letter.is_ascii_alphanumeric() || matches!(letter, '_' | '.'));
                place.name.push_str(part);
            }
            if self.cursor.peek() != Some('[') {
                return Ok(Some(place));
            }
            self.count()?;
            self.cursor.step();
            place.indices.push(self.binary(0)?);
            self.cursor.expect("]", "behind an index")?;
            place.name.push_str("[]");
        }
    }
}

impl Expression {
    /// Calls a function for each variable in the expression.
    pub(super) fn for_each_variable(&self, call: &mut dyn FnMut(&str)) {
        match self {
            Self::Number(_) => {}
            Self::Variable(place) => place.for_each_variable(call),
            Self::Minus(inner) => inner.for_each_variable(call),
            Self::Binary { left, right, .. } => {
                left.for_each_variable(call);
                right.for_each_variable(call);
            }
            Self::Function { arguments, .. } => arguments.iter().for_each(|argument| argument.for_each_variable(call)),
        }
    }
}

impl Place {
    /// Calls a function for this variable and those in its indices.
    pub(super) fn for_each_variable(&self, call: &mut dyn FnMut(&str)) {
        call(&self.name);
        self.indices.iter().for_each(|index| index.for_each_variable(call));
    }
}
