//! The `katachi` command.

fn main() {}
