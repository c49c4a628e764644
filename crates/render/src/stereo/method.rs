//! How a pair of pictures is made of one cast.

/// How segments of reference rays get to the derived picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Form {
    /// A row of a strip of columns is cast ray after ray and composited on the way; strips are merged.
    #[default]
    Strips,
}

/// How much is done for the derived picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum Quality {
    /// Segments of the reference eye's rays alone.
    #[default]
    Fast,
}

/// How a pair is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct PairMethod {
    /// How segments get to the derived picture.
    pub form: Form,
    /// How much is done for the derived picture.
    pub quality: Quality,
}
