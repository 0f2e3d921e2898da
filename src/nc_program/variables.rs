//! Variables of a program level: those of DEF, and parameters. They live as long as the level.

use serde::{Deserialize, Serialize};

use super::alarm::{Fault, Span};
use super::value::{Type, Value, integer};

/// A variable, or an array of up to three dimensions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) kind: Type,
    pub(super) dimensions: Vec<u32>,
    pub(super) content: Content,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Content {
    /// The values; of an array with the last index fastest.
    Values(Vec<Value>),
    /// A VAR parameter: the variable of a caller.
    Reference(Reference),
}

/// The variable behind a VAR parameter. It never is a reference itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Reference {
    /// A variable of a level, or one element of it.
    Variable {
        level: usize,
        variable: usize,
        element: Option<usize>,
    },
    RParameter(u32),
}

/// The number of elements of an array, at most. The control is limited by its memory.
const LARGEST: u32 = 100_000;

impl Variable {
    /// A variable with the initial values of its type.
    pub(super) fn new(name: &str, kind: Type, dimensions: Vec<u32>, at: Span) -> Result<Self, Fault> {
        let wrong = |reason: String| Err(Fault::new(12430, at, reason));
        if dimensions.len() > 3 {
            return wrong(format!("{} dimensions, at most 3 are possible", dimensions.len()));
        }
        let count = dimensions.iter().try_fold(1_u32, |count, size| count.checked_mul(*size));
        match count {
            Some(count) if (1..=LARGEST).contains(&count) => {
                let values = vec![kind.initial(); count as usize];
                Ok(Self { name: name.to_owned(), kind, dimensions, content: Content::Values(values) })
            }
            _ => wrong(format!("an array has 1 to {LARGEST} elements")),
        }
    }

    pub(super) fn reference(name: &str, kind: Type, dimensions: Vec<u32>, reference: Reference) -> Self {
        Self { name: name.to_owned(), kind, dimensions, content: Content::Reference(reference) }
    }
}

/// The element of an array that indices mean.
pub(super) fn element(dimensions: &[u32], indices: &[i32], at: Span) -> Result<usize, Fault> {
    if dimensions.len() != indices.len() {
        let reason = format!("{} indices, the variable has {} dimensions", indices.len(), dimensions.len());
        return Err(Fault::new(12400, at, reason));
    }
    let mut element = 0_usize;
    for (size, index) in dimensions.iter().zip(indices) {
        let found = u32::try_from(*index).ok().filter(|index| index < size);
        let found =
            found.ok_or_else(|| Fault::new(12430, at, format!("index {index} is outside 0 to {}", size - 1)))?;
        element = element * (*size as usize) + found as usize;
    }
    Ok(element)
}

/// An index: a number, rounded.
pub(super) fn index(value: &Value, at: Span) -> Result<i32, Fault> {
    match value {
        Value::Int(_) | Value::Real(_) | Value::Char(_) => integer(value.number().unwrap_or_default(), at),
        Value::Bool(_) | Value::Text(_) | Value::Axis(_) | Value::Frame(_) => {
            Err(Fault::new(12410, at, format!("an index is a number, this is {}", value.of_type().name())))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_has_up_to_three_dimensions_and_a_limited_size() {
        let new = |dimensions: &[u32]| Variable::new("A", Type::Int, dimensions.to_vec(), Span::default());
        assert!(new(&[]).is_ok() && new(&[2, 3, 4]).is_ok());
        for wrong in [&[1, 1, 1, 1][..], &[0], &[100_000, 100_000], &[u32::MAX, u32::MAX]] {
            assert_eq!(new(wrong).unwrap_err().number, 12430, "{wrong:?}");
        }
    }

    #[test]
    fn indices_select_an_element_and_are_tested() {
        let at = Span::default();
        assert_eq!(element(&[2, 3], &[1, 2], at), Ok(5));
        assert_eq!(element(&[2, 3], &[1], at).unwrap_err().number, 12400);
        assert_eq!(element(&[2, 3], &[1, 3], at).unwrap_err().number, 12430);
        assert_eq!(element(&[2], &[-1], at).unwrap_err().number, 12430);
        assert_eq!(index(&Value::Real(1.5), at), Ok(2));
        assert_eq!(index(&Value::Text("1".to_owned()), at).unwrap_err().number, 12410);
    }
}
