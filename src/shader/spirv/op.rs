//! The operations of SPIR-V that Specula reads, with what the words of their instructions are (SPIR-V specification, section 3.52).
//! A test compares them with the grammar that Khronos publishes.

/// Properties that the operations of a group share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// Sources, names and lines, which a driver does not need.
    Debug,
    /// Decorations.
    Annotation,
    /// Capabilities, imports, the memory model, the entry point and its modes.
    Mode,
    /// Types.
    Type,
    /// Constants and undefined values.
    Constant,
    /// Functions and the structure of their blocks.
    Function,
    /// The last instructions of blocks.
    End,
    /// Variables, pointers and their memory.
    Memory,
    /// Parts of composites. The result depends on nothing but the operands.
    Composite,
    /// Reads sampled images.
    Sample,
    /// Images and their texels.
    Image,
    /// Properties of images.
    Query,
    /// Conversions, arithmetic, logic, bits and derivatives. The result depends on nothing but the operands.
    Value,
    /// Barriers and atomics.
    Synchronization,
    /// All others.
    Other,
}

/// Declares the operations: name and number as in the specification, and a letter for each word of their instructions.
///
/// `T`: the result's type; `R`: the result; `I`: an id; `L`: a literal; `S`: a string; `A`: a mask of memory operands and what it
/// announces; `C`: the cases of a switch, each a literal and a label; `N`: a string and the ids behind it; `O`: an operation and its
/// operands; `?`: no pass knows these operands. A small letter stands for any number of such words, from none on.
macro_rules! operations {
    ($($class:ident { $($name:ident = $code:literal $words:literal,)+ })+) => {
        /// An operation.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u16)]
        #[expect(clippy::enum_variant_names, reason = "the specification's names")]
        pub enum Op {
            $($($name = $code,)+)+
            /// An operation that is not listed here.
            Unknown = u16::MAX,
        }

        impl Op {
            /// The operation with this number, which is in the low half of an instruction's first word.
            pub fn of(word: u32) -> Self {
                match word & 0xffff {
                    $($($code => Self::$name,)+)+
                    _ => Self::Unknown,
                }
            }

            /// Its group.
            pub fn class(self) -> Class {
                match self {
                    $($(Self::$name)|+ => Class::$class,)+
                    Self::Unknown => Class::Other,
                }
            }

            /// A letter for each word.
            const fn letters(self) -> &'static [u8] {
                match self {
                    $($(Self::$name => $words.as_bytes(),)+)+
                    Self::Unknown => b"?",
                }
            }
        }

        #[cfg(test)]
        const ALL: &[(u32, &str, &str)] = &[$($(($code, stringify!($name), $words),)+)+];
    };
}

operations! {
    Debug {
        SourceContinued = 2 "S", Source = 3 "LLis", SourceExtension = 4 "S", Name = 5 "IS", MemberName = 6 "ILS",
        String = 7 "RS", Line = 8 "ILL", NoLine = 317 "", ModuleProcessed = 330 "S",
    }
    Annotation {
        Decorate = 71 "IL", MemberDecorate = 72 "ILL", DecorateId = 332 "?", DecorateString = 5632 "?",
        MemberDecorateString = 5633 "?",
    }
    Mode {
        Extension = 10 "S", ExtInstImport = 11 "RS", MemoryModel = 14 "LL", EntryPoint = 15 "LIn",
        ExecutionMode = 16 "IL", Capability = 17 "L", ExecutionModeId = 331 "?",
    }
    Type {
        TypeVoid = 19 "R", TypeBool = 20 "R", TypeInt = 21 "RLL", TypeFloat = 22 "RLl", TypeVector = 23 "RIL",
        TypeMatrix = 24 "RIL", TypeImage = 25 "RILLLLLLl", TypeSampler = 26 "R", TypeSampledImage = 27 "RI",
        TypeArray = 28 "RII", TypeRuntimeArray = 29 "RI", TypeStruct = 30 "Ri", TypePointer = 32 "RLI",
        TypeFunction = 33 "RIi", TypeForwardPointer = 39 "IL",
    }
    Constant {
        Undef = 1 "TR", ConstantTrue = 41 "TR", ConstantFalse = 42 "TR", Constant = 43 "TRL",
        ConstantComposite = 44 "TRi", ConstantNull = 46 "TR", SpecConstantTrue = 48 "TR", SpecConstantFalse = 49 "TR",
        SpecConstant = 50 "TRL", SpecConstantComposite = 51 "TRi", SpecConstantOp = 52 "TRO",
    }
    Function {
        Function = 54 "TRLI", FunctionParameter = 55 "TR", FunctionEnd = 56 "", FunctionCall = 57 "TRIi",
        Phi = 245 "TRi", LoopMerge = 246 "IIL", SelectionMerge = 247 "IL", Label = 248 "R",
    }
    End {
        Branch = 249 "I", BranchConditional = 250 "IIIl", Switch = 251 "IIc", Kill = 252 "", Return = 253 "",
        ReturnValue = 254 "I", Unreachable = 255 "", TerminateInvocation = 4416 "", EmitMeshTasksEXT = 5294 "?",
    }
    Memory {
        Variable = 59 "TRLi", ImageTexelPointer = 60 "TRIII", Load = 61 "TRIa", Store = 62 "IIa", CopyMemory = 63 "?",
        AccessChain = 65 "TRIi", InBoundsAccessChain = 66 "TRIi", ArrayLength = 68 "TRIL",
    }
    Composite {
        VectorExtractDynamic = 77 "TRII", VectorInsertDynamic = 78 "TRIII", VectorShuffle = 79 "TRIIl",
        CompositeConstruct = 80 "TRi", CompositeExtract = 81 "TRIl", CompositeInsert = 82 "TRIIl",
        Transpose = 84 "TRI", CopyLogical = 400 "TRI",
    }
    Sample {
        ImageSampleImplicitLod = 87 "TRIIli", ImageSampleExplicitLod = 88 "TRIILi",
        ImageSampleDrefImplicitLod = 89 "TRIIIli", ImageSampleDrefExplicitLod = 90 "TRIIILi",
        ImageSampleProjImplicitLod = 91 "TRIIli", ImageSampleProjExplicitLod = 92 "TRIILi",
        ImageSampleProjDrefImplicitLod = 93 "TRIIIli", ImageSampleProjDrefExplicitLod = 94 "TRIIILi",
        ImageFetch = 95 "TRIIli", ImageGather = 96 "TRIIIli", ImageDrefGather = 97 "TRIIIli",
    }
    Image {
        SampledImage = 86 "TRII", ImageRead = 98 "TRIIli", ImageWrite = 99 "IIIli",
    }
    Query {
        Image = 100 "TRI", ImageQuerySizeLod = 103 "TRII", ImageQuerySize = 104 "TRI", ImageQueryLod = 105 "TRII",
        ImageQueryLevels = 106 "TRI", ImageQuerySamples = 107 "TRI",
    }
    Value {
        ConvertFToU = 109 "TRI", ConvertFToS = 110 "TRI", ConvertSToF = 111 "TRI", ConvertUToF = 112 "TRI",
        UConvert = 113 "TRI", SConvert = 114 "TRI", FConvert = 115 "TRI", QuantizeToF16 = 116 "TRI",
        ConvertPtrToU = 117 "TRI", SatConvertSToU = 118 "TRI", SatConvertUToS = 119 "TRI", ConvertUToPtr = 120 "TRI",
        PtrCastToGeneric = 121 "TRI", GenericCastToPtr = 122 "TRI", GenericCastToPtrExplicit = 123 "TRIL",
        Bitcast = 124 "TRI", SNegate = 126 "TRI", FNegate = 127 "TRI", IAdd = 128 "TRII", FAdd = 129 "TRII",
        ISub = 130 "TRII", FSub = 131 "TRII", IMul = 132 "TRII", FMul = 133 "TRII", UDiv = 134 "TRII",
        SDiv = 135 "TRII", FDiv = 136 "TRII", UMod = 137 "TRII", SRem = 138 "TRII", SMod = 139 "TRII",
        FRem = 140 "TRII", FMod = 141 "TRII", VectorTimesScalar = 142 "TRII", MatrixTimesScalar = 143 "TRII",
        VectorTimesMatrix = 144 "TRII", MatrixTimesVector = 145 "TRII", MatrixTimesMatrix = 146 "TRII",
        OuterProduct = 147 "TRII", Dot = 148 "TRII", IAddCarry = 149 "TRII", ISubBorrow = 150 "TRII",
        UMulExtended = 151 "TRII", SMulExtended = 152 "TRII", Any = 154 "TRI", All = 155 "TRI", IsNan = 156 "TRI",
        IsInf = 157 "TRI", IsFinite = 158 "TRI", IsNormal = 159 "TRI", SignBitSet = 160 "TRI",
        LessOrGreater = 161 "TRII", Ordered = 162 "TRII", Unordered = 163 "TRII", LogicalEqual = 164 "TRII",
        LogicalNotEqual = 165 "TRII", LogicalOr = 166 "TRII", LogicalAnd = 167 "TRII", LogicalNot = 168 "TRI",
        Select = 169 "TRIII", IEqual = 170 "TRII", INotEqual = 171 "TRII", UGreaterThan = 172 "TRII",
        SGreaterThan = 173 "TRII", UGreaterThanEqual = 174 "TRII", SGreaterThanEqual = 175 "TRII",
        ULessThan = 176 "TRII", SLessThan = 177 "TRII", ULessThanEqual = 178 "TRII", SLessThanEqual = 179 "TRII",
        FOrdEqual = 180 "TRII", FUnordEqual = 181 "TRII", FOrdNotEqual = 182 "TRII", FUnordNotEqual = 183 "TRII",
        FOrdLessThan = 184 "TRII", FUnordLessThan = 185 "TRII", FOrdGreaterThan = 186 "TRII",
        FUnordGreaterThan = 187 "TRII", FOrdLessThanEqual = 188 "TRII", FUnordLessThanEqual = 189 "TRII",
        FOrdGreaterThanEqual = 190 "TRII", FUnordGreaterThanEqual = 191 "TRII", ShiftRightLogical = 194 "TRII",
        ShiftRightArithmetic = 195 "TRII", ShiftLeftLogical = 196 "TRII", BitwiseOr = 197 "TRII",
        BitwiseXor = 198 "TRII", BitwiseAnd = 199 "TRII", Not = 200 "TRI", BitFieldInsert = 201 "TRIIII",
        BitFieldSExtract = 202 "TRIII", BitFieldUExtract = 203 "TRIII", BitReverse = 204 "TRI", BitCount = 205 "TRI",
        DPdx = 207 "TRI", DPdy = 208 "TRI", Fwidth = 209 "TRI", DPdxFine = 210 "TRI", DPdyFine = 211 "TRI",
        FwidthFine = 212 "TRI", DPdxCoarse = 213 "TRI", DPdyCoarse = 214 "TRI", FwidthCoarse = 215 "TRI",
    }
    Synchronization {
        ControlBarrier = 224 "III", MemoryBarrier = 225 "II", AtomicLoad = 227 "TRIII", AtomicStore = 228 "IIII",
        AtomicExchange = 229 "TRIIII", AtomicCompareExchange = 230 "TRIIIIII",
        AtomicCompareExchangeWeak = 231 "TRIIIIII", AtomicIIncrement = 232 "TRIII", AtomicIDecrement = 233 "TRIII",
        AtomicIAdd = 234 "TRIIII", AtomicISub = 235 "TRIIII", AtomicSMin = 236 "TRIIII", AtomicUMin = 237 "TRIIII",
        AtomicSMax = 238 "TRIIII", AtomicUMax = 239 "TRIIII", AtomicAnd = 240 "TRIIII", AtomicOr = 241 "TRIIII",
        AtomicXor = 242 "TRIIII",
    }
    Other {
        Nop = 0 "?", ExtInst = 12 "TRILi", CopyObject = 83 "TRI", EmitVertex = 218 "", EndPrimitive = 219 "",
        SetMeshOutputsEXT = 5295 "?", DemoteToHelperInvocation = 5380 "",
    }
}

/// The bit of a memory access behind whose mask an alignment stands.
const ALIGNED: u32 = 2;

impl Op {
    /// Whether it is known which words of its instructions are ids.
    pub fn is_known(self) -> bool {
        self.letters() != b"?"
    }

    /// Whether word `at` of an instruction is an id. False if that is not known.
    pub fn is_id(self, words: &[u32], at: usize) -> bool {
        let letters = self.letters();
        let last = letters.len();
        // Beyond the last letter stands what that one announces.
        let letter = if at <= last { at.checked_sub(1).map(|at| letters[at]) } else { letters.last().copied() };
        match letter {
            Some(b'T' | b'R' | b'I') => at <= last,
            Some(b'i') => true,
            Some(b'a') => at > last + usize::from(words[last] & ALIGNED != 0),
            Some(b'c') => (at - last) % 2 == 1,
            Some(b'n') => at >= after_text(words, last),
            Some(b'O') => at > last && Self::of(words[last]).is_id(&words[1..], at - 1),
            _ => false,
        }
    }

    /// The place of the result among the words. An operation that is not listed may have one.
    pub fn result(self) -> Option<usize> {
        match self.letters() {
            [b'T', b'R', ..] => Some(2),
            [b'R', ..] => Some(1),
            _ => (self == Self::Unknown).then_some(2),
        }
    }

    /// Whether the result has a type.
    pub fn has_type(self) -> bool {
        self.result() == Some(2)
    }

    /// The least number of words of an instruction.
    pub fn least_length(self) -> usize {
        1 + self.letters().iter().filter(|letter| letter.is_ascii_uppercase()).count()
    }
}

/// A literal string.
pub fn text(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|byte| *byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The place behind the literal string that begins at a word.
pub fn after_text(words: &[u32], at: usize) -> usize {
    let ends = |word: &u32| word.to_le_bytes().contains(&0);
    words[at..].iter().position(ends).map_or(words.len(), |end| at + end + 1)
}

#[cfg(test)]
mod tests {
    use rspirv::grammar::{INSTRUCTION_TABLE, LogicalOperand, OperandKind, OperandQuantifier};

    use super::*;

    fn letter(operand: &LogicalOperand) -> char {
        let letter = match operand.kind {
            OperandKind::IdResultType => 'T',
            OperandKind::IdResult => 'R',
            OperandKind::IdRef
            | OperandKind::IdScope
            | OperandKind::IdMemorySemantics
            | OperandKind::PairIdRefIdRef => 'I',
            OperandKind::LiteralString => 'S',
            OperandKind::MemoryAccess => 'A',
            OperandKind::PairLiteralIntegerIdRef => 'C',
            OperandKind::LiteralSpecConstantOpInteger => 'O',
            _ => 'L',
        };
        if operand.quantifier == OperandQuantifier::One { letter } else { letter.to_ascii_lowercase() }
    }

    #[test]
    fn operations_are_those_of_the_grammar() {
        for (code, name, words) in ALL.iter().filter(|(.., words)| *words != "?") {
            let found =
                INSTRUCTION_TABLE.iter().find(|i| i.opcode as u32 == *code).expect("an operation of the grammar");
            let mut letters: String = found.operands.iter().map(letter).collect();
            match Op::of(*code) {
                Op::EntryPoint => letters = letters.replace("Si", "n"),
                op if op.class() == Class::Sample || op == Op::ImageRead || op == Op::ImageWrite => letters.push('i'),
                _ => {}
            }
            assert_eq!((found.opname, letters.as_str()), (*name, *words));
        }
    }

    #[test]
    fn ids_are_told_from_literals() {
        let ids = |op: Op, words: &[u32]| (1..words.len()).filter(|at| op.is_id(words, *at)).collect::<Vec<_>>();
        assert_eq!(ids(Op::Load, &[0, 1, 1, 1]), [1, 2, 3]);
        assert_eq!(ids(Op::Store, &[0, 1, 1, 2 | 8, 16, 7]), [1, 2, 5]);
        assert_eq!(ids(Op::Switch, &[0, 1, 1, 9, 1, 9, 1]), [1, 2, 4, 6]);
        assert_eq!(ids(Op::EntryPoint, &[0, 4, 1, 0x6e69_616d, 0, 1, 1]), [2, 5, 6]);
        assert_eq!(ids(Op::SpecConstantOp, &[0, 1, 1, Op::CompositeExtract as u32, 1, 9]), [1, 2, 4]);
        assert_eq!(ids(Op::ImageSampleImplicitLod, &[0, 1, 1, 1, 1, 1, 1]), [1, 2, 3, 4, 6]);
        assert_eq!(ids(Op::Constant, &[0, 1, 1, 9, 9]), [1, 2]);
        assert_eq!(Op::of(Op::Load as u32 | 4 << 16), Op::Load);
        assert_eq!(Op::of(9999), Op::Unknown);
    }
}
