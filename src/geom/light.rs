//! What is common to all that speak of light.

/// Suns of one picture at most.
pub const SUNS: usize = 8;

/// A sun stands above the horizon from this sine of its height on; shadows are 10,000 times as long as what casts them
/// there.
pub const HORIZON: f64 = 1e-4;
