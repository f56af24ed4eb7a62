//! The stable names of the kinds of diagnostic.

use std::fmt;

macro_rules! codes {
    ($($(#[$doc:meta])* $variant:ident = $name:literal,)*) => {
        /// The kind of a diagnostic. Its printed name is stable: tests, editors and scripts may rely on it.
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        pub enum Code { $($(#[$doc])* $variant,)* }

        impl Code {
            /// Every kind there is.
            pub const ALL: &'static [Code] = &[$(Code::$variant),*];

            /// The printed name.
            pub const fn name(self) -> &'static str {
                match self { $(Code::$variant => $name,)* }
            }
        }
    };
}

codes! {
    /// The text does not follow the grammar.
    Syntax = "syntax",
    /// A character or literal that no token begins with.
    BadToken = "bad-token",
    /// The source is not text.
    NotText = "not-text",
    /// Brackets, calls or values nested deeper than the limit.
    TooDeep = "too-deep",
    /// No such name in scope.
    UnknownName = "unknown-name",
    /// A name defined twice in one scope.
    Duplicate = "duplicate",
    /// Definitions that need each other.
    Cycle = "cycle",
    /// Calls that never end, or nest too deep.
    EndlessRecursion = "endless-recursion",
    /// No signature of the called name takes these arguments.
    BadCall = "bad-call",
    /// A named argument that no signature has.
    UnknownArgument = "unknown-argument",
    /// A parameter without a default got no value.
    MissingArgument = "missing-argument",
    /// A value of another kind than needed.
    WrongKind = "wrong-kind",
    /// Dimensions differ.
    Dimension = "dimension",
    /// An index, a count or a number outside its bounds.
    OutOfRange = "out-of-range",
    /// A record without that key.
    MissingKey = "missing-key",
    /// A size that leaves no solid: zero, negative, NaN or infinite.
    Degenerate = "degenerate",
    /// Division by zero, or a function outside its domain.
    Arithmetic = "arithmetic",
    /// A polygon whose sides cross.
    SelfCrossing = "self-crossing",
    /// A mesh that does not enclose a volume.
    OpenMesh = "open-mesh",
    /// A cut that leaves nothing.
    EmptyResult = "empty-result",
    /// An assertion that does not hold.
    AssertionFailed = "assertion-failed",
    /// A test that failed.
    TestFailed = "test-failed",
    /// A parameter value outside its declared range or choices.
    BadParam = "bad-param",
    /// A file that cannot be read.
    UnreadableFile = "unreadable-file",
    /// A file that cannot be written.
    UnwritableFile = "unwritable-file",
    /// A path outside the project root.
    OutsideRoot = "outside-root",
    /// A file whose content is not of its format.
    BadFile = "bad-file",
    /// Files that use each other.
    UseCycle = "use-cycle",
    /// Something outside a file's `pub` names was asked for.
    Private = "private",
    /// A limit of steps, memory or triangles was hit.
    Limit = "limit",
    /// The set operation moved corners by more than the tolerance.
    Snap = "snap",
    /// A wrong use of the command line.
    Usage = "usage",
    /// A value that is computed and dropped.
    Unused = "unused",
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
