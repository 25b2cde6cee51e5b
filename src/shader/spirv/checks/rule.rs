//! The checks of a module at run time: operations whose result GLSL or SPIR-V leaves open, and what the author asserts and prints.

use std::fmt;

/// A rule that an operation can break. Sources: The OpenGL Shading Language 4.60, chapters 5.1, 5.7, 5.9 and 8; SPIR-V 1.6, section 3.52;
/// GLSL.std.450.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Rule {
    /// `/` or `%` with 0 on the right; `mod()` of 0.
    DivisionByZero,
    /// `pow(x, y)` with x < 0, or with x = 0 and y <= 0.
    Pow,
    /// `normalize()` of a vector whose length is 0.
    Normalize,
    /// `sqrt(x)` with x < 0.
    Sqrt,
    /// `inversesqrt(x)` with x <= 0.
    InverseSqrt,
    /// `log(x)` or `log2(x)` with x <= 0.
    Log,
    /// `asin(x)` or `acos(x)` with |x| > 1.
    Arc,
    /// `atan(y, x)` with both 0.
    Atan,
    /// `acosh(x)` with x < 1.
    Acosh,
    /// `atanh(x)` with |x| >= 1.
    Atanh,
    /// `clamp(x, low, high)` with low > high.
    Clamp,
    /// `smoothstep(low, high, x)` with low >= high.
    Smoothstep,
    /// `inverse()` of a matrix whose determinant is 0.
    Inverse,
    /// An index beyond an array, a matrix or a vector.
    Index,
    /// A float that its integer type cannot hold, or NaN.
    ToInteger,
    /// A shift by 32 bits or more, or by less than 0.
    Shift,
    /// `bitfieldExtract()` or `bitfieldInsert()` of bits beyond the 32.
    Bits,
    /// A variable that is read on a path that has not set it.
    Unset,
    /// A derivative, or a level of detail, of a quad whose invocations do not all run along.
    Derivative,
    /// The condition of an `assert()`.
    Assert,
    /// A `print()`, which is no rule: it tells a value wherever it runs.
    Print,
}

impl Rule {
    /// All rules about what is undefined.
    pub const UNDEFINED: [Self; 19] = [
        Self::DivisionByZero,
        Self::Pow,
        Self::Normalize,
        Self::Sqrt,
        Self::InverseSqrt,
        Self::Log,
        Self::Arc,
        Self::Atan,
        Self::Acosh,
        Self::Atanh,
        Self::Clamp,
        Self::Smoothstep,
        Self::Inverse,
        Self::Index,
        Self::ToInteger,
        Self::Shift,
        Self::Bits,
        Self::Unset,
        Self::Derivative,
    ];

    /// A name for scripts, as "division-by-zero".
    pub fn name(self) -> &'static str {
        match self {
            Self::DivisionByZero => "division-by-zero",
            Self::Pow => "pow",
            Self::Normalize => "normalize",
            Self::Sqrt => "sqrt",
            Self::InverseSqrt => "inversesqrt",
            Self::Log => "log",
            Self::Arc => "asin-acos",
            Self::Atan => "atan",
            Self::Acosh => "acosh",
            Self::Atanh => "atanh",
            Self::Clamp => "clamp",
            Self::Smoothstep => "smoothstep",
            Self::Inverse => "inverse",
            Self::Index => "index",
            Self::ToInteger => "float-to-integer",
            Self::Shift => "shift",
            Self::Bits => "bit-field",
            Self::Unset => "unset",
            Self::Derivative => "derivative",
            Self::Assert => "assert",
            Self::Print => "print",
        }
    }
}

/// The undefined operation, as a reader of the shader says it.
impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::DivisionByZero => "division by 0",
            Self::Pow => "pow() of a negative base, or of 0 with an exponent that is not positive",
            Self::Normalize => "normalize() of a vector of length 0",
            Self::Sqrt => "sqrt() of a negative number",
            Self::InverseSqrt => "inversesqrt() of 0 or a negative number",
            Self::Log => "a logarithm of 0 or a negative number",
            Self::Arc => "asin() or acos() of a number beyond -1 to 1",
            Self::Atan => "atan() of 0 and 0",
            Self::Acosh => "acosh() of a number below 1",
            Self::Atanh => "atanh() of a number that is not between -1 and 1",
            Self::Clamp => "clamp() with a minimum above its maximum",
            Self::Smoothstep => "smoothstep() whose second edge is not above its first",
            Self::Inverse => "inverse() of a matrix whose determinant is 0",
            Self::Index => "an index beyond the last element",
            Self::ToInteger => "a conversion to an integer that cannot hold the number",
            Self::Shift => "a shift by more bits than there are",
            Self::Bits => "bits beyond the last one",
            Self::Unset => "a variable that is read before it is set",
            Self::Derivative => "a derivative or a level of detail in a branch that only some pixels of a quad take",
            Self::Assert => "assertion failed",
            Self::Print => "print",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manual_lists_all_rules() {
        let manual = include_str!("../../../../assets/manual/command-line.md");
        for rule in Rule::UNDEFINED {
            assert!(manual.contains(&format!("`{}`", rule.name())), "{rule:?}");
        }
    }
}
